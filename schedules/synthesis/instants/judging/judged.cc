#include "schedules/synthesis/instants/judging/judged.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "schedules/synthesis/instants/judging/chain_ends.h"
#include "schedules/synthesis/instants/judging/moves.h"
#include "schedules/synthesis/instants/placement.h"

namespace ttf::schedules::synthesis::instants::judging {
namespace {

constexpr double kWithoutValue = std::numeric_limits<double>::infinity();

class JudgedSearch {
 public:
  JudgedSearch(const plan::Plan& plan, const Judge& judge, std::vector<Trial>& trials)
      : plan_(plan), judge_(judge), trials_(trials) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (trials[i].out) continue;
      auto read = read_of(plan, trials[i]);
      trials[i].out = !read;
      if (read)
        contenders_.push_back({i,
                               std::move(read->reading),
                               read->timed.cluster.flexray.gdMacrotick_ps,
                               {},
                               false,
                               false,
                               false,
                               0,
                               0,
                               0,
                               {}});
    }
  }

  Judged run() {
    Judged judged;
    const std::size_t parts = judge_.parts();
    judged.weights.assign(parts, 1.0);
    // The least value of each part is what the others are weighed against.
    for (std::size_t part = 0; part < parts && parts > 1; ++part) {
      std::vector<double> alone(parts, 0.0);
      alone[part] = 1.0;
      judged.weights[part] = 1.0 / least(alone);
    }
    judged.value = least(judged.weights);
    judged.bound = raised_bound(judged.weights, judged.value);
    judged.exact = exact_;
    keep(judged.value);
    return judged;
  }

  double bound_of_all(const std::vector<double>& weights, double value) {
    for (Contender& one : contenders_) {
      one.bound = bound(one, weights, value, kLeastEffort);
      one.effort = kLeastEffort;
    }
    return raised_bound(weights, value);
  }

 private:
  // A trial and its proposals.
  struct Contender {
    std::size_t trial = 0;
    Reading reading;
    std::int64_t tick_ps = 0;
    std::vector<Placed> proposals;
    bool searched = false, proposed = false, impossible = false;
    Ticks least_worst_age = 0;  // if it is proven
    // With the weights of the last search:
    double bound = 0;
    int effort = 0;
    struct {
      double value = kWithoutValue;
      std::size_t proposal = 0;
    } best;
  };

