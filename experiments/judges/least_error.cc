#include "experiments/judges/least_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace ttf::experiments::judges {
namespace {

// A stream's ages at first use: the least one and `from`, up to `length` more, the end excluded.
struct Side {
  std::int64_t from = 0, length = 0;
};
struct Box {
  std::vector<Side> sides;
  double bound = 0.0;
  int number = 0;  // boxes of one bound in the order that they were made
};
struct WorseBox {
  bool operator()(const Box& a, const Box& b) const {
    return std::pair{a.bound, a.number} > std::pair{b.bound, b.number};
  }
};

class PhaseSearch {
 public:
  PhaseSearch(const Possible& possible, const std::function<double(const Round&)>& bounded)
      : possible_(possible), bounded_(bounded), length_(possible.every.ns) {
    for (const Stream& stream : possible.streams) length_ = std::lcm(length_, stream.period.ns);
  }

  double run(double enough, int most_boxes) {
    Box whole;
    for (const Stream& stream : possible_.streams) whole.sides.push_back({0, stream.period.ns});
    open_.push(whole);
    while (!open_.empty()) {
      if (open_.top().bound > enough || made_ >= most_boxes) return open_.top().bound;
      Box box = open_.top();
      Side& longest = *std::max_element(box.sides.begin(), box.sides.end(),
                                        [](const Side& a, const Side& b) { return a.length < b.length; });
      if (longest.length < 2 * kShortest) return box.bound;
      open_.pop();
      const std::int64_t half = longest.length / 2, end = longest.from + longest.length;
      longest.length = half;
      add(box);
      longest = {longest.from + half, end - longest.from - half};
      add(std::move(box));
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr std::int64_t kShortest = 1'000;  // [ns]
  static constexpr std::size_t kNoStream = std::numeric_limits<std::size_t>::max();
  static constexpr Duration kAnyAge = Duration::milliseconds(1'000'000);

  void add(Box box) {
    ++made_;
    const double bound = least_of(box);
    if (bound == std::numeric_limits<double>::infinity()) return;
    box.bound = std::max(box.bound, bound);
    box.number = made_;
    open_.push(std::move(box));
  }

  // Where no instants have these ages, at least one stream is used later than its least age allows.
  double least_of(const Box& box) const {
    if (attainable(box, kNoStream)) return bound_of(box, kNoStream);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t late = 0; late < box.sides.size(); ++late)
      if (attainable(box, late)) least = std::min(least, bound_of(box, late));
    return least;
  }

  // With a late stream, any of the others may be late, too.
  bool attainable(const Box& box, std::size_t late) const {
    if (!possible_.attainable) return late == kNoStream;
    std::vector<Duration> youngest, oldest;
    for (std::size_t s = 0; s < box.sides.size(); ++s) {
      const Stream& stream = possible_.streams[s];
      const Side& side = box.sides[s];
      // A box over several uses says nothing, nor does a sensor that measures more often than it is used.
      const std::int64_t every = possible_.every.ns, within = side.from % every;
      const bool known = stream.period.ns >= every && within + side.length <= every;
      youngest.push_back(stream.least_age + Duration{known ? within + (s == late ? every : 0) : 0});
      oldest.push_back(known && late == kNoStream ? stream.least_age + Duration{within + side.length} : kAnyAge);
    }
    return possible_.attainable(youngest, oldest);
  }

  double bound_of(const Box& box, std::size_t late) const {
    Round round;
    round.length = {length_};
    round.held = possible_.held;
    for (std::int64_t use = 0; use < length_; use += possible_.every.ns) round.uses.push_back({use});
    for (std::size_t s = 0; s < box.sides.size(); ++s) {
      const Stream& stream = possible_.streams[s];
      const Side& side = box.sides[s];
      // Its middle must not lie behind the first use.
      if (side.length > 2 * stream.least_age.ns) return 0.0;
      for (std::int64_t start = 0; start < length_; start += stream.period.ns) {
        const Duration measured{start - stream.least_age.ns - side.from - side.length};
        const Duration soonest = stream.least_age + Duration{s == late ? possible_.every.ns : 0};
        round.sightings.push_back({measured, stream.variance, measured + soonest + Duration{1}, Duration{side.length}});
      }
    }
    return bounded_(round);
  }

  const Possible& possible_;
  const std::function<double(const Round&)>& bounded_;
  std::int64_t length_;
  std::priority_queue<Box, std::vector<Box>, WorseBox> open_;
  int made_ = 0;
};

}  // namespace

double least_over_phases(const Possible& possible, const std::function<double(const Round&)>& bounded, double enough,
                         int most_boxes) {
  return PhaseSearch(possible, bounded).run(enough, most_boxes);
}

double bounded_mean_error(const Round& round, Motion motion, double density) {
  Duration longest{};
  double information = 0.0;  // per second
  for (const Sighting& one : round.sightings) {
    longest = std::max(longest, one.within);
    information += 1.0 / (one.variance * round.length.seconds());
  }
  if (motion == Motion::kRandomWalk) return mean_error(round, motion, density);
  // A settled filter looks back over this time (docs/results/rate_and_age.md). The box moves a measurement by a share
  // of it.
  const double back = std::pow(1.0 / (information * density), 0.25);
  return mean_error(round, motion, density, std::max(1e-9, longest.seconds() / back));
}

}  // namespace ttf::experiments::judges
