#include "timebase/divisor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "core/int128.h"
#include "core/random.h"
#include "timebase/floor_div.h"

namespace ttf::timebase {
namespace {

constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();

TEST(Divisor, IsTheDivisionAtEveryEdge) {
  RandomStream draw({1, 0, Purpose::kTest, 11, 0});
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t d = i < 64    ? i + 1
                           : i == 64 ? kLargest
                                     : draw.integer(1, std::int64_t{1} << draw.integer(0, 61));
    const Divisor divisor(d);
    for (int j = 0; j < 20; ++j) {
      const std::int64_t q = draw.integer(0, kLargest / d);
      const Int128 multiple = Int128{q} * d;
      for (const Int128 wide : {multiple, multiple - 1, multiple + 1, multiple + d / 2, Int128{kLargest}, Int128{0}}) {
        if (wide < 0 || wide > kLargest) continue;
        const auto x = static_cast<std::int64_t>(wide);
        ASSERT_EQ(divisor.floor(x), x / d) << x << " / " << d;
        if (x > kLargest - d) continue;
        ASSERT_EQ(divisor.ceil(x), x / d + (x % d != 0)) << x << " / " << d;
      }
    }
  }
}

TEST(DivisorDeathTest, IsOneOrMore) {
  static_assert(Divisor(1).floor(7) == 7);
  EXPECT_DEATH(Divisor(0), "divisor 0");
  EXPECT_DEATH(Divisor(-3), "divisor -3");
}

TEST(FloorDiv, RoundsDownOnBothSidesOfZeroAndOf64Bits) {
  EXPECT_EQ(static_cast<int>(floor_div(7, 2)), 3);
  EXPECT_EQ(static_cast<int>(floor_div(-7, 2)), -4);
  EXPECT_EQ(static_cast<int>(floor_div(-8, 2)), -4);
  RandomStream draw({1, 0, Purpose::kTest, 12, 0});
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t b = draw.integer(1, kLargest);
    const Int128 q = draw.integer(-kLargest, kLargest), rest = draw.integer(0, b - 1);
    ASSERT_TRUE(floor_div(q * b + rest, b) == q);
  }
}

}  // namespace
}  // namespace ttf::timebase
