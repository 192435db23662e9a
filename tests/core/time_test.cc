#include "core/time.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace ttf {
namespace {

template <class A, class B>
concept Subtractable = requires(A a, B b) { a - b; };
template <class A, class B>
concept Addable = requires(A a, B b) { a + b; };

TEST(Time, TheThreeTimesDoNotMix) {
  static_assert(Subtractable<TrueTime, TrueTime>);
  static_assert(!Subtractable<TrueTime, LocalTime>);
  static_assert(!Subtractable<GlobalTime, LocalTime>);
  static_assert(!Addable<GlobalTime, GlobalTime>);
  static_assert(!Addable<Microticks, Macroticks>);
  static_assert(!std::is_convertible_v<std::int64_t, GlobalTime>);
}

TEST(Time, DifferencesAreDurations) {
  const GlobalTime a{1'000'000}, b{1'250'000};
  EXPECT_EQ(b - a, Duration::microseconds(250));
  EXPECT_EQ(a + Duration::microseconds(250), b);
  EXPECT_LT(a, b);
  EXPECT_DOUBLE_EQ(Duration::milliseconds(40).seconds(), 0.04);
}

}  // namespace
}  // namespace ttf
