#include "schedules/synthesis/instants/objectives/optimiser.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/check.h"
#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/instants/judging/judged.h"

namespace ttf::schedules::synthesis::instants::objectives {

using plan::Goal;
namespace {

constexpr Ticks kNoAge = std::numeric_limits<Ticks>::max();

// Returns by chain how much longer its output is in force: until its end's next one.
std::vector<Ticks> in_force(const Problem& problem) {
  std::vector<Ticks> periods;
  for (const Chain& chain : problem.chains) periods.push_back(problem.activities[chain.activities.back()].period);
  return periods;
}

// Makes the best worst age a limit of each chain.
void hold(Limits& limits, Ticks best, std::size_t chains) {
  limits.largest_ages.resize(chains, kNoAge);
  for (std::size_t c = 0; c < chains; ++c)
    limits.largest_ages[c] = std::min(limits.largest_ages[c], best - (limits.beyond.empty() ? 0 : limits.beyond[c]));
  limits.beyond.clear();
  limits.worst_age.reset();
}

}  // namespace

Optimiser::Optimiser(const plan::Plan& plan, const std::vector<Candidate>& all, const std::set<std::size_t>& refused,
                     const Judges& judges)
    : plan_(plan), judges_(judges) {
  for (std::size_t i = 0; i < all.size(); ++i) trials_.push_back({all[i], {}, std::nullopt, refused.contains(i), {}});
}

std::optional<std::size_t> Optimiser::run() {
  for (const Goal goal : plan_.objective) {
    way_ = "bound";
    if (goal == Goal::kWorstAge || goal == Goal::kDataAge) worst_age(goal);
    if (goal == Goal::kSlots) slots();
    if (goal == Goal::kJitter) jitter();
    if (goal == Goal::kRoom) room();
    if (goal == Goal::kError || goal == Goal::kGapError) judge(goal);
    if (std::all_of(trials_.begin(), trials_.end(), [](const Trial& trial) { return trial.out; })) return std::nullopt;
  }
  return least_sum();
}

void Optimiser::worst_age(Goal goal) {
  Ticks best = kNoAge, least_of_all = kNoAge;
  std::vector<Open> open;
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    Trial& trial = trials_[i];
    if (trial.out) continue;
    const auto read = read_of(plan_, trial);
    std::vector<Ticks> beyond;
    if (read && goal == Goal::kDataAge) beyond = in_force(read->reading.problem);
    const Ticks least = read ? least_worst_age(read->reading.problem, beyond) : kNoAge;
    trial.out = !read || least > best;
    if (trial.out) continue;
    trial.limits.beyond = std::move(beyond);
    if (best != kNoAge) trial.limits.worst_age = best;
    const Search found = place(read->reading, trial.limits);
    if (found.steps > 0) least_of_all = std::min(least_of_all, least);
    if (found.best || (found.exact && trial.pins.empty()))
      trial.placed = found.best;  // else an earlier objective's placement keeps the limits
    if (!found.exact) open.push_back({i, least, !trial.placed});
    trial.out = !trial.placed;
    if (trial.placed) best = std::min(best, trial.placed->worst_age(trial.limits.beyond));
  }
  const Ticks settled = settle_open(open, best);
  const Ticks bound = std::min(best, settled);
  if (best > least_of_all) way_ = "all orders tried";
  for (Trial& trial : trials_) {
    if (trial.out) continue;
    trial.out = trial.placed->worst_age(trial.limits.beyond) > best;
    hold(trial.limits, best, trial.placed->ages.size());
  }
  note(goal, static_cast<double>(best), static_cast<double>(bound));
  for (const Open& one : open)
    if (trials_[one.trial].out && one.least <= best) doubtful_.insert(one.trial);
}

Ticks Optimiser::settle_open(std::vector<Open>& open, Ticks& best) {
  std::stable_sort(open.begin(), open.end(), [](const Open& a, const Open& b) { return a.least < b.least; });
  Ticks bound = kNoAge;
  bool stays_open = false;
  for (Open& one : open) {
    const Ticks most = one.nothing || best == kNoAge ? best : best - 1;
    if (one.least > most) continue;
    Trial& trial = trials_[one.trial];
    Search found;
    if (!stays_open) {
      Limits limits = trial.limits;
      if (most != kNoAge) limits.worst_age = most;
      found = place(read_of(plan_, trial)->reading, limits);
    }
    if (found.best) {
      trial.placed = found.best;
      trial.out = false;
      best = std::min(best, found.best->worst_age(trial.limits.beyond));
    }
    stays_open = stays_open || !found.exact;
    exact_ = exact_ && (!one.nothing || found.exact || found.best);
    if (found.exact) one.least = found.best ? best : most == kNoAge ? kNoAge : most + 1;
    if (!found.exact || found.best) bound = std::min(bound, one.least);
  }
  return bound;
}

