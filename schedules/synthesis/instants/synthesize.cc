#include "schedules/synthesis/instants/synthesize.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "schedules/check/checker.h"
#include "schedules/model/limits.h"
#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/instants/measured.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/proof.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/plan/loader.h"

namespace ttf::schedules::synthesis::instants {

using plan::Goal;
using plan::in_the_files;
using plan::Plan;
using plan::PlannedChain;
using plan::PlannedList;
namespace {

constexpr Ticks kNone = std::numeric_limits<Ticks>::max();

// A candidate, and how well its instants meet the objectives so far.
struct Trial {
  Candidate candidate;
  Limits limits;
  std::optional<Placed> placed;
  bool out = false;
};

// Returns by chain how much longer its output is in force: until its end's next one.
std::vector<Ticks> in_force(const Problem& problem) {
  std::vector<Ticks> periods;
  for (const Chain& chain : problem.chains) periods.push_back(problem.activities[chain.activities.back()].period);
  return periods;
}

// A candidate whose search was cut: no worst age below `least` is possible there.
struct Open {
  std::size_t trial = 0;
  Ticks least = 0;
  bool nothing = false;  // the search found no placement
};

class Optimiser {
 public:
  Optimiser(const Plan& plan, const std::vector<Candidate>& all, const std::set<std::size_t>& refused,
            solver::Prover* prover)
      : plan_(plan), prover_(prover) {
    for (std::size_t i = 0; i < all.size(); ++i) trials_.push_back({all[i], {}, std::nullopt, refused.contains(i)});
  }

  // Returns the index of the best candidate; none if no candidate has a placement.
  std::optional<std::size_t> run() {
    for (const Goal goal : plan_.objective) {
      asks_left_ = kMostAsks;
      way_ = "bound";
      if (goal == Goal::kWorstAge || goal == Goal::kDataAge) worst_age(goal);
      if (goal == Goal::kSlots) slots();
      if (goal == Goal::kJitter) jitter();
      if (goal == Goal::kRoom) room();
      if (std::all_of(trials_.begin(), trials_.end(), [](const Trial& trial) { return trial.out; }))
        return std::nullopt;
    }
    return least_sum();
  }

  const Trial& trial(std::size_t index) const { return trials_[index]; }
  const std::vector<Reached>& reached() const { return reached_; }
  // Whether every candidate without a placement has none.
  bool exact() const { return exact_; }

 private:
  void worst_age(Goal goal) {
    Ticks best = kNone, least_of_all = kNone;
    std::vector<Open> open;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      Trial& trial = trials_[i];
      if (trial.out) continue;
      const auto read = read_of(plan_, trial.candidate);
      std::vector<Ticks> beyond;
      if (read && goal == Goal::kDataAge) beyond = in_force(read->reading.problem);
      const Ticks least = read ? least_worst_age(read->reading.problem, beyond) : kNone;
      trial.out = !read || least > best;
      if (trial.out) continue;
      trial.limits.beyond = std::move(beyond);
      if (best != kNone) trial.limits.worst_age = best;
      const Search found = place(read->reading, trial.limits);
      if (found.steps > 0) least_of_all = std::min(least_of_all, least);
      if (found.best || found.exact)
        trial.placed = found.best;  // else an earlier objective's placement keeps the limits
      if (!found.exact) open.push_back({i, least, !trial.placed});
      trial.out = !trial.placed;
      if (trial.placed) best = std::min(best, trial.placed->worst_age(trial.limits.beyond));
    }
    if (best > least_of_all) way_ = "all orders tried";
    const Ticks settled = settle_open(std::move(open), best);
    const Ticks bound = std::min(best, settled);
    for (Trial& trial : trials_) {
      if (trial.out) continue;
      trial.out = trial.placed->worst_age(trial.limits.beyond) > best;
      hold(trial.limits, best, trial.placed->ages.size());
    }
    note(goal, static_cast<double>(best), static_cast<double>(bound));
  }

  // Asks the solver about candidates whose search was cut, those with the least bounds first, until one stays open. Returns a bound
  // for all of them.
  Ticks settle_open(std::vector<Open> open, Ticks& best) {
    std::stable_sort(open.begin(), open.end(), [](const Open& a, const Open& b) { return a.least < b.least; });
    Ticks bound = kNone;
    for (const Open& one : open) {
      const Ticks most = one.nothing || best == kNone ? best : best - 1;
      if (one.least > most) continue;
      Trial& trial = trials_[one.trial];
      Limits limits = trial.limits;
      if (most != kNone) limits.worst_age = most;
      const Settled settled = ask(read_of(plan_, trial.candidate)->reading, limits, false);
      if (settled.best) {
        trial.placed = settled.best;
        trial.out = false;
        best = std::min(best, settled.best->worst_age(trial.limits.beyond));
      }
      exact_ = exact_ && (!one.nothing || settled.none || settled.best);
      if (!settled.none) bound = std::min(bound, std::max(one.least, settled.bound));
    }
    return bound;
  }

