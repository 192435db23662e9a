// docs/reference/measures.md has every measure, with its unit and meaning, and says how it takes a missed object.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "experiments/sweep/measures.h"

namespace ttf::experiments::sweep {
namespace {

std::vector<std::string> page_rows() {
  const std::string page = read_file(TTF_SOURCE_DIR "/docs/reference/measures.md");
  std::vector<std::string> rows;
  for (std::size_t at = page.find("\n| `"); at != std::string::npos; at = page.find("\n| `", at + 1))
    rows.push_back(page.substr(at + 1, page.find('\n', at + 1) - at - 1));
  return rows;
}

TEST(MeasuresPage, HasEveryMeasureInOrder) {
  const std::vector<std::string> rows = page_rows();
  ASSERT_EQ(rows.size(), kMeasures.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Measure& measure = kMeasures[i];
    const std::string begin = fmt::format("| `{}` | {} | {} | ", measure.name, measure.unit, measure.meaning);
    EXPECT_TRUE(rows[i].starts_with(begin)) << rows[i] << "\nmust begin with\n" << begin;
    EXPECT_GT(rows[i].size(), begin.size() + 2) << rows[i] << ": nothing about a missed object";
  }
}

}  // namespace
}  // namespace ttf::experiments::sweep
