#include "core/time.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace ttf {
namespace {

template <class A, class B>
concept Subtractable = requires(A a, B b) {
  a - b;
};
template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};

TEST(Time, TheThreeTimesDoNotMix) {
  static_assert(Subtractable<TrueTime, TrueTime>);
  static_assert(!Subtractable<TrueTime, LocalTime>);
  static_assert(!Subtractable<GlobalTime, LocalTime>);
  static_assert(!Addable<GlobalTime, GlobalTime>);
  static_assert(!Addable<Microticks, Macroticks>);
  static_assert(!std::is_convertible_v<std::int64_t, GlobalTime>);
}

TEST(Time, NothingTurnsIntoATimeByItself) {
  static_assert(!std::is_convertible_v<double, Duration> && !std::is_convertible_v<std::int64_t, Duration>);
  static_assert(!std::is_convertible_v<Duration, GlobalTime> && !std::is_convertible_v<GlobalTime, Duration>);
  static_assert(!std::is_convertible_v<TrueTime, LocalTime> && !std::is_convertible_v<LocalTime, TrueTime>);
  static_assert(!std::is_convertible_v<LocalTime, GlobalTime> && !std::is_convertible_v<GlobalTime, TrueTime>);
  static_assert(!std::is_convertible_v<Microticks, Macroticks> && !std::is_convertible_v<Microticks, Duration>);
  static_assert(!Subtractable<Duration, GlobalTime> && !Addable<Duration, GlobalTime>);
  static_assert(!Addable<TrueTime, TrueTime> && !Addable<Duration, Microticks>);
  static_assert(sizeof(GlobalTime) == sizeof(std::int64_t) && std::is_trivially_copyable_v<GlobalTime>);
}

TEST(Time, CountsAndDurationsReckonExactly) {
  Microticks ticks{40};
  ticks += Microticks{2};
  ticks -= Microticks{12};
  EXPECT_EQ(ticks, Microticks{30});
  EXPECT_EQ(3 * ticks, ticks * 3);
  EXPECT_EQ(-(ticks - Microticks{50}), Microticks{20});
  EXPECT_LT(ticks, Microticks{31});
  Duration d = Duration::microseconds(3);
  d += Duration::nanoseconds(5);
  d -= Duration::milliseconds(1);
  EXPECT_EQ(d.ns, 3'005 - 1'000'000);
  EXPECT_EQ(-d * 2, Duration{1'993'990});
  EXPECT_EQ(2 * -d, Duration{1'993'990});
  EXPECT_EQ(Duration{}.ns, 0);
  // A century of nanoseconds and one more: no floating point in between.
  const TrueTime far{3'155'760'000'000'000'000};
  EXPECT_EQ((far + Duration{1}) - far, Duration{1});
  TrueTime later = far - Duration::milliseconds(2);
  later += Duration::milliseconds(2);
  EXPECT_EQ(later, far);
}

TEST(Time, DifferencesAreDurations) {
  const GlobalTime a{1'000'000}, b{1'250'000};
  EXPECT_EQ(b - a, Duration::microseconds(250));
  EXPECT_EQ(a + Duration::microseconds(250), b);
  EXPECT_LT(a, b);
  EXPECT_DOUBLE_EQ(Duration::milliseconds(40).seconds(), 0.04);
}

TEST(Time, IsReadInMillisecondsAndInUnitsOfAnother) {
  EXPECT_DOUBLE_EQ(in_ms(Duration::microseconds(1'500)), 1.5);
  EXPECT_DOUBLE_EQ(in_units_of(Duration::milliseconds(5), Duration::milliseconds(12)), 2.4);
  EXPECT_DOUBLE_EQ(in_units_of(Duration::milliseconds(5), Duration::milliseconds(-5)), -1.0);
}

}  // namespace
}  // namespace ttf
