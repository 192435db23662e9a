// The expressions that other tests are written in.
#include "tests/support/patterns.h"

#include <gtest/gtest.h>

namespace ttf::support {
namespace {

TEST(Patterns, AGroupWithoutAPartIsEmpty) {
  const auto match = first_match("x=1", "(\\w)=(\\d)(;(.*))?");
  ASSERT_TRUE(match);
  EXPECT_EQ(match->groups, (std::vector<std::string>{"x=1", "x", "1", "", ""}));
  EXPECT_THROW((void)(*match)[5], std::out_of_range);
}

TEST(Patterns, AWholeMatchHasTheWholeText) {
  struct Row {
    const char *text, *pattern;
    int first;  // where the first match begins; none: -1
    bool whole;
  };
  const Row rows[] = {{"a12b", "\\d+", 1, false}, {"12", "\\d+", 0, true}, {"12\n", "\\d+", 0, false},
                      {"ab", "a|ab", 0, true},    {"", "\\d*", 0, true},   {"ab", "\\d", -1, false}};
  for (const auto& [text, pattern, first, whole] : rows) {
    const auto found_first = first_match(text, pattern);
    EXPECT_EQ(found_first ? static_cast<int>(found_first->at) : -1, first) << pattern << " in " << text;
    EXPECT_EQ(whole_match(text, pattern).has_value(), whole) << pattern << " in " << text;
    EXPECT_EQ(found(text, pattern), first >= 0) << pattern << " in " << text;
  }
  EXPECT_EQ(first_match("ab", "a|ab")->size, 1U);
  EXPECT_EQ(whole_match("ab", "a|ab")->size, 2U);
}

TEST(Patterns, AReplacementNamesGroups) {
  struct Row {
    const char *by, *all, *first;
  };
  const Row rows[] = {{"$2:$1", "1:a, 2:b", "1:a, b2"},
                      {"[$&]", "[a1], [b2]", "[a1], b2"},
                      {"$$1", "$1, $1", "$1, b2"},
                      {"", ", ", ", b2"}};
  for (const auto& [by, all, first] : rows) {
    EXPECT_EQ(replaced("a1, b2", "(\\w)(\\d)", by), all) << by;
    EXPECT_EQ(replaced_first("a1, b2", "(\\w)(\\d)", by), first) << by;
  }
  EXPECT_EQ(replaced("a1, b", "(\\w)(\\d)?(,|$)", "$1<$2>"), "a<1> b<>") << "a group without a part is empty";
}

TEST(Patterns, AllMatchesComeInOrder) {
  const auto all = matches("a1, b22", "(\\w)(\\d+)");
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1].at, 4U);
  EXPECT_EQ(all[1][2], "22");
}

}  // namespace
}  // namespace ttf::support
