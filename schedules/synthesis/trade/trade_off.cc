#include "schedules/synthesis/trade/trade_off.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "schedules/check/checker.h"
#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/instants/written.h"

namespace ttf::schedules::synthesis::trade {

using instants::age_bounds;
using instants::candidates;
using instants::last_slot_of;
using instants::least_slots;
using instants::least_worst_age;
using instants::Limits;
using instants::place;
using instants::Placed;
using instants::Read;
using instants::read_of;
using instants::Search;
using instants::with_instants;
using plan::Plan;
namespace {

constexpr Ticks kUnlimited = std::numeric_limits<Ticks>::max();

// A candidate, and the worst age that it cannot fall below with the slots that are allowed now.
struct Traded {
  Candidate candidate;
  Read read;
  Ticks least = 0;
};

Limits limits_of(const Traded& traded, Ticks worst, Ticks slots) {
  Limits limits;
  if (worst != kUnlimited) limits.worst_age = worst;
  if (slots != kUnlimited) limits.last_slot = slots * traded.read.timed.cluster.flexray.gdStaticSlot;
  return limits;
}

class Trader {
 public:
  Trader(const Plan& plan, const Judge& judge, std::int64_t most_steps)
      : plan_(plan), judge_(judge), most_steps_(most_steps) {}

  TradeOff run() {
    const std::vector<Candidate> all = candidates(plan_);
    searches_ = kSearchesInAStep * static_cast<std::int64_t>(all.size());
    for (const Candidate& candidate : all) add(candidate);
    made_.without = all.size() - made_.candidates.size();
    front();
    return std::move(made_);
  }

 private:
  // Each search has a share of the steps that are left, so that the front has some, and ends at last.
  Search ask(const Traded& traded, Ticks worst, Ticks slots, bool any = false) {
    const std::int64_t share = std::clamp((most_steps_ - made_.steps) / searches_, kLeastShare, instants::kMostSteps);
    Search found = place(traded.read.reading, limits_of(traded, worst, slots), any, share);
    made_.steps += found.steps;
    return found;
  }

  void add(const Candidate& candidate) {
    auto read = read_of(plan_, candidate);
    if (!read) return;
    Traded traded{candidate, std::move(*read), 0};
    traded.least = least_worst_age(traded.read.reading.problem, {});
    Search found = ask(traded, kUnlimited, kUnlimited);
    if (!found.best) {
      if (!found.exact) traded_.push_back(std::move(traded));
      return;
    }
    const Ticks worst = found.best->worst_age({});
    if (found.exact) traded.least = worst;
    const bool fewest = use_fewest(traded, worst, *found.best);
    if (auto made = point(traded, *found.best, traded.least, fewest)) made_.candidates.push_back(std::move(*made));
    traded_.push_back(std::move(traded));
  }

  // Brings the placement to the fewest slots that allow its worst age. Returns whether fewer are proven impossible.
  bool use_fewest(const Traded& traded, Ticks worst, Placed& placed) {
    bool proven = true;
    Ticks low = least_slots(traded.read), high = last_slot_of(traded.read, placed.solution);
    while (low < high) {
      const Ticks middle = low + (high - low) / 2;
      Search found = ask(traded, worst, middle, true);
      if (found.best) {
        placed = std::move(*found.best);
        high = last_slot_of(traded.read, placed.solution);
      } else {
        proven = proven && found.exact;
        low = middle + 1;
      }
    }
    return proven;
  }

  // Returns the placement as a point; none if the check refuses it.
  std::optional<TradeOffPoint> point(const Traded& traded, const Placed& placed, Ticks bound, bool fewest) const {
    const model::Cluster cluster = with_instants(plan_, traded.read.timed, traded.read.reading, placed.solution);
    if (!check::check(cluster).empty()) return std::nullopt;
    TradeOffPoint made;
    made.candidate = traded.candidate;
    for (const plan::PlannedChain& chain : plan_.chains)
      made.worst_age = std::max(made.worst_age, age_bounds(cluster, chain).worst);
    const Ticks off = placed.worst_age({}) - bound;
    made.bound = {made.worst_age.ns - off * cluster.flexray.gdMacrotick_ps / 1'000};
    made.slots = static_cast<int>(last_slot_of(traded.read, placed.solution));
    made.fewest = fewest;
    made.static_slots = cluster.flexray.gNumberOfStaticSlots;
    if (judge_) made.judged = judge_(cluster);
    return made;
  }

  // The best over all candidates with so many slots at most.
  struct Best {
    std::size_t traded = 0;
    Placed placed;
    Ticks worst = kUnlimited, bound = kUnlimited;
  };
  std::optional<Best> best_within(Ticks slots, const std::set<std::size_t>& refused) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < traded_.size(); ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return traded_[a].least < traded_[b].least; });
    Best best;
    for (const std::size_t i : order) {
      Traded& traded = traded_[i];
      if (refused.contains(i)) best.bound = std::min(best.bound, traded.least);
      if (refused.contains(i) || traded.least >= best.worst) continue;
      if (made_.steps >= most_steps_) {
        made_.complete = false;
        best.bound = std::min(best.bound, traded.least);
        continue;
      }
      Search found = ask(traded, best.worst == kUnlimited ? kUnlimited : best.worst - 1, slots);
      const Ticks reached = found.best ? found.best->worst_age({}) : best.worst;
      if (found.exact)
        traded.least = reached;
      else
        best.bound = std::min(best.bound, traded.least);
      if (found.best) best = {i, std::move(*found.best), reached, best.bound};
    }
    if (best.worst == kUnlimited) return std::nullopt;
    best.bound = std::min(best.bound, best.worst);
    return best;
  }

  // Each step forbids the last slot of the one before it.
  void front() {
    Ticks slots = kUnlimited;
    std::set<std::size_t> refused;  // with so many slots
    while (auto best = best_within(slots, refused)) {
      const bool fewest = use_fewest(traded_[best->traded], best->worst, best->placed);
      const auto made = point(traded_[best->traded], best->placed, best->bound, fewest);
      if (!made) {
        refused.insert(best->traded);
        continue;
      }
      // Another candidate reaches the same age with fewer slots.
      if (!made_.front.empty() && made_.front.back().worst_age >= made->worst_age) made_.front.pop_back();
      made_.front.push_back(*made);
      slots = made->slots - 1;
      refused.clear();
    }
  }

  static constexpr std::int64_t kSearchesInAStep = 4;  // for each candidate
  static constexpr std::int64_t kLeastShare = 1'000;

  const Plan& plan_;
  const Judge& judge_;
  std::int64_t most_steps_, searches_ = 1;
  std::vector<Traded> traded_;
  TradeOff made_;
};

}  // namespace

TradeOff trade_off(const Plan& plan, const Judge& judge, std::int64_t most_steps) {
  return Trader(plan, judge, most_steps).run();
}

}  // namespace ttf::schedules::synthesis::trade
