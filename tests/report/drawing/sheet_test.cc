// Paper: sizes, broken text, and refused widths.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "report/drawing/axes.h"
#include "tests/report/layout.h"
#include "tests/support/refusals.h"

namespace ttf::report::drawing {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refused(double width_mm, double font_pt) {
  return support::refusal_of([&] { Sheet(width_mm, font_pt); });
}

TEST(Sheet, HasTheWidthAndTheFontOfPaper) {
  const Sheet sheet(88, 8);
  EXPECT_NEAR(sheet.mm(Sheet::kPaperText), 8 * 25.4 / 72, 1e-9);
  EXPECT_NEAR(sheet.mm(sheet.width(1000)), 88, 1e-9);
  EXPECT_EQ(sheet.text(14), sheet.text(8.5));
  const Sheet screen;
  EXPECT_EQ(screen.text(8.5), 8.5);
  EXPECT_EQ(screen.width(1000), 1000);
  EXPECT_EQ(screen.plot_width(900, 5000), 900);
}

TEST(Sheet, RefusesSizesOutOfRange) {
  EXPECT_EQ(refused(30, 4), "");
  EXPECT_EQ(refused(1000, 72), "");
  EXPECT_THAT(refused(29.9, 4), HasSubstr("--width = 29.9 mm: must be 30..1000 mm"));
  EXPECT_THAT(refused(1001, 8), HasSubstr("must be 30..1000 mm"));
  EXPECT_THAT(refused(88, 3.9), HasSubstr("--font-size = 3.9: must be 4..72 pt"));
  EXPECT_THAT(refused(88, 73), HasSubstr("must be 4..72 pt"));
  EXPECT_THAT(refused(56, 8), HasSubstr("must be at least 56.5 mm with a font size of 8 pt"));
  EXPECT_EQ(refused(56.5, 8), "") << "the width that the sentence names";
}

TEST(Sheet, RefusesPaperThatNamesFill) {
  const Sheet sheet(88, 8);
  EXPECT_NEAR(sheet.plot_width(900, 100), sheet.width(0) - 100, 1e-9);
  try {
    sheet.plot_width(900, 300);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--width = 88 mm: must be at least 100.1 mm with a font size of 8 pt"));
  }
}

TEST(Sheet, BreaksTextAtBlanks) {
  const double width = text_width("one two", 11);
  EXPECT_THAT(broken("one two three four", 11, width), ElementsAre("one two", "three", "four"));
  EXPECT_THAT(broken("incomprehensibilities", 11, 10), ElementsAre("incomprehensibilities"));
  EXPECT_THAT(broken("", 11, 10), ElementsAre(""));
}

TEST(Legend, BreaksEntriesThatAreWiderThanThePaper) {
  const std::vector<LegendEntry> legend{
      {LegendEntry::Kind::kLine, "a curve whose name needs more than the narrow paper has", "#000000"},
      {LegendEntry::Kind::kLine, "short", "#000000"},
      {LegendEntry::Kind::kLine, "another one", "#000000"},
      {LegendEntry::Kind::kLine, "and the last", "#000000"}};
  const Sheet sheet(60, 8);
  Svg svg(sheet.width(0), 20 + legend_height(legend, sheet.width(0) - 20), "legend", sheet);
  draw_legend(svg, {10, 10}, sheet.width(0) - 20, legend);
  expect_on_paper(svg.str(), 60, 8);
}

TEST(Legend, AnEmptyPictureFitsOnPaper) {
  expect_on_paper(
      empty_picture("A title of a drive with a long name, and its strategy",
                    "There are no positions between one second and two seconds, nor between three seconds and four.",
                    {64, 9}),
      64, 9);
}

}  // namespace
}  // namespace ttf::report::drawing