  // Asks nothing more behind a question that stayed open: the answers would prove nothing.
  Settled ask(const Reading& reading, const Limits& limits, bool any) {
    if (asks_left_ <= 0) return {};
    Settled settled = settle(reading, limits, prover_, any);
    asks_left_ = settled.open ? 0 : asks_left_ - 1;
    if (settled.way == "integers" || (settled.way == "exhausted" && way_ != "integers")) way_ = settled.way;
    return settled;
  }

  // Makes the best worst age a limit of each chain.
  static void hold(Limits& limits, Ticks best, std::size_t chains) {
    limits.largest_ages.resize(chains, kNone);
    for (std::size_t c = 0; c < chains; ++c)
      limits.largest_ages[c] = std::min(limits.largest_ages[c], best - (limits.beyond.empty() ? 0 : limits.beyond[c]));
    limits.beyond.clear();
    limits.worst_age.reset();
  }

  void slots() {
    Ticks best = kNone, bound = kNone, least = kNone;
    std::map<std::size_t, Ticks> by_trial;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      Trial& trial = trials_[i];
      if (trial.out) continue;
      const auto read = read_of(plan_, trial.candidate);
      trial.out = !read;
      if (trial.out) continue;
      least = std::min(least, least_slots(*read));
      const auto [few, proven_few] = fewest(*read, trial);
      if (!proven_few) bound = std::min(bound, least_slots(*read));
      trial.out = !few;
      if (!few) continue;
      by_trial[i] = *few;
      best = std::min(best, *few);
    }
    for (const auto& [i, few] : by_trial) trials_[i].out = few > best;
    if (best > least && way_ == "bound") way_ = "all orders tried";
    bound = std::min(bound, best);
    note(Goal::kSlots, static_cast<double>(best), static_cast<double>(bound));
  }

  // Returns the least last slot within the trial's limits, and whether it is proven to be the least. Keeps its placement.
  std::pair<std::optional<Ticks>, bool> fewest(const Read& read, Trial& trial) {
    bool proven = true;
    if (!trial.placed) {
      const Search found = any_within(read.reading, trial.limits);
      exact_ = exact_ && (found.exact || found.best);
      if (!found.best) return {std::nullopt, found.exact};
      trial.placed = found.best;
    }
    const Ticks slot = read.timed.cluster.flexray.gdStaticSlot;
    Ticks low = least_slots(read), high = last_slot_of(read, trial.placed->solution);
    while (low < high) {
      Limits limits = trial.limits;
      const Ticks middle = low + (high - low) / 2;
      limits.last_slot = middle * slot;
      const Search found = any_within(read.reading, limits);
      if (!found.best) {
        proven = proven && found.exact;
        low = middle + 1;
        continue;
      }
      trial.placed = found.best;
      high = std::min(middle, last_slot_of(read, found.best->solution));
    }
    trial.limits.last_slot = high * slot;
    return {high, proven};
  }

  // Returns a placement within the limits, by the search or the solver; or whether there is none.
  Search any_within(const Reading& reading, const Limits& limits) {
    Search found = place(reading, limits, true);
    if (found.best || found.exact) return found;
    Settled settled = ask(reading, limits, true);
    found.best = std::move(settled.best);
    found.exact = settled.none;
    return found;
  }

  // Sees to it that every trial has a placement, and drops those without one.
  void place_all() {
    for (Trial& trial : trials_) {
      if (trial.out || trial.placed) continue;
      const auto read = read_of(plan_, trial.candidate);
      if (read) {
        const Search found = place(read->reading, trial.limits);
        exact_ = exact_ && (found.exact || found.best);
        trial.placed = found.best;
      }
      trial.out = !trial.placed;
    }
  }

  void jitter() {
    place_all();
    Ticks best = kNone;
    const auto of = [](const Trial& trial) {
      Ticks most = 0;
      for (std::size_t c = 0; c < trial.placed->ages.size(); ++c)
        most = std::max(most, trial.placed->ages[c] - trial.placed->least[c]);
      return most;
    };
    for (const Trial& trial : trials_)
      if (!trial.out) best = std::min(best, of(trial));
    for (Trial& trial : trials_) trial.out = trial.out || of(trial) > best;
    note(Goal::kJitter, static_cast<double>(best), 0);
  }

