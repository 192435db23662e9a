#include "schedules/synthesis/instants/placement.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/instants/graph.h"
#include "schedules/synthesis/instants/grid.h"
#include "schedules/synthesis/instants/order.h"
#include "schedules/synthesis/instants/reach.h"

namespace ttf::schedules::synthesis::instants {

namespace {

enum class Side { kBefore, kBehind };

class Engine {
 public:
  Engine(const Reading& reading, const Limits& limits, bool any, std::int64_t most_steps)
      : reading_(reading), problem_(reading.problem), limits_(limits), any_(any), most_steps_(most_steps),
        graph_(problem_), at_(problem_.activities.size()), placed_(problem_.activities.size()), grids_(),
        standing_(problem_.resources.size()) {
    for (const Activity& activity : problem_.activities) {
      grids_.push_back(activity.grid);
      if (limits_.last_slot && is_list(activity))
        grids_.back().last = std::min(grids_.back().last, *limits_.last_slot - activity.duration);
    }
    for (const Chain& chain : problem_.chains) {
      std::vector<Ticks> heads(1);
      for (std::size_t i = 1; i < chain.activities.size(); ++i)
        heads.push_back(heads.back() + problem_.activities[chain.activities[i - 1]].duration + chain.gaps[i - 1]);
      heads_.push_back(std::move(heads));
    }
    least_ = least_ages(problem_);
    least_worst_ = least_worst_age(problem_, limits_.beyond);
    choose_anchor();
  }

  Search run() {
    found_.exact = !possible();
    if (found_.exact) return std::move(found_);
    const std::vector<Ticks> all = positions();
    for (std::size_t p = 0; p < all.size() && !(any_ && found_.best); ++p) {
      // Each position has its share of the steps that are left.
      until_ = found_.steps + (most_steps_ - found_.steps) / static_cast<std::int64_t>(all.size() - p);
      begin(all[p]);
      if (fits(place_waiting()) && !done()) descend();
      reset();
    }
    found_.exact = exact();
    return std::move(found_);
  }

 private:
  static bool is_list(const Activity& activity) { return activity.grid.step > 1; }
  bool done() {
    cut_ = cut_ || found_.steps >= until_;
    return found_.steps >= until_ || (any_ && found_.best);
  }

  // The end of most chains, and all that leads there.
  void choose_anchor() {
    std::vector<std::size_t> ends(problem_.activities.size());
    for (const Chain& chain : problem_.chains) ++ends[chain.activities.back()];
    anchor_ = static_cast<std::size_t>(std::max_element(ends.begin(), ends.end()) - ends.begin());
    for (std::size_t a = 0; a < problem_.activities.size(); ++a) main_.push_back(graph_.leads(a, anchor_));
    for (const Chain& chain : problem_.chains) one_anchor_ = one_anchor_ && chain.activities.back() == anchor_;
  }

  // Whether what stands leaves any room.
  bool possible() const {
    for (std::size_t a = 0; a < problem_.activities.size(); ++a) {
      const Activity& one = problem_.activities[a];
      if (one.duration > one.period || (!one.fixed && grids_[a].last < grids_[a].first)) return false;
      // A task ends before its next activation.
      if (one.resource && one.resource != std::size_t{0} && one.duration == one.period) return false;
      if (one.fixed && limits_.last_slot && one.resource == std::size_t{0} &&
          modulo(*one.fixed, cycle()) + one.duration > *limits_.last_slot)
        return false;
      for (std::size_t b = 0; b < a; ++b) {
        const Activity& other = problem_.activities[b];
        if (one.fixed && other.fixed && share_a_lane(one, other) &&
            in_the_way(one, *one.fixed, other, *other.fixed, true) != 0)
          return false;
      }
    }
    for (std::size_t c = 0; c < problem_.chains.size(); ++c)
      if (least_[c] > limit_of(c)) return false;
    return !limits_.worst_age || least_worst_ <= *limits_.worst_age;
  }

  Ticks limit_of(std::size_t chain) const { return instants::limit_of(problem_, limits_, chain); }
  Ticks beyond(std::size_t chain) const { return limits_.beyond.empty() ? 0 : limits_.beyond[chain]; }

  Ticks cycle() const {
    for (const Activity& activity : problem_.activities)
      if (is_list(activity)) return activity.grid.period;
    return problem_.activities[anchor_].period;
  }

