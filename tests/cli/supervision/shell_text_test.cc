#include "cli/supervision/shell_text.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

namespace ttf::cli::supervision {
namespace {

// A shell reads its output back unchanged.
TEST(ShellText, IsWhatAShellReads) {
  EXPECT_EQ(shell_text({"ttfusion", "node", "laser_pre", "--out=a/b"}), "ttfusion node laser_pre --out=a/b");
  const std::vector<std::string> arguments{"printf", "%s|",  "a b", "it's", "",  "$HOME",
                                           "`x`",    "a\nb", "~",   "\\",   "#", "*"};
  FILE* const shell = popen(shell_text(arguments).c_str(), "r");
  ASSERT_NE(shell, nullptr);
  std::string text(200, '\0');
  text.resize(fread(text.data(), 1, text.size(), shell));
  EXPECT_EQ(pclose(shell), 0);
  EXPECT_EQ(text, "a b|it's||$HOME|`x`|a\nb|~|\\|#|*|");
}

}  // namespace
}  // namespace ttf::cli::supervision
