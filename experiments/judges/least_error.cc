#include "experiments/judges/least_error.h"

#include <algorithm>
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
      Side& longest = box.sides[widest(box)];
      if (longest.length < 2 * kShortest) return box.bound;
      open_.pop();
      const std::int64_t half = longest.length / 2, end = longest.from + longest.length;
      longest.length = half;
      add(box);
      longest = {longest.from + half, end - longest.from - half};
      add(std::move(box));
    }
    return kNone;
  }

 private:
  static constexpr std::int64_t kShortest = 1'000;  // [ns]
  static constexpr std::size_t kMostLate = 4;
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  static constexpr Duration kAnyAge = Duration::milliseconds(1'000'000);

  // Returns the side that matters most: its length by the information of its stream.
  std::size_t widest(const Box& box) const {
    std::size_t at = 0;
    double most = -1.0;
    for (std::size_t s = 0; s < box.sides.size(); ++s) {
      const double weight = box.sides[s].length < 2 * kShortest
                                ? 0.0
                                : static_cast<double>(box.sides[s].length) / possible_.streams[s].variance;
      if (weight <= most) continue;
      at = s;
      most = weight;
    }
    return at;
  }

  void add(Box box) {
    ++made_;
    const double bound = least_of(box);
    if (bound == kNone) return;
    box.bound = std::max(box.bound, bound);
    box.number = made_;
    open_.push(std::move(box));
  }

  // Returns the least bound over the streams that are late: the smallest sets of them with which there are instants.
  // With more late streams a filter has less data.
  double least_of(const Box& box) const {
    double least = kNone;
    std::vector<std::vector<bool>> sets{std::vector<bool>(box.sides.size(), false)}, found;
    for (std::size_t size = 0; size <= box.sides.size(); ++size) {
      std::vector<std::vector<bool>> larger;
      const bool last = size >= kMostLate;
      for (const std::vector<bool>& late : sets) {
        if (attainable(box, late, last)) {
          found.push_back(late);
          least = std::min(least, bound_of(box, late));
          continue;
        }
        for (std::size_t s = 0; !last && s < late.size(); ++s)
          if (!late[s] && known(box, s)) larger.push_back(with(late, s));
      }
      std::sort(larger.begin(), larger.end());
      larger.erase(std::unique(larger.begin(), larger.end()), larger.end());
      std::erase_if(larger, [&](const auto& late) {
        return std::any_of(found.begin(), found.end(), [&](const auto& smaller) { return holds(late, smaller); });
      });
      sets = std::move(larger);
    }
    return least;
  }

  static std::vector<bool> with(std::vector<bool> late, std::size_t s) {
    late[s] = true;
    return late;
  }
  static bool holds(const std::vector<bool>& late, const std::vector<bool>& smaller) {
    for (std::size_t s = 0; s < late.size(); ++s)
      if (smaller[s] && !late[s]) return false;
    return true;
  }

  // A box over several uses says nothing about an age, nor does a sensor that measures more often than it is used.
  bool known(const Box& box, std::size_t s) const {
    const std::int64_t every = possible_.every.ns;
    return possible_.streams[s].period.ns >= every && box.sides[s].from % every + box.sides[s].length <= every;
  }

  // Whether instants have the box's ages, and those of late streams by one use more, or by several. `any`: other
  // streams may be late as well.
  bool attainable(const Box& box, const std::vector<bool>& late, bool any) const {
    const bool all = std::none_of(late.begin(), late.end(), [](bool one) { return one; });
    if (!possible_.attainable) return all;
    std::vector<Duration> youngest, oldest;
    for (std::size_t s = 0; s < box.sides.size(); ++s) {
      const Duration least = possible_.streams[s].least_age;
      const std::int64_t every = possible_.every.ns, within = box.sides[s].from % every;
      const bool is_known = known(box, s);
      youngest.push_back(least + Duration{is_known ? within + (late[s] ? every : 0) : 0});
      oldest.push_back(is_known && !late[s] && !any ? least + Duration{within + box.sides[s].length} : kAnyAge);
    }
    return possible_.attainable(youngest, oldest);
  }

  double bound_of(const Box& box, const std::vector<bool>& late) const {
    Round round;
    round.length = {length_};
    round.held = possible_.held;
    for (std::int64_t use = 0; use < length_; use += possible_.every.ns) round.uses.push_back({use});
    for (std::size_t s = 0; s < box.sides.size(); ++s) {
      const Stream& stream = possible_.streams[s];
      const Side& side = box.sides[s];
      for (std::int64_t start = 0; start < length_; start += stream.period.ns) {
        const Duration measured{start - stream.least_age.ns - side.from - side.length + 1};
        const Duration soonest = stream.least_age + Duration{late[s] ? possible_.every.ns : 0};
        round.sightings.push_back({measured, stream.variance, measured + soonest, Duration{side.length - 1}});
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

}  // namespace ttf::experiments::judges