  // Whether instants are bound to a cycle of the round, not only within a cycle.
  bool bound_to_cycles() const {
    return std::any_of(problem_.activities.begin(), problem_.activities.end(),
                       [&](const Activity& one) { return one.fixed && one.period > cycle(); });
  }

  // Returns the beginnings of the anchor to try. It can be no earlier there: a list's data comes then, or a fixed
  // activity on its resource ends. A task before it may hold it up at any other tick.
  std::vector<Ticks> positions() {
    const Activity& anchor = problem_.activities[anchor_];
    if (anchor.fixed) return {*anchor.fixed};
    std::set<Ticks> found;
    for (const Edge& edge : graph_.before[anchor_]) {
      const Activity& before = problem_.activities[edge.other];
      if (before.fixed) found.insert(*before.fixed + edge.gap);
      all_positions_ = all_positions_ && (before.fixed || is_list(before) || !before.resource);
      if (before.fixed || !is_list(before)) continue;
      for (Ticks at = grids_[edge.other].first; at <= grids_[edge.other].last; at += grids_[edge.other].step)
        found.insert(at + edge.gap);
    }
    if (found.empty()) {
      all_positions_ = false;
      for (Ticks at = 0; at < cycle(); at += std::max<Ticks>(1, cycle() / 128)) found.insert(at);
    }
    for (const Activity& other : problem_.activities)
      if (other.fixed && anchor.resource && other.resource == anchor.resource)
        found.insert(modulo(*other.fixed + other.duration, cycle()));
    std::vector<Ticks> all;
    for (Ticks start = 0; start < (bound_to_cycles() ? anchor.period : 1); start += cycle())
      for (const Ticks position : found) all.push_back(start + position);
    return all;
  }

  void begin(Ticks position) {
    for (std::size_t a = 0; a < problem_.activities.size(); ++a)
      if (problem_.activities[a].fixed && problem_.activities[a].resource)
        standing_[*problem_.activities[a].resource].push_back({a, *problem_.activities[a].fixed});
    ok_ = true;
    put(anchor_, position);
  }

  void reset() {
    std::fill(placed_.begin(), placed_.end(), false);
    for (auto& standing : standing_) standing.clear();
    trail_.clear();
  }

  // Places the activity at the nearest instant that its grid and its resource allow: at or before `asked`, or at or behind it.
  // Returns false if there is none within the periods that are searched.
  bool put(std::size_t a, Ticks asked, Side side = Side::kBefore) {
    ++found_.steps;
    const bool before = side == Side::kBefore;
    const Activity& activity = problem_.activities[a];
    Ticks at = on_grid(a, asked, before);
    if (a == anchor_ && at != asked) return ok_ = false;
    if (!activity.fixed && activity.resource) {
      const Ticks furthest = before ? activity.period : 2 * activity.period;
      const auto& standing = standing_[*activity.resource];
      for (std::size_t i = 0; i < standing.size();) {
        const Activity& other = problem_.activities[standing[i].first];
        const Ticks way =
            share_a_lane(activity, other) ? in_the_way(activity, at, other, standing[i].second, before) : 0;
        if (way == 0) {
          ++i;
          continue;
        }
        if (a == anchor_) return ok_ = false;
        at = on_grid(a, before ? at - way : at + way, before);
        if (std::abs(at - asked) > furthest) return false;
        i = 0;
      }
      standing_[*activity.resource].push_back({a, at});
    }
    at_[a] = at;
    placed_[a] = true;
    trail_.push_back(a);
    return true;
  }

  Ticks on_grid(std::size_t a, Ticks at, bool before) const {
    const Activity& activity = problem_.activities[a];
    if (activity.fixed)
      return before ? at - modulo(at - *activity.fixed, activity.period)
                    : at + modulo(*activity.fixed - at, activity.period);
    return before ? latest_on_grid(grids_[a], at) : next_on_grid(grids_[a], at);
  }

  void undo(std::size_t count) {
    while (trail_.size() > count) {
      const std::size_t a = trail_.back();
      trail_.pop_back();
      placed_[a] = false;
      const Activity& activity = problem_.activities[a];
      if (!activity.fixed && activity.resource) standing_[*activity.resource].pop_back();
    }
  }

  // Returns the latest beginning that all who take its data allow; none while one of them is not placed.
  std::optional<Ticks> latest(std::size_t a) const {
    std::optional<Ticks> least;
    for (const Edge& edge : graph_.after[a]) {
      if (!main_[edge.other]) continue;
      if (!placed_[edge.other]) return std::nullopt;
      least = std::min(least.value_or(std::numeric_limits<Ticks>::max()), at_[edge.other] - edge.gap);
    }
    return least;
  }