  double bound(const Contender& one, const std::vector<double>& weights, double enough, int effort) const {
    std::vector<Prospect> all = prospects(plan_, one.reading, trials_[one.trial].limits, one.tick_ps);
    // The search may have proven more than the bounds say.
    if (all.size() == 1)
      all.front().least_worst_age =
          std::max(all.front().least_worst_age, Duration{one.least_worst_age * one.tick_ps / 1'000});
    return judge_.bound(all, weights, enough, effort);
  }

  // Looks for the least value, and bounds each contender by little effort.
  double least(const std::vector<double>& weights) {
    double least = kWithoutValue;
    for (Contender& one : contenders_) {
      one.best = {};
      one.bound = bound(one, weights, least, kLeastEffort);
      one.effort = kLeastEffort;
      if (one.bound > least) continue;
      propose(one);
      if (one.impossible) one.bound = kWithoutValue;
      // Behind an infinite bound each placement is as good as any other.
      if (one.proposals.empty() || one.bound == kWithoutValue) continue;
      weigh(one, weights);
      least = std::min(least, one.best.value);
    }
    return least;
  }

  // Raises the least bound, that of one contender after the other, while there is effort left. Returns it.
  double raised_bound(const std::vector<double>& weights, double value) {
    for (std::int64_t left = kMostEffort;;) {
      const auto lowest = std::min_element(contenders_.begin(), contenders_.end(),
                                           [](const Contender& a, const Contender& b) { return a.bound < b.bound; });
      if (lowest == contenders_.end() || lowest->bound >= value) return value;
      if (!lowest->searched) {
        search(*lowest);
        lowest->bound = lowest->impossible ? kWithoutValue : bound(*lowest, weights, value, lowest->effort);
        continue;
      }
      left -= lowest->effort *= 2;
      if (left < 0) return lowest->bound;
      lowest->bound = std::max(lowest->bound, bound(*lowest, weights, value, lowest->effort));
    }
  }

  // Puts out the trials above the best value, and leaves the best placement in the others.
  void keep(double value) {
    for (Trial& trial : trials_) trial.placed.reset();
    for (Contender& one : contenders_)
      if (one.best.value <= value && !one.proposals.empty()) {
        trials_[one.trial].placed = std::move(one.proposals[one.best.proposal]);
        pin(one.reading.problem, trials_[one.trial]);
      }
    for (Trial& trial : trials_) trial.out = trial.out || !trial.placed;
  }

  // Proposes the least worst age.
  void search(Contender& one) {
    if (std::exchange(one.searched, true)) return;
    const Trial& trial = trials_[one.trial];
    if (trial.placed) one.proposals.push_back(*trial.placed);
    Search first = place(one.reading, trial.limits, false, kProposalSteps);
    if (!first.best && !first.exact) first = place(one.reading, trial.limits);
    if (first.best) one.proposals.push_back(*first.best);
    if (first.best && first.exact) one.least_worst_age = first.best->worst_age({});
    one.impossible = first.exact && one.proposals.empty();
    exact_ = exact_ && (one.impossible || !one.proposals.empty());
  }

  void propose(Contender& one) {
    if (std::exchange(one.proposed, true)) return;
    search(one);
    if (one.proposals.empty()) return;
    const Trial& trial = trials_[one.trial];
    const std::vector<Ticks> least = least_ages(one.reading.problem);
    const Ticks oldest = *std::max_element(least.begin(), least.end());
    Limits limits = trial.limits;
    for (const Ticks times : {2, 1}) {
      limits.beyond.clear();
      for (const Ticks age : least) limits.beyond.push_back(times * (oldest - age));
      add(one, limits);
    }
    for (std::size_t c = 0; c < least.size(); ++c) {
      Limits first_of_all = limits;
      first_of_all.beyond[c] += one.reading.problem.activities[one.reading.problem.chains[c].activities.front()].period;
      add(one, first_of_all);
    }
  }

  void add(Contender& one, const Limits& limits) {
    if (auto found = place(one.reading, limits, false, kProposalSteps).best) one.proposals.push_back(std::move(*found));
  }

  void weigh(Contender& one, const std::vector<double>& weights) {
    const auto value = [&](const std::vector<Ticks>& offsets) {
      return judge_.of(chain_ends(plan_, one.reading.problem, one.tick_ps, offsets), weights);
    };
    int moves = 0;
    const std::vector<Placed> starts = one.proposals;
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const double proposed = value(starts[p].solution.offsets);
      if (proposed < one.best.value) one.best = {proposed, p};
      if (std::any_of(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(p),
                      [&](const Placed& other) { return other.ages == starts[p].ages; }))
        continue;
      Placed better = moved_measurements(one.reading, trials_[one.trial].limits, starts[p], value, kMostMoves, moves);
      const double reached = value(better.solution.offsets);
      if (reached >= one.best.value) continue;
      one.proposals.push_back(std::move(better));
      one.best = {reached, one.proposals.size() - 1};
    }
  }

  const plan::Plan& plan_;
  const Judge& judge_;
  std::vector<Trial>& trials_;
  std::vector<Contender> contenders_;
  bool exact_ = true;
};

}  // namespace

Judged least_judged(const plan::Plan& plan, const Judge& judge, std::vector<Trial>& trials) {
  return JudgedSearch(plan, judge, trials).run();
}

double least_bound(const plan::Plan& plan, const Judge& judge, std::vector<Trial> trials,
                   const std::vector<double>& weights, double value) {
  return JudgedSearch(plan, judge, trials).bound_of_all(weights, value);
}

}  // namespace ttf::schedules::synthesis::instants::judging
