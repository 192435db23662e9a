#include "recording/rows/leaping_stamps.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ttf::recording::rows {
namespace {

constexpr std::size_t kFewestStamps = 8;
constexpr std::int64_t kStepsInReach = 20;

using Member = std::int64_t RowStamps::*;
constexpr Member kBoth[] = {&RowStamps::time, &RowStamps::arrival};

// Successive rows with the same stamps: rows[first .. first + count) of those that do not leap.
struct Group {
  RowStamps stamps;
  std::size_t first = 0, count = 0;
};

// `kept`: the rows that do not leap.
std::vector<Group> grouped(std::span<const RowStamps> rows, std::span<const std::size_t> kept) {
  std::vector<Group> groups;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const RowStamps& stamps = rows[kept[k]];
    const bool same =
        !groups.empty() && groups.back().stamps.time == stamps.time && groups.back().stamps.arrival == stamps.arrival;
    if (!same) groups.push_back({stamps, k, 0});
    ++groups.back().count;
  }
  return groups;
}

std::int64_t distance(std::int64_t a, std::int64_t b) { return a < b ? b - a : a - b; }

// Judges one of a row's two stamps.
class Series {
 public:
  Series(const std::vector<Group>& groups, Member member, std::int64_t second) : member_(member) {
    std::vector<std::int64_t> steps;
    std::size_t ascending = 0;
    for (std::size_t i = 1; i < groups.size(); ++i) {
      steps.push_back(distance(at(groups[i - 1]), at(groups[i])));
      ascending += at(groups[i]) >= at(groups[i - 1]);
    }
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const bool long_steps = *middle > std::numeric_limits<std::int64_t>::max() / kStepsInReach;
    reach_ = long_steps ? std::numeric_limits<std::int64_t>::max() : std::max(second, kStepsInReach * *middle);
    ascends_ = ascending > steps.size() / 2;
    const auto [low, high] = std::minmax_element(groups.begin() + 1, groups.end() - 1,
                                                 [this](const Group& a, const Group& b) { return at(a) < at(b); });
    low_ = at(*low);
    high_ = at(*high);
  }

  bool leaps_between(const Group& above, const Group& one, const Group& below) const {
    return distance(at(above), at(below)) <= reach_ && distance(at(one), at(above)) > reach_ &&
           distance(at(one), at(below)) > reach_;
  }
  bool leaps_first(const Group& first, const Group& last) const {
    const std::int64_t high = std::max(high_, at(last));
    return ascends_ && at(first) > high && distance(at(first), high) > reach_;
  }
  bool leaps_last(const Group& last, const Group& first) const {
    const std::int64_t low = std::min(low_, at(first));
    return ascends_ && at(last) < low && distance(at(last), low) > reach_;
  }

 private:
  std::int64_t at(const Group& group) const { return group.stamps.*member_; }

  Member member_;
  std::int64_t reach_ = 0, low_ = 0, high_ = 0;  // low and high: without the two ends
  bool ascends_ = false;
};

}  // namespace

std::vector<Leap> leaping_stamps(std::span<const RowStamps> rows, std::int64_t second) {
  std::vector<bool> leaps(rows.size(), false);
  std::vector<std::size_t> kept(rows.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  std::vector<Leap> found;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const std::vector<Group> groups = grouped(rows, kept);
    if (groups.size() < kFewestStamps) break;
    const Series series[] = {{groups, kBoth[0], second}, {groups, kBoth[1], second}};
    const auto both = [&](const auto& judge) { return judge(series[0]) && judge(series[1]); };
    const std::size_t before = found.size();
    const auto mark = [&](const Group& group, const Group& above, const Group& below) {
      for (std::size_t k = group.first; k < group.first + group.count; ++k) {
        leaps[kept[k]] = true;
        found.push_back({kept[k], above.stamps.time, below.stamps.time});
      }
    };
    const std::size_t last = groups.size() - 1;
    std::size_t above = 0;  // the nearest one before that does not leap
    if (both([&](const Series& one) { return one.leaps_first(groups[0], groups[last]); })) {
      mark(groups[0], groups[1], groups[1]);
      above = 1;
    }
    for (std::size_t i = above + 1; i < last; ++i) {
      if (both([&](const Series& one) { return one.leaps_between(groups[above], groups[i], groups[i + 1]); }))
        mark(groups[i], groups[above], groups[i + 1]);
      else
        above = i;
    }
    if (both([&](const Series& one) { return one.leaps_last(groups[last], groups[0]); }))
      mark(groups[last], groups[above], groups[above]);
    if (found.size() == before) break;
    std::erase_if(kept, [&](std::size_t row) { return leaps[row]; });
  }
  std::sort(found.begin(), found.end(), [](const Leap& a, const Leap& b) { return a.row < b.row; });
  return found;
}

}  // namespace ttf::recording::rows