void Optimiser::place_all() {
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    Trial& trial = trials_[i];
    if (trial.out || trial.placed) continue;
    const auto read = read_of(plan_, trial);
    if (read) {
      const Search found = place(read->reading, trial.limits);
      exact_ = exact_ && (found.exact || found.best);
      if (!found.exact && !found.best) doubtful_.insert(i);
      trial.placed = found.best;
    }
    trial.out = !trial.placed;
  }
}

void Optimiser::jitter() {
  place_all();
  Ticks best = kNoAge;
  for (const Trial& trial : trials_)
    if (!trial.out) best = std::min(best, trial.placed->jitter());
  note(Goal::kJitter, static_cast<double>(best), 0);
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    if (trials_[i].out) continue;
    trials_[i].limits.jitter = best;
    trials_[i].out = trials_[i].placed->jitter() > best;
    if (trials_[i].out) doubtful_.insert(i);
  }
}

void Optimiser::room() {
  place_all();
  double best = 0;
  std::vector<double> shares(trials_.size());
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    if (trials_[i].out) continue;
    shares[i] = free_share(*read_of(plan_, trials_[i]));
    best = std::max(best, shares[i]);
  }
  for (std::size_t i = 0; i < trials_.size(); ++i) trials_[i].out = trials_[i].out || shares[i] < best - 1e-12;
  way_ = "all choices tried";
  note(Goal::kRoom, best, exact_ ? best : 1.0);
}

std::optional<std::size_t> Optimiser::least_sum() {
  std::optional<std::size_t> chosen;
  Ticks best = kNoAge;
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    Trial& trial = trials_[i];
    if (trial.out) continue;
    const auto read = read_of(plan_, trial);
    if (!read) continue;
    Limits limits = trial.limits;
    if (best != kNoAge) limits.sum_of_ages = best;
    if (const Search found = place(read->reading, limits); found.best) trial.placed = found.best;
    if (!trial.placed || trial.placed->sum_of_ages() >= best) continue;
    best = trial.placed->sum_of_ages();
    chosen = i;
  }
  return chosen;
}

void Optimiser::judge(Goal goal) {
  const auto found = judges_.find(goal);
  TTF_CHECK(found != judges_.end(), "nobody judges {}", name_of(goal));
  const bool bounded = doubtful_.empty();
  for (std::size_t i = 0; i < trials_.size() && !judged_; ++i) {
    if (trials_[i].out && !doubtful_.contains(i)) continue;
    possible_.push_back(trials_[i]);
    possible_.back().out = false;
  }
  for (std::size_t i = 0; i < trials_.size(); ++i)
    if (!trials_[i].out) doubtful_.insert(i);
  judged_ = true;
  judging::Judged judged = judging::least_judged(plan_, *found->second, trials_);
  exact_ = exact_ && judged.exact;
  // Behind another judge measurements and uses stand already, and trials may have been dropped without a proof. Other instants
  // might be as good, so the bound is that of all trials before the first judge.
  if (!bounded) {
    judged.bound = judging::least_bound(plan_, *found->second, possible_, judged.weights, judged.value);
    way_ = "bound";
  }
  note(goal, judged.value, judged.bound);
  reached_.back().weights = std::move(judged.weights);
  reached_.back().supposes = found->second->supposes();
  reached_.back().proven = reached_.back().proven && reached_.back().supposes.empty();
}

double Optimiser::bound_of_doubtful(Goal goal) const {
  double best = goal == Goal::kRoom ? 0.0 : std::numeric_limits<double>::infinity();
  for (const std::size_t i : doubtful_) {
    const auto read = read_of(plan_, trials_[i].candidate);
    if (!read) continue;
    const Problem& problem = read->reading.problem;
    if (goal == Goal::kRoom) best = std::max(best, free_share(*read));
    if (goal == Goal::kJitter) best = 0.0;
    if (goal == Goal::kSlots) best = std::min(best, static_cast<double>(least_slots(*read)));
    if (goal == Goal::kWorstAge) best = std::min(best, static_cast<double>(least_worst_age(problem, {})));
    if (goal == Goal::kDataAge) best = std::min(best, static_cast<double>(least_worst_age(problem, in_force(problem))));
  }
  return best;
}

void Optimiser::note(Goal goal, double value, double bound) {
  if (!judges_.contains(goal) && !doubtful_.empty()) {
    const double others = bound_of_doubtful(goal);
    bound = goal == Goal::kRoom ? std::max(bound, others) : std::min(bound, others);
    if (judged_) way_ = "bound";
  }
  reached_.push_back({goal, value, bound, value == bound, way_, {}, {}});
}

}  // namespace ttf::schedules::synthesis::instants::objectives
