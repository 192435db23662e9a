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

struct Read {
  Timed timed;
  Reading reading;
};

std::optional<Read> read_of(const Plan& plan, const Candidate& candidate) {
  auto made = timed(plan, candidate);
  if (!made) return std::nullopt;
  Reading read = reading(plan, *made);
  return Read{std::move(*made), std::move(read)};
}

// Returns by chain how much longer its output is in force: until its end's next one.
std::vector<Ticks> in_force(const Problem& problem) {
  std::vector<Ticks> periods;
  for (const Chain& chain : problem.chains) periods.push_back(problem.activities[chain.activities.back()].period);
  return periods;
}

Ticks slots_end(const Read& read, const Solution& solution) {
  Ticks end = 0;
  const Problem& problem = read.reading.problem;
  for (std::size_t a = 0; a < problem.activities.size(); ++a)
    if (problem.activities[a].resource == std::size_t{0})
      end = std::max(end,
                     solution.offsets[a] % read.timed.cluster.flexray.gMacroPerCycle + problem.activities[a].duration);
  return end;
}

// Returns the share of a round's static frames that are free.
double free_share(const Read& read) {
  double used = 0;
  const model::GlobalParameters& g = read.timed.cluster.flexray;
  for (const Activity& activity : read.reading.problem.activities)
    if (activity.resource == std::size_t{0})
      used += static_cast<double>(activity.duration) / g.gdStaticSlot * g.gMacroPerCycle /
              static_cast<double>(activity.period);
  return 1.0 - used / g.gNumberOfStaticSlots;
}

class Optimiser {
 public:
  Optimiser(const Plan& plan, const std::vector<Candidate>& all, const std::set<std::size_t>& refused) : plan_(plan) {
    for (std::size_t i = 0; i < all.size(); ++i) trials_.push_back({all[i], {}, std::nullopt, refused.contains(i)});
  }

  // Returns the index of the best candidate; none if no candidate has a placement.
  std::optional<std::size_t> run() {
    for (const Goal goal : plan_.objective) {
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
    Ticks best = kNone, bound = kNone;
    for (Trial& trial : trials_) {
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
      exact_ = exact_ && (found.exact || found.best);
      if (!found.exact) bound = std::min(bound, least);
      trial.placed = found.best;
      trial.out = !found.best;
      if (found.best) best = std::min(best, found.best->worst_age(trial.limits.beyond));
    }
    for (Trial& trial : trials_) {
      if (trial.out) continue;
      trial.out = trial.placed->worst_age(trial.limits.beyond) > best;
      hold(trial.limits, best, trial.placed->ages.size());
    }
    bound = std::min(bound, best);
    note(goal, static_cast<double>(best), static_cast<double>(bound));
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
    Ticks best = kNone, bound = kNone;
    std::map<std::size_t, Ticks> by_trial;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      Trial& trial = trials_[i];
      if (trial.out) continue;
      const auto read = read_of(plan_, trial.candidate);
      trial.out = !read;
      if (trial.out) continue;
      const Ticks slot = read->timed.cluster.flexray.gdStaticSlot;
      const auto [few, proven_few] = fewest(*read, trial, slot);
      if (!proven_few) bound = std::min(bound, least_slots(*read, slot));
      trial.out = !few;
      if (!few) continue;
      by_trial[i] = *few;
      best = std::min(best, *few);
    }
    for (const auto& [i, few] : by_trial) trials_[i].out = few > best;
    bound = std::min(bound, best);
    note(Goal::kSlots, static_cast<double>(best), static_cast<double>(bound));
  }

  // Returns the least last slot within the trial's limits, and whether it is proven to be the least. Keeps its placement.
  std::pair<std::optional<Ticks>, bool> fewest(const Read& read, Trial& trial, Ticks slot) {
    bool proven = true;
    if (!trial.placed) {
      const Search found = place(read.reading, trial.limits, true);
      exact_ = exact_ && (found.exact || found.best);
      if (!found.best) return {std::nullopt, found.exact};
      trial.placed = found.best;
    }
    Ticks low = least_slots(read, slot), high = (slots_end(read, trial.placed->solution) + slot - 1) / slot;
    while (low < high) {
      Limits limits = trial.limits;
      const Ticks middle = low + (high - low) / 2;
      limits.last_slot = middle * slot;
      const Search found = place(read.reading, limits, true);
      if (!found.best) {
        proven = proven && found.exact;
        low = middle + 1;
        continue;
      }
      trial.placed = found.best;
      high = std::min(middle, (slots_end(read, found.best->solution) + slot - 1) / slot);
    }
    trial.limits.last_slot = high * slot;
    return {high, proven};
  }

  static Ticks least_slots(const Read& read, Ticks slot) {
    Ticks least = 0;
    double load = 0;
    const Ticks cycle = read.timed.cluster.flexray.gMacroPerCycle;
    for (const Activity& one : read.reading.problem.activities) {
      if (one.resource != std::size_t{0}) continue;
      least = std::max(least, (one.fixed.value_or(0) % cycle + one.duration) / slot);
      load += static_cast<double>(one.duration / slot) * static_cast<double>(cycle) / static_cast<double>(one.period);
    }
    return std::max(least, static_cast<Ticks>(load - 1e-9) + 1);
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

  void note(Goal goal, double value, double bound) { reached_.push_back({goal, value, bound, value == bound}); }

  const Plan& plan_;
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

Synthesis synthesize(const Plan& plan) {
  constexpr std::size_t kMostRefusals = 16;
  const std::vector<Candidate> all = checked_candidates(plan);
  Synthesis made;
  made.candidates = all.size();
  std::set<std::size_t> refused;
  while (refused.size() < kMostRefusals) {
    Optimiser optimiser(plan, all, refused);
    const auto chosen = optimiser.run();
    made.exact = optimiser.exact();
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
      made.reached = in_units(optimiser.reached(), measured, made.cluster);
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
