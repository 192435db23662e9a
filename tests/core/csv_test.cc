// Lines of comma-separated text, as other programs write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/csv.h"

namespace ttf {
namespace {

using testing::ElementsAre;

std::vector<std::vector<std::string>> all_lines(const std::string& text) {
  std::vector<std::vector<std::string>> all;
  CsvLines lines(text);
  while (lines.next()) all.push_back(lines.fields());
  return all;
}

TEST(Csv, FieldsQuotesAndBlanks) {
  EXPECT_THAT(all_lines("a,b\n1, 2 ,\n"), ElementsAre(ElementsAre("a", "b"), ElementsAre("1", "2", "")));
  EXPECT_THAT(all_lines("\"a,b\" , \" c \",\"say \"\"so\"\"\",\"\"\n"),
              ElementsAre(ElementsAre("a,b", " c ", "say \"so\"", "")));
  EXPECT_THAT(all_lines("a\"b,c\n"), ElementsAre(ElementsAre("a\"b", "c")))
      << "a quote within a plain field is a letter";
}

TEST(Csv, ByteOrderMarkWindowsLineEndsAndNoLastEnd) {
  EXPECT_THAT(all_lines("\xef\xbb\xbf"
                        "a,b\r\n\r\n# a remark, too\r\n1,2"),
              ElementsAre(ElementsAre("a", "b"), ElementsAre("1", "2")));
  EXPECT_TRUE(all_lines("").empty());
  EXPECT_TRUE(all_lines("\n \r\n#\n").empty());
}

TEST(Csv, CountsLinesThatArePassedOver) {
  CsvLines lines("a\n\n# b\nc\n");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.line(), 1);
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.line(), 4);
  EXPECT_FALSE(lines.next());
}

TEST(Csv, ABrokenLineIsReportedAndTheNextIsWhole) {
  CsvLines lines("\"a\n\"b\"c\nd\n");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.broken(), "must end its quoted field on the same line");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.broken(), "must have a comma after a quoted field");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.broken(), "");
  EXPECT_THAT(lines.fields(), ElementsAre("d"));
}

TEST(Csv, AFieldIsReadAsItWasWritten) {
  for (const std::string field : {"", "plain", "with,comma", "say \"so\"", " blanks ", "#5", "\"", ",", "\t"})
    EXPECT_THAT(all_lines(csv_field(field) + ",x\n"), ElementsAre(ElementsAre(field, "x"))) << field;
  EXPECT_EQ(csv_field("plain"), "plain");
}

}  // namespace
}  // namespace ttf