  bool contended(std::size_t a) const {
    const Activity& one = problem_.activities[a];
    if (!one.resource || one.fixed) return false;
    for (std::size_t b = 0; b < problem_.activities.size(); ++b) {
      const Activity& other = problem_.activities[b];
      if (b != a && !other.fixed && share_a_lane(one, other)) return true;
    }
    return false;
  }

  // Places all that wait for no order. Returns false where one has no room.
  bool place_waiting() {
    for (bool more = true; more && ok_;) {
      more = false;
      for (std::size_t a = 0; a < problem_.activities.size(); ++a) {
        if (placed_[a] || !main_[a] || contended(a)) continue;
        const auto before = latest(a);
        if (!before) continue;
        if (!put(a, *before)) return false;
        more = true;
      }
    }
    return ok_;
  }

  // Whether the ages so far leave hope for something better than the best.
  bool fits(bool placed) const {
    if (!placed) return false;
    Ticks worst = std::max<Ticks>(0, least_worst_), sum = 0;
    const std::vector<Ticks> measured = in_order_so_far();
    for (std::size_t c = 0; c < problem_.chains.size(); ++c) {
      Ticks least = least_[c];
      const std::vector<std::size_t>& way = problem_.chains[c].activities;
      if (way.back() == anchor_)
        for (std::size_t i = 0; i < way.size(); ++i)
          if (placed_[way[i]]) least = std::max(least, at_[anchor_] - measured[way[i]] + heads_[c][i]);
      if (least > limit_of(c)) return false;
      worst = std::max(worst, least + beyond(c));
      sum += least;
    }
    if (limits_.sum_of_ages && sum > *limits_.sum_of_ages) return false;
    return !found_.best || std::pair{worst, sum} < std::pair{best_worst_, best_sum_};
  }

  // Returns the beginnings, with measurements as early as the order of the lists placed so far demands.
  std::vector<Ticks> in_order_so_far() const {
    std::vector<Ticks> at = at_;
    if (!reading_.fused.empty()) (void)measure_in_order(reading_, placed_, at);
    return at;
  }

  // The longest head, also as its chain counts; none if the activity is on no chain.
  std::optional<Ticks> longest_head(std::size_t a, bool counted) const {
    std::optional<Ticks> longest;
    for (std::size_t c = 0; c < problem_.chains.size(); ++c)
      for (std::size_t i = 0; i < heads_[c].size(); ++i)
        if (problem_.chains[c].activities[i] == a)
          longest = std::max(longest.value_or(0), heads_[c][i] + (counted ? beyond(c) : 0));
    return longest;
  }

  // Those with the longest heads come next to the use first.
  Ticks urgency(std::size_t a) const { return longest_head(a, true).value_or(0); }

  // Tries every order of those that may be placed next.
  void descend() {
    std::vector<std::pair<std::size_t, Ticks>> next;
    bool all = true;
    for (std::size_t a = 0; a < problem_.activities.size(); ++a) {
      if (placed_[a] || !main_[a]) continue;
      all = false;
      if (const auto before = latest(a)) next.push_back({a, *before});
    }
    if (all) return finish();
    std::stable_sort(next.begin(), next.end(),
                     [&](const auto& a, const auto& b) { return urgency(a.first) > urgency(b.first); });
    for (const auto& [a, before] : next) {
      if (done()) return;
      const std::size_t count = trail_.size();
      if (put(a, before) && fits(place_waiting())) descend();
      undo(count);
    }
  }

  // Places all that leads to no chain's end, as early as may be.
  bool place_rest() {
    for (bool more = true; more;) {
      more = false;
      for (std::size_t a = 0; a < problem_.activities.size(); ++a) {
        if (placed_[a]) continue;
        const auto& before = graph_.before[a];
        if (std::any_of(before.begin(), before.end(), [&](const Edge& edge) { return !placed_[edge.other]; })) continue;
        Ticks earliest = std::numeric_limits<Ticks>::min();
        for (const Edge& edge : before) earliest = std::max(earliest, at_[edge.other] + edge.gap);
        if (before.empty()) earliest = at_[anchor_];
        if (!put(a, earliest, Side::kBehind)) return false;
        more = true;
      }
    }
    return true;
  }

