#include "schedules/timing/response/recurrence.h"

#include <algorithm>
#include <cstddef>

#include "core/check.h"
#include "schedules/timing/common_multiple.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr int kLoadBits = 60;
constexpr Int128 kOne = Int128{1} << kLoadBits;  // a load of one

struct LoadRange {
  Int128 least = 0, most = 0;  // in parts of kOne
};

LoadRange load_range(std::span<const Source> sources) {
  LoadRange range;
  for (const Source& one : sources) {
    const Int128 work = static_cast<Int128>(one.work) << kLoadBits;
    range.least += work / one.period;
    range.most += ceil_of(work, one.period);
  }
  return range;
}

// Window and `ahead` are at most 2^62 each, so the sum fits 64 bits without a sign, whose division is the fastest.
std::int64_t times_in(const Source& source, std::int64_t window) {
  const auto period = static_cast<std::uint64_t>(source.period);
  const std::uint64_t length = static_cast<std::uint64_t>(window) + static_cast<std::uint64_t>(source.ahead);
  return static_cast<std::int64_t>((length + period - 1) / period);
}

// The sources of the level's busy period, and those that delay the beginning of its tail.
struct LevelSources {
  std::vector<Source> busy, delaying;
};

LevelSources sources_of(const Level& level) {
  LevelSources sources;
  for (const Source& other : level.others) {
    sources.busy.push_back(other);
    sources.delaying.push_back(other);
    sources.delaying.back().ahead += level.tick;
  }
  if (level.errors) {
    sources.busy.push_back(*level.errors);
    sources.delaying.push_back(*level.errors);
    sources.delaying.back().ahead += level.tail;
  }
  sources.busy.push_back(level.own);
  return sources;
}

// Returns how many instances to look at: those of the busy period, or of a hyperperiod at full load.
std::optional<std::int64_t> instances_of(const Level& level, std::span<const Source> busy, Load load, Effort& effort) {
  if (load == Load::kFull)
    if (const auto repeats = hyperperiod(busy)) return *repeats / level.own.period;
  const auto length = least_window(level.blocking, busy, 1, effort);
  if (!length) return std::nullopt;
  return times_in(level.own, *length);
}

std::optional<std::int64_t> from_recurrence(const Level& level, const LevelSources& sources, Load load) {
  Effort effort;
  const auto instances = instances_of(level, sources.busy, load, effort);
  if (!instances) return std::nullopt;
  const Int128 step = level.own.work;
  Int128 longest = 0;
  std::int64_t window = 0;
  for (std::int64_t q = 0; q < *instances; ++q) {
    if (--effort.left < 0) return std::nullopt;
    const Int128 fixed = level.blocking + (q + 1) * step - level.tail;
    const auto next = least_window(fixed, sources.delaying, window, effort);
    if (!next) return std::nullopt;
    window = *next;
    const Int128 arrival = static_cast<Int128>(q) * level.own.period - level.own.ahead;
    longest = std::max(longest, window + level.tail - arrival);
  }
  if (longest > kLongestResponse) return std::nullopt;
  return static_cast<std::int64_t>(longest);
}

std::optional<std::int64_t> from_closed_form(const Level& level, std::span<const Source> delaying) {
  const Int128 rest = kOne - load_range(delaying).most;
  if (rest <= 0) return std::nullopt;
  Int128 work = level.blocking + level.own.work - level.tail;
  for (const Source& other : delaying) {
    work += ceil_of(static_cast<Int128>(other.work) * (static_cast<Int128>(other.ahead) + other.period), other.period);
    if (work > kLongestResponse) return std::nullopt;
  }
  const Int128 bound = level.own.ahead + level.tail + ceil_of(work << kLoadBits, rest);
  if (bound > kLongestResponse) return std::nullopt;
  return static_cast<std::int64_t>(bound);
}

}  // namespace

std::optional<std::int64_t> hyperperiod(std::span<const Source> sources) {
  std::optional<std::int64_t> all = 1;
  for (std::size_t i = 0; all && i < sources.size(); ++i)
    all = common_multiple(*all, sources[i].period, kLongestResponse);
  return all;
}

Load load_of(std::span<const Source> sources) {
  const LoadRange range = load_range(sources);
  if (range.least > kOne) return Load::kAbove;
  if (range.most < kOne) return Load::kBelow;
  const auto repeats = hyperperiod(sources);
  if (!repeats) return range.most > kOne ? Load::kAbove : Load::kBelow;
  Int128 work = 0;
  for (const Source& one : sources) work += static_cast<Int128>(*repeats / one.period) * one.work;
  if (work == *repeats) return Load::kFull;
  return work > *repeats ? Load::kAbove : Load::kBelow;
}

Int128 work_in(std::span<const Source> sources, std::int64_t window) {
  Int128 work = 0;
  for (const Source& one : sources) {
    work += static_cast<Int128>(times_in(one, window)) * one.work;
    if (work > kLongestResponse) return static_cast<Int128>(kLongestResponse) + 1;
  }
  return work;
}

std::optional<std::int64_t> least_window(Int128 fixed, std::span<const Source> sources, std::int64_t start,
                                         Effort& effort) {
  std::int64_t window = start;
  for (;;) {
    effort.left -= static_cast<std::int64_t>(sources.size()) + 1;
    const Int128 next = fixed + work_in(sources, window);
    if (next > kLongestResponse || effort.left < 0) return std::nullopt;
    if (next <= window) return window;
    window = static_cast<std::int64_t>(next);
  }
}

Response longest_response(const Level& level) {
  for (const Source& one : level.others)
    TTF_CHECK(one.period >= 1 && one.work >= 1, "period {}, work {}", one.period, one.work);
  TTF_CHECK(level.own.period >= 1 && level.own.work >= 1, "period {}, work {}", level.own.period, level.own.work);
  const LevelSources sources = sources_of(level);
  const Load load = load_of(sources.busy);
  if (load == Load::kAbove) return {};
  if (const auto longest = from_recurrence(level, sources, load)) return {Quality::kExact, *longest};
  if (const auto bound = from_closed_form(level, sources.delaying)) return {Quality::kBound, *bound};
  return {};
}

}  // namespace ttf::schedules::timing::response
