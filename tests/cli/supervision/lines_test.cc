#include "cli/supervision/lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ttf::cli::supervision {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(LineCutter, HoldsBackWhatIsNotComplete) {
  LineCutter cutter;
  EXPECT_THAT(cutter.feed("one\ntw"), ElementsAre("one"));
  EXPECT_THAT(cutter.feed("o"), IsEmpty());
  EXPECT_THAT(cutter.feed("\n\nfour"), ElementsAre("two", ""));
  EXPECT_THAT(cutter.finish(), ElementsAre("four"));
  EXPECT_THAT(cutter.finish(), IsEmpty());
}

TEST(LineCutter, TakesBothEnds) {
  LineCutter cutter;
  EXPECT_THAT(cutter.feed("a\r"), IsEmpty());
  EXPECT_THAT(cutter.feed("\nb\rc\r\n"), ElementsAre("a", "b\rc"));
}

TEST(LineCutter, ShowsAFloodInPieces) {
  LineCutter cutter;
  const std::string piece(kLongestLine, 'x');
  EXPECT_THAT(cutter.feed(piece), IsEmpty());
  const std::string cut = piece + std::string(LineCutter::kGoesOn);
  EXPECT_THAT(cutter.feed(piece + piece + "end\n"), ElementsAre(cut, cut, cut, "end"));
  // The same however it arrives.
  LineCutter by_bytes;
  std::vector<std::string> lines;
  for (const char c : piece + piece + piece + "end\n")
    for (std::string& line : by_bytes.feed(std::string_view(&c, 1))) lines.push_back(std::move(line));
  EXPECT_THAT(lines, ElementsAre(cut, cut, cut, "end"));
}

TEST(LineCutter, CutsNoCharacterInTwo) {
  LineCutter cutter;
  const std::string text = std::string(kLongestLine - 1, 'x') + "\xe2\x82\xac\n";  // a euro sign across the cut
  EXPECT_THAT(cutter.feed(text),
              ElementsAre(std::string(kLongestLine - 1, 'x') + std::string(LineCutter::kGoesOn), "\xe2\x82\xac"));
  // Bytes outside any character are cut anywhere.
  const std::string junk(kLongestLine + 10, '\x80');
  EXPECT_THAT(
      cutter.feed(junk + "\n"),
      ElementsAre(std::string(kLongestLine, '\x80') + std::string(LineCutter::kGoesOn), std::string(10, '\x80')));
}

TEST(Printable, KeepsTextAndEscapesJunk) {
  EXPECT_EQ(printable("tab\tand \xc3\xbc\xe2\x82\xac\xf0\x9f\x9a\x97 \\x"),
            "tab\tand \xc3\xbc\xe2\x82\xac\xf0\x9f\x9a\x97 \\x");
  EXPECT_EQ(printable(std::string_view("\x00\x1b[31m\x7f\r", 8)), "\\x00\\x1b[31m\\x7f\\x0d");
  EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
}

TEST(Printable, EscapesWhatOnlyLooksLikeUtf8) {
  for (const auto& [bytes, shown] :
       std::vector<std::pair<std::string, std::string>>{{"\xc2\x9b"
                                                         "1m",
                                                         "\\xc2\\x9b1m"},            // C1: terminals take it for ESC [
                                                        {"\xc0\xaf", "\\xc0\\xaf"},  // overlong
                                                        {"\xe0\x80\xaf", "\\xe0\\x80\\xaf"},           // overlong
                                                        {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // a surrogate
                                                        {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // above U+10FFFF
                                                        {"\xf0\x8f\xbf\xbf", "\\xf0\\x8f\\xbf\\xbf"},  // overlong
                                                        {"\xe2\x82", "\\xe2\\x82"},                    // torn
                                                        {"\xe2\x82z", "\\xe2\\x82z"}})
    EXPECT_EQ(printable(bytes), shown);
}

TEST(Prefix, IsTimeNameAndText) {
  const Duration at = Duration::microseconds(12'345'678);
  EXPECT_EQ(prefixed(at, {"fusion", 1}, 10, false, "hello"), "  12.346 fusion     | hello");
  EXPECT_EQ(prefixed(at, {"fusion", 1}, 6, false, ""), "  12.346 fusion |");
  EXPECT_EQ(prefixed(at, {"f\xc3\xbcr", 1}, 4, false, "x"), "  12.346 f\xc3\xbcr  | x");  // width in characters
  EXPECT_EQ(prefixed(at, {"fusion", 1}, 6, true, "x"), "\x1b[32m  12.346 fusion |\x1b[0m x");
  EXPECT_EQ(prefixed(at, {"fusion", 11}, 6, true, "x"), prefixed(at, {"fusion", 1}, 6, true, "x"));
  EXPECT_NE(prefixed(at, {"fusion", 2}, 6, true, "x"), prefixed(at, {"fusion", 1}, 6, true, "x"));
}

}  // namespace
}  // namespace ttf::cli::supervision
