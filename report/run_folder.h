// What a folder of results is, and the runs in it: as `ttfusion run` and `ttfusion launch` leave them, or logs alone.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recording/merge.h"

namespace ttf::report {

enum class FolderKind : std::uint8_t { kRun, kExperiment };
// Throws InputError where the folder is neither.
FolderKind kind_of_folder(const std::string& path);

// One strategy's drive.
struct Drive {
  std::string folder, scenario, strategy;
  std::string label;                                   // tells it from the others of the page
  std::uint64_t seed = 0;
  nlohmann::ordered_json summary;                      // its part of summary.json; null without one
  std::shared_ptr<const recording::MergedLogs> log;    // none: the run kept none
};

struct RunFolder {
  std::string path;
  nlohmann::ordered_json summary;                      // of all; null where there are logs alone
  std::vector<Drive> drives;                           // at least one
  std::vector<std::string> remarks;                    // sentences: what is missing or damaged
};
// Throws InputError: a summary that is none, a log that cannot be read.
RunFolder read_run_folder(const std::string& path);

// The file's JSON. Throws InputError with the file and what is wrong.
nlohmann::ordered_json read_json(const std::string& path);

}  // namespace ttf::report
