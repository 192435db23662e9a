// The three times of a distributed time-triggered system, as three types that do not mix.
//
// TrueTime    the time that an ideal observer outside the cluster reads; exists only in the simulator and its logs.
// LocalTime   the time of one node's free-running oscillator: its microticks times the nominal microtick.
// GlobalTime  the time that the cluster agrees on by clock synchronisation, as one node sees it.
//
// All are signed 64-bit nanosecond counts from the start of the drive (about +-292 years). There is no
// conversion between them here: a conversion needs a clock (timebase/) and is spelled out. The difference of two
// instants of one time is a Duration. Floating point appears only in a filter's dt, `Duration::seconds()`, and
// in texts for people: `in_us()`, `in_ms()` and `in_units_of()`.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

namespace ttf {

// A strongly typed signed count: quantities of different tags never mix.
template <class Tag> struct Count {
  std::int64_t value = 0;

  constexpr auto operator<=>(const Count&) const = default;
  friend constexpr Count operator+(Count a, Count b) { return {a.value + b.value}; }
  friend constexpr Count operator-(Count a, Count b) { return {a.value - b.value}; }
  friend constexpr Count operator-(Count a) { return {-a.value}; }
  friend constexpr Count operator*(Count a, std::int64_t factor) { return {a.value * factor}; }
  friend constexpr Count operator*(std::int64_t factor, Count a) { return {a.value * factor}; }
  constexpr Count& operator+=(Count other) {
    value += other.value;
    return *this;
  }
  constexpr Count& operator-=(Count other) {
    value -= other.value;
    return *this;
  }
};

// Ticks of one node's oscillator (about 25 ns). As an instant they count from the node's power-on.
using Microticks = Count<struct MicrotickTag>;
// The granule of global time (about 1 us); a whole number of macroticks makes a communication cycle.
using Macroticks = Count<struct MacrotickTag>;

// A difference of two instants, in nanoseconds.
struct Duration {
  std::int64_t ns = 0;

  static constexpr Duration nanoseconds(std::int64_t n) { return {n}; }
  static constexpr Duration microseconds(std::int64_t n) { return {n * 1'000}; }
  static constexpr Duration milliseconds(std::int64_t n) { return {n * 1'000'000}; }
  constexpr double seconds() const { return static_cast<double>(ns) * 1e-9; }

  constexpr auto operator<=>(const Duration&) const = default;
  friend constexpr Duration operator+(Duration a, Duration b) { return {a.ns + b.ns}; }
  friend constexpr Duration operator-(Duration a, Duration b) { return {a.ns - b.ns}; }
  friend constexpr Duration operator-(Duration a) { return {-a.ns}; }
  friend constexpr Duration operator*(Duration a, std::int64_t factor) { return {a.ns * factor}; }
  friend constexpr Duration operator*(std::int64_t factor, Duration a) { return {a.ns * factor}; }
  constexpr Duration& operator+=(Duration other) {
    ns += other.ns;
    return *this;
  }
  constexpr Duration& operator-=(Duration other) {
    ns -= other.ns;
    return *this;
  }
};

// An instant on the scale named by Tag, in nanoseconds since the start of the drive.
template <class Tag> struct Instant {
  std::int64_t ns = 0;

  constexpr auto operator<=>(const Instant&) const = default;
  friend constexpr Duration operator-(Instant a, Instant b) { return {a.ns - b.ns}; }
  friend constexpr Instant operator+(Instant t, Duration d) { return {t.ns + d.ns}; }
  friend constexpr Instant operator-(Instant t, Duration d) { return {t.ns - d.ns}; }
  constexpr Instant& operator+=(Duration d) {
    ns += d.ns;
    return *this;
  }
};

using TrueTime = Instant<struct TrueScale>;
using LocalTime = Instant<struct LocalScale>;
using GlobalTime = Instant<struct GlobalScale>;

// Later than every instant and longer than every delay. Compare with it, but never do arithmetic with it.
template <class Time> inline constexpr Time kNever{std::numeric_limits<std::int64_t>::max()};

// Microseconds, milliseconds and multiples of a unit (mostly cycles), for people only: never compute with them.
constexpr double in_us(Duration d) { return static_cast<double>(d.ns) * 1e-3; }
constexpr double in_ms(Duration d) { return static_cast<double>(d.ns) * 1e-6; }
template <class Tag> constexpr double in_ms(Instant<Tag> t) { return static_cast<double>(t.ns) * 1e-6; }

constexpr double in_units_of(Duration unit, Duration d) {
  return static_cast<double>(d.ns) / static_cast<double>(unit.ns);
}

}  // namespace ttf
