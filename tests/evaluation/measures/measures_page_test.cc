// docs/reference/measures.md has every measure of experiments, as the table has it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "core/file_bytes.h"
#include "evaluation/measures/measure.h"

namespace ttf::evaluation::measures {
namespace {

std::string rows_of_table() {
  std::string rows;
  for (const Measure& row : measures())
    if (!row.name.empty())
      rows += fmt::format("| `{}` | {} | {} | {} |\n", row.name, row.unit, row.meaning, row.if_missed);
  return rows;
}

TEST(MeasuresPage, HasEveryMeasureInOrder) {
  const std::string page = read_file(TTF_SOURCE_DIR "/docs/reference/measures.md");
  const std::size_t begin = page.find("\n| `") + 1;
  EXPECT_EQ(page.substr(begin, page.find("\n\n", begin) + 1 - begin), rows_of_table())
      << "the page must have these rows";
}

}  // namespace
}  // namespace ttf::evaluation::measures
