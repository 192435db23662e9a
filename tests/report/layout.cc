#include "tests/report/layout.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "report/drawing/render.h"

namespace ttf::report {

void expect_renders(const std::string& svg) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("ttf_judge_" + std::to_string(getpid()) + ".png")).string();
  EXPECT_NO_THROW(drawing::write_picture(svg, path));
  EXPECT_GT(std::filesystem::file_size(path), 500u);
  std::filesystem::remove(path);
}

}  // namespace ttf::report
