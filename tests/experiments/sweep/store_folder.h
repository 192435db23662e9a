// An experiment's stores, in a folder that goes with the test.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "experiments/results/store.h"
#include "experiments/sweep/drives.h"

namespace ttf::experiments::sweep {

class StoreFolder : public testing::Test {
 protected:
  StoreFolder() : folder_((std::filesystem::temp_directory_path() / "ttfusion_sweep_XXXXXX").string()) {
    if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no folder");
  }
  ~StoreFolder() override { std::filesystem::remove_all(folder_); }

  results::Store store(const SweepDrives& drives, const std::string& name) const {
    return results::Store::create(path(name), {"small", drives.identity(), "1", "", drives.columns()});
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }

 private:
  std::string folder_;
};

}  // namespace ttf::experiments::sweep