  void room() {
    place_all();
    double best = 0;
    std::vector<double> shares(trials_.size());
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      if (trials_[i].out) continue;
      shares[i] = free_share(*read_of(plan_, trials_[i].candidate));
      best = std::max(best, shares[i]);
    }
    for (std::size_t i = 0; i < trials_.size(); ++i) trials_[i].out = trials_[i].out || shares[i] < best - 1e-12;
    way_ = "all choices tried";
    note(Goal::kRoom, best, exact_ ? best : 1.0);
  }

  std::optional<std::size_t> least_sum() {
    std::optional<std::size_t> chosen;
    Ticks best = kNone;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      Trial& trial = trials_[i];
      if (trial.out) continue;
      const auto read = read_of(plan_, trial.candidate);
      if (!read) continue;
      Limits limits = trial.limits;
      if (best != kNone) limits.sum_of_ages = best;
      if (const Search found = place(read->reading, limits); found.best) trial.placed = found.best;
      if (!trial.placed || trial.placed->sum_of_ages() >= best) continue;
      best = trial.placed->sum_of_ages();
      chosen = i;
    }
    return chosen;
  }

  void note(Goal goal, double value, double bound) { reached_.push_back({goal, value, bound, value == bound, way_}); }

  static constexpr int kMostAsks = 16;  // by objective

  const Plan& plan_;
  solver::Prover* prover_;
  int asks_left_ = 0;
  std::string way_;  // to the proof of this objective
  std::vector<Trial> trials_;
  std::vector<Reached> reached_;
  bool exact_ = true;
};

// Throws what is wrong at any instants: every list stands in slots of its own for this.
void refuse_contradictions(const Plan& plan, const Timed& timed) {
  model::Cluster cluster = timed.cluster;
  cluster.parameter_lines = plan.unchanging->parameter_lines;
  check::ClusterFindings findings(cluster);
  check_cycle(cluster, findings);
  int slot = 1;
  for (const model::FrameSlot& frame : cluster.frames) slot = std::max(slot, frame.slot + 1);
  for (const PlannedList& list : plan.lists)
    if (!list.at.instant) slot = std::max(slot, list.slot + cluster.pdu(list.pdu).max_fragments());
  for (const PlannedList& list : plan.lists)
    for (int f = 0; f < cluster.pdu(list.pdu).max_fragments(); ++f)
      cluster.frames.push_back({list.at.instant ? slot++ : list.slot + f, list.channels, 0,
                                list.at.instant ? 1 : list.repetition, list.sender, list.pdu, f, list.line});
  std::stable_sort(cluster.frames.begin(), cluster.frames.end(),
                   [](const auto& a, const auto& b) { return a.slot < b.slot; });
  cluster.flexray.gNumberOfStaticSlots = std::max(cluster.flexray.gNumberOfStaticSlots, slot);
  check_slots(cluster, findings);
  check_clocks(cluster, findings);
  check_can(cluster, findings);
  check_flow(cluster, findings);
  std::vector<Finding> found = in_the_files(plan, findings.take());
  if (!found.empty()) throw InputError(std::move(found));
}

std::vector<Candidate> checked_candidates(const Plan& plan) {
  std::vector<Candidate> all = candidates(plan);
  if (all.size() > kMostCandidates)
    throw InputError(
        {plan.cluster.file, plan.cycle.line, "plan", "",
         "must allow at most 20000 choices of cycle and rates: a larger step or narrower rates make fewer"});
  for (const Candidate& candidate : all)
    if (const auto made = timed(plan, candidate)) {
      refuse_contradictions(plan, *made);
      break;
    }
  return all;
}

}  // namespace

const char* name_of(Goal goal) {
  switch (goal) {
    case Goal::kWorstAge: return "worst_age";
    case Goal::kDataAge: return "data_age";
    case Goal::kSlots: return "slots";
    case Goal::kJitter: return "jitter";
    case Goal::kRoom: return "room";
  }
  return "";
}

Synthesis synthesize(const Plan& plan, solver::Prover* prover) {
  constexpr std::size_t kMostRefusals = 16;
  const std::vector<Candidate> all = checked_candidates(plan);
  Synthesis made;
  made.candidates = all.size();
  std::set<std::size_t> refused;
  std::vector<Reached> of_all;  // with every candidate
  while (refused.size() < kMostRefusals) {
    Optimiser optimiser(plan, all, refused, prover);
    const auto chosen = optimiser.run();
    made.exact = optimiser.exact();
    if (refused.empty()) of_all = optimiser.reached();
    if (!chosen) return made;
    const Trial& trial = optimiser.trial(*chosen);
    const auto read = read_of(plan, trial.candidate);
    made.cluster = with_instants(plan, read->timed, read->reading, trial.placed->solution);
    std::vector<Finding> findings = check::check(made.cluster);
    if (findings.empty()) {
      made.ages.clear();
      const Measured measured = measure(plan, *trial.placed, made);
      findings = too_old(plan, made);
      made.found = findings.empty();
      made.candidate = trial.candidate;
      made.reached = in_units(bounded_by(optimiser.reached(), of_all), measured, made.cluster);
      if (made.found) return made;
    }
    if (made.refused.empty()) made.refused = std::move(findings);
    refused.insert(*chosen);
  }
  return made;
}

Feasible feasible(const Plan& plan) {
  Feasible result{false, true};
  for (const Candidate& candidate : candidates(plan)) {
    const auto read = read_of(plan, candidate);
    if (!read) continue;
    const Search found = place(read->reading, {}, true);
    if (found.best) return {true, true};
    result.exact = result.exact && found.exact;
  }
  return result;
}

}  // namespace ttf::schedules::synthesis::instants
