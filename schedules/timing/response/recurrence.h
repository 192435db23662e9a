// The recurrences behind fixed priorities and CAN: the least solution of w = fixed + sum_j ceil((w + a_j) / T_j) C_j,
// and the largest response over the instances of a busy period. Internal to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/int128.h"
#include "schedules/timing/response/response.h"

namespace ttf::schedules::timing::response {

// Work that comes at most ceil((t + ahead) / period) times in a window of length t.
struct Source {
  std::int64_t period = 1;
  std::int64_t ahead = 0;  // jitter, and time that counts beyond the window
  std::int64_t work = 0;
};

// How a load (sum work / period) compares with one.
enum class Load : std::uint8_t { kBelow, kFull, kAbove };

constexpr Int128 ceil_of(Int128 dividend, Int128 divisor) {
  return dividend >= 0 ? (dividend + divisor - 1) / divisor : -(-dividend / divisor);
}

// Returns the least common multiple of the periods; nullopt beyond kLongestResponse.
std::optional<std::int64_t> hyperperiod(std::span<const Source> sources);

// kAbove as well if the load is within 2^-60 of one for each source and the hyperperiod is beyond kLongestResponse:
// then whole numbers do not decide it. kBelow may be kFull then.
Load load_of(std::span<const Source> sources);

// Returns the most work in a window, cut at a little more than kLongestResponse.
Int128 work_in(std::span<const Source> sources, std::int64_t window);

// Counts the terms that an answer has looked at.
struct Effort {
  std::int64_t left = 2'000'000;
};

// Returns the least w >= start with w = fixed + work_in(w); `start` must not exceed it. Returns nullopt if w exceeds
// kLongestResponse or the effort is spent.
std::optional<std::int64_t> least_window(Int128 fixed, std::span<const Source> sources, std::int64_t start,
                                         Effort& effort);

// A task or message among others of higher priority.
struct Level {
  std::int64_t blocking = 0;     // B
  Source own;                    // ahead: its jitter
  std::vector<Source> others;    // higher priorities; ahead: their jitters
  std::int64_t tail = 0;         // the last part of its work, which nothing interrupts: 0 or own.work
  std::int64_t tick = 0;         // others that come this long after the tail's beginning go first, too
  std::optional<Source> errors;  // errors on the medium; those during the tail count, too
};

// Returns the largest response: kExact from the recurrence, kBound from the closed form, or kUnbounded.
Response longest_response(const Level& level);

}  // namespace ttf::schedules::timing::response
