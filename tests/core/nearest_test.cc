#include "core/nearest.h"

#include <gtest/gtest.h>

namespace ttf {
namespace {

TEST(Nearest, DistancesCountLetters) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "run"), 3u);
  EXPECT_EQ(edit_distance("run", "run"), 0u);
  EXPECT_EQ(edit_distance("rin", "run"), 1u) << "replaced";
  EXPECT_EQ(edit_distance("rn", "run"), 1u) << "left out";
  EXPECT_EQ(edit_distance("ruun", "run"), 1u) << "added";
  EXPECT_EQ(edit_distance("rnu", "run"), 1u) << "exchanged";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "no letter is edited twice";
}

TEST(Nearest, OneThirdOfTheLettersMayDiffer) {
  const std::vector<std::string> options{"strategy", "seed", "input", "out", "json", "no-log"};
  EXPECT_EQ(nearest("startegy", options), "strategy");
  EXPECT_EQ(nearest("stratgey", options), "strategy");
  EXPECT_EQ(nearest("outt", options), "out");
  EXPECT_EQ(nearest("o", options), std::nullopt);
  EXPECT_EQ(nearest("fast", options), std::nullopt);
  EXPECT_EQ(nearest("", options), std::nullopt);
  EXPECT_EQ(nearest("s", {"h", "help", "seed", "strategy"}), std::nullopt) << "a letter is not near another letter";
  EXPECT_EQ(nearest("o1", {"o"}), "o");
  EXPECT_EQ(nearest("seed", {}), std::nullopt);
}

TEST(Nearest, AnAbbreviationIsNear) {
  EXPECT_EQ(nearest("repl", {"report", "replications", "replay"}), "replay") << "the one with the least distance";
  EXPECT_EQ(nearest("vir", {"virtual-time"}), "virtual-time");
}

TEST(Nearest, TheFirstOfEqualsIsTaken) { EXPECT_EQ(nearest("bat", {"bar", "baz"}), "bar"); }

}  // namespace
}  // namespace ttf
