#include "report/drawing/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace ttf::report::drawing {
namespace {

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::string line;
  for (std::istringstream lines(text); std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST(Tables, AHeadOfSeveralLinesStandsOnItsRows) {
  Table table({"node", "late\nwake-ups", "state"});
  table.add({"a", "7", "up"});
  EXPECT_EQ(table.text(),
            "          late\n"
            "node  wake-ups  state\n"
            "----  --------  -----\n"
            "a            7  up\n");
}

TEST(Tables, AWideOneGoesOnBelowWithItsFirstColumn) {
  Table table({"node", std::string(60, 'x'), std::string(40, 'y'), "z"});
  table.add({"a", "1", "2", "3"});
  EXPECT_EQ(table.text(), "node  " + std::string(60, 'x') + "\n----  " + std::string(60, '-') + "\na     " +
                              std::string(59, ' ') + "1\n\nnode  " + std::string(40, 'y') + "  z\n----  " +
                              std::string(40, '-') + "  -\na     " + std::string(39, ' ') + "2  3\n");
  EXPECT_LE(longest_line(table.text()), Table::kWidest);
}

TEST(Tables, KeepColumnsOfAGroupTogether) {
  const std::string wide(40, 'w');
  Table table({"n", "a", wide, "b", wide});
  table.begin_group(1);
  table.begin_group(3);
  table.add({"1", "2", "3", "4", "5"});
  EXPECT_NE(table.text().find("n  a  " + wide + "  b  " + wide + "\n"), std::string::npos);  // all fit
  Table wider({"n", "a", wide + "wwwwwwwwwwwwwww", "b", wide});
  wider.begin_group(1);
  wider.begin_group(3);
  wider.add({"1", "2", "3", "4", "5"});
  EXPECT_NE(wider.text().find("\nn  b  " + wide + "\n"), std::string::npos) << wider.text();
}

TEST(Tables, WordsThatDoNotFitGoBelowTheirRow) {
  Table table({"node", "state", "why"});
  table.end_in_words();
  table.add({"a", "up", "all is well"});
  EXPECT_EQ(table.text(), "node  state  why\n----  -----  -----------\na     up     all is well\n");
  std::string words = "it";
  for (int i = 0; i < 40; ++i) words += " was";
  table.add({"b", "down", words});
  table.add({"c", "up"});
  const std::string text = table.text();
  EXPECT_TRUE(
      text.starts_with("node  state\n    why\n----  -----\na     up\n    all is well\nb     down\n    it was was"))
      << text;
  EXPECT_TRUE(text.ends_with("\n    was was was was was was was was was was was was was was was was was\nc     up\n"))
      << text;
  EXPECT_LE(longest_line(text), Table::kWidest);
}

TEST(Tables, AGroupThatIsTooWideIsParted) {
  const std::string wide(60, 'w');
  Table table({"n", wide, wide});
  table.begin_group(1);
  table.add({"1", "2", "3"});
  EXPECT_LE(longest_line(table.text()), Table::kWidest);
}

}  // namespace
}  // namespace ttf::report::drawing