  void finish() {
    const auto [before, count] = std::pair{at_, trail_.size()};
    if (!place_rest() || !measure_in_order(reading_, placed_, at_) || !take()) dropped_ = true;
    undo(count);
    at_ = before;
  }

  // Takes the placement if it is the best so far. Returns false if it breaks the order of lists or the limit of jitter.
  bool take() {
    Placed placed;
    const Ticks shift = bound_to_cycles() ? 0 : at_[anchor_] - modulo(at_[anchor_], cycle());
    for (std::size_t a = 0; a < at_.size(); ++a)
      placed.solution.offsets.push_back(
          problem_.activities[a].fixed.value_or(modulo(at_[a] - shift, problem_.activities[a].period)));
    if (fused_in_order(reading_, placed.solution.offsets) == false) return false;
    for (std::size_t c = 0; c < problem_.chains.size(); ++c) {
      const Ways found = ways(problem_, problem_.chains[c], placed.solution.offsets);
      if (found.longest > limit_of(c)) return true;
      placed.ages.push_back(found.longest);
      placed.least.push_back(found.shortest);
    }
    if (limits_.jitter && placed.jitter() > *limits_.jitter) return false;
    const std::pair reached{placed.worst_age(limits_.beyond), placed.sum_of_ages()};
    if (limits_.sum_of_ages && reached.second > *limits_.sum_of_ages) return true;
    if (found_.best && std::pair{best_worst_, best_sum_} <= reached) return true;
    std::tie(best_worst_, best_sum_) = reached;
    found_.best = std::move(placed);
    return true;
  }

  bool exact() const {
    if (found_.best && best_worst_ == least_worst_) return true;
    if (cut_ || !one_anchor_ || !all_positions_ || dropped_ || !all_orders_agree(reading_, graph_, main_)) return false;
    // A later place in one cycle may be in the way of others in another cycle.
    for (std::size_t a = 0; a < problem_.activities.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (main_[a] && main_[b] && own_their_places(problem_.activities[a], problem_.activities[b])) return false;
    const Ticks period = problem_.activities[anchor_].period, most = largest_possible();
    for (const Chain& chain : problem_.chains)
      for (const std::size_t a : chain.activities)
        if (problem_.activities[a].period != period) return false;
    std::vector<std::optional<Ticks>> by_age(problem_.activities.size());
    for (std::size_t a = 0; a < by_age.size(); ++a)
      if (const auto head = longest_head(a, false)) by_age[a] = most - *head;
    Reach reach(reading_, graph_, grids_, main_, anchor_);
    for (std::size_t a = 0; a < problem_.activities.size(); ++a) {
      const Activity& one = problem_.activities[a];
      if (one.fixed || !main_[a] || !contended(a)) continue;
      if (!by_age[a]) return false;  // no age says how early it may be
      if (*by_age[a] + one.duration <= period) continue;
      if (reach.earliest(a, by_age).value_or(period) + one.duration > period) return false;
    }
    return true;
  }

  // The largest age that a placement better than the best, or within the limits, could have.
  Ticks largest_possible() const {
    Ticks largest = 0;
    for (std::size_t c = 0; c < problem_.chains.size(); ++c)
      largest = std::max(largest, found_.best ? best_worst_ - beyond(c) : std::min(limit_of(c), Ticks{1} << 40));
    return largest;
  }

  const Reading& reading_;
  const Problem& problem_;
  Limits limits_;
  bool any_;
  std::int64_t most_steps_;
  Graph graph_;
  std::vector<Ticks> at_;
  std::vector<bool> placed_, main_;
  std::vector<Grid> grids_;
  std::vector<std::vector<std::pair<std::size_t, Ticks>>> standing_;  // by resource: activity, beginning
  std::vector<std::vector<Ticks>> heads_;                             // by chain: from the sensor to each activity
  std::vector<Ticks> least_;
  Ticks least_worst_ = 0;
  std::vector<std::size_t> trail_;
  std::size_t anchor_ = 0;
  bool one_anchor_ = true, all_positions_ = true, dropped_ = false, ok_ = true, cut_ = false;
  std::int64_t until_ = 0;  // steps of the position that is tried
  Ticks best_worst_ = 0, best_sum_ = 0;
  Search found_;
};

}  // namespace

Search place(const Reading& reading, const Limits& limits, bool any, std::int64_t most_steps) {
  return Engine(reading, limits, any, most_steps).run();
}

}  // namespace ttf::schedules::synthesis::instants
