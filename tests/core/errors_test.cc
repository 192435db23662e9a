#include "core/errors.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace ttf {
namespace {

TEST(Finding, SaysWhatIsThere) {
  EXPECT_EQ((Finding{"a.yaml", 3, "n", "many", "must be a number"}.sentence()), "a.yaml:3: n = many: must be a number");
  EXPECT_EQ((Finding{"", 0, "", "", "holds no rows"}.sentence()), "input: holds no rows");
}

// A path, too, comes from outside.
TEST(Finding, IsOneLineWhateverItIsMadeOf) {
  const Finding finding{"two\nlines.yaml", 1, "k\ney", "va\rlue", "must\tnot \x7f break"};
  EXPECT_EQ(finding.sentence(), "two\\x0alines.yaml:1: k\\x0aey = va\\x0dlue: must\\x09not \\x7f break");
}

TEST(Finding, CutsLongValuesBetweenCharactersButNeverThePath) {
  const std::string path(500, 'p'), umlauts = "v" + [] {
    std::string text;
    for (int i = 0; i < 100; ++i) text += "\u00fc";
    return text;
  }();
  const std::string sentence = Finding{path, 0, "", umlauts, "is long"}.sentence();
  EXPECT_EQ(sentence, path + ": " + umlauts.substr(0, 99) + "...: is long");
}

TEST(SystemMessage, HasTheSystemsWords) {
  for (const int error : {0, ENOENT, EACCES, EFBIG, ENOSPC, -1, 4711})
    EXPECT_EQ(system_message(error), std::strerror(error)) << error;
}

}  // namespace
}  // namespace ttf
