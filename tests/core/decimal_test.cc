#include "core/decimal.h"

#include <gtest/gtest.h>

#include "core/counted.h"
#include "core/random.h"

namespace ttf {
namespace {

TEST(Decimal, ReadsExactlyOrNotAtAll) {
  EXPECT_EQ(parse_scaled("1.375000", 1'000'000), 1'375'000);
  EXPECT_EQ(parse_scaled("-0.5", 10), -5);
  EXPECT_EQ(parse_scaled("8.0", 1), 8);
  EXPECT_EQ(parse_scaled("1.23", 10), std::nullopt);
  for (const char* text : {"", "-", ".", "1e3", "+1", " 1", "1.2.3", "99999999999999999999", "0x10"})
    EXPECT_EQ(parse_scaled(text, 1), std::nullopt) << text;
}

TEST(Decimal, ReadsDurationsWithOrWithoutASpace) {
  EXPECT_EQ(parse_duration("40 ms"), Duration::milliseconds(40));
  EXPECT_EQ(parse_duration("40ms"), Duration::milliseconds(40));
  EXPECT_EQ(parse_duration("2.5us"), Duration{2'500});
  EXPECT_EQ(parse_duration("0 s"), Duration{});
  EXPECT_EQ(parse_duration("-7ns"), Duration{-7});
  for (const char* text : {"", "s", "ms", "40", "40  ms", "40 m s", " 40ms", "40ms ", "0.5ns", "1e3 ms", "40 min"})
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
}

TEST(Words, NamesAreJoined) {
  EXPECT_EQ(joined({}), "");
  EXPECT_EQ(joined({"a"}, " or "), "a");
  EXPECT_EQ(joined({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(joined({"a", "b", "c"}, " or "), "a, b or c");
}

TEST(Decimal, WritesWithoutTrailingZeros) {
  EXPECT_EQ(scaled_text(12'500, 1'000'000), "0.0125");
  EXPECT_EQ(scaled_text(5'000'000'000, 1'000'000), "5000");
  EXPECT_EQ(scaled_text(-1'500'001, 1'000), "-1500.001");
  EXPECT_EQ(scaled_text(0, 1'000), "0");
  EXPECT_EQ(scaled_text(7, 1), "7");
}

TEST(Decimal, AWrittenNumberIsReadAgain) {
  RandomStream random({.seed = 1, .purpose = Purpose::kTest, .entity = 0, .index = 0});
  for (int i = 0; i < 10'000; ++i) {
    const auto value = static_cast<std::int64_t>(random.bits()) >> (8 + i % 50);
    for (const std::int64_t scale : {1, 1'000, 1'000'000})
      EXPECT_EQ(parse_scaled(scaled_text(value, scale), scale), value);
  }
}

TEST(Decimal, TheEndsOfTheRangeAreInIt) {
  EXPECT_EQ(parse_scaled("9223372036854775807", 1), INT64_MAX);
  EXPECT_EQ(parse_scaled("9223372036854775808", 1), std::nullopt);
  EXPECT_EQ(parse_scaled("-9223372036854775808", 1), INT64_MIN);
  EXPECT_EQ(parse_scaled("-9223372036854775809", 1), std::nullopt);
  for (std::int64_t scale = 1; scale <= 10'000'000'000'000; scale *= 10)
    for (const std::int64_t value : {INT64_MIN, INT64_MIN + 1, std::int64_t{-1}, std::int64_t{0}, INT64_MAX})
      EXPECT_EQ(parse_scaled(scaled_text(value, scale), scale), value) << value << " / " << scale;
}

}  // namespace
}  // namespace ttf
