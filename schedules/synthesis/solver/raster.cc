#include "schedules/synthesis/solver/raster.h"

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "core/random.h"
#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::solver {
namespace {

class Raster {
 public:
  Raster(const Tightened& tightened, const Objective& objective, const Effort& effort, Decider& decider, Solution& best)
      : tightened_(tightened), objective_(objective), decider_(decider), best_(best), left_(effort.exhaustion),
        seeds_(effort.seeds) {
    const Model model(tightened.question());
    for (std::size_t at = 0; at < tightened.problem.activities.size(); ++at) {
      const bool named = objective.moving.empty() || std::ranges::count(objective.moving, at) > 0;
      if (named && !tightened.problem.activities[at].fixed) add(model, at);
    }
    value_ = objective.function(best.offsets);
  }

  Reached all() {
    std::vector<std::size_t> at(moving_.size(), 0);
    Solution trial = best_;
    for (;;) {
      for (std::size_t digit = 0; digit < at.size(); ++digit)
        trial.offsets[moving_[digit]] = choices_[digit][at[digit]];
      take_if_better(trial);
      std::size_t digit = 0;
      while (digit < at.size() && ++at[digit] == choices_[digit].size()) at[digit++] = 0;
      if (digit == at.size()) break;
    }
    return {value_, sure_ ? value_ : -std::numeric_limits<double>::infinity(), sure_,
            sure_ ? "all of the raster tried" : "not proven"};
  }

  // Moves one activity after another to where the value is least, from the offsets at hand and from drawn ones.
  Reached some() {
    const Solution first = best_;
    climb(first);
    for (int seed = 0; seed < seeds_ && left_ > 0; ++seed) {
      RandomStream draws({.seed = static_cast<std::uint64_t>(seed), .purpose = Purpose::kSynthesis});
      Solution drawn = first;
      for (std::size_t digit = 0; digit < moving_.size(); ++digit)
        drawn.offsets[moving_[digit]] = choices_[digit][draws.bits() % choices_[digit].size()];
      climb(drawn);
    }
    return {value_, -std::numeric_limits<double>::infinity(), false, "not proven"};
  }

  bool few() const {
    std::int64_t product = 1;
    for (const auto& choices : choices_) {
      if (static_cast<std::int64_t>(choices.size()) > left_ / product) return false;
      product *= static_cast<std::int64_t>(choices.size());
    }
    return true;
  }

 private:
  void add(const Model& model, std::size_t activity) {
    std::vector<Ticks> choices;
    const Window& window = model.windows[activity];
    for (Ticks offset = window.first; offset <= window.last; offset += objective_.raster) {
      const Ticks on_grid = model.on_grid_from(activity, offset);
      if (on_grid <= window.last && (choices.empty() || choices.back() != on_grid)) choices.push_back(on_grid);
    }
    moving_.push_back(activity);
    choices_.push_back(std::move(choices));
  }

  // Whether offsets exist in which the moving activities are where `trial` has them.
  bool completed(Solution& trial) {
    if (keeps(tightened_.question(), trial)) return true;
    Tightened held = tightened_;
    for (const std::size_t activity : moving_) {
      held.problem.activities[activity].window = {trial.offsets[activity], trial.offsets[activity]};
    }
    const Verdict verdict = decider_.decide(held.question());
    sure_ &= verdict.kind != Verdict::Kind::kUnknown;
    if (verdict.kind != Verdict::Kind::kFeasible) return false;
    trial = verdict.solution;
    return true;
  }

  bool take_if_better(Solution trial) {
    --left_;
    const double value = objective_.function(trial.offsets);
    if (!(value < value_) || !completed(trial)) return false;
    value_ = value;
    best_ = std::move(trial);
    return true;
  }

  void climb(Solution from) {
    double reached = std::numeric_limits<double>::infinity();
    for (bool moved = true; moved && left_ > 0;) {
      moved = false;
      for (std::size_t digit = 0; digit < moving_.size() && left_ > 0; ++digit) {
        for (const Ticks offset : choices_[digit]) {
          Solution trial = from;
          trial.offsets[moving_[digit]] = offset;
          --left_;
          const double value = objective_.function(trial.offsets);
          if (!(value < reached) || !completed(trial)) continue;
          from = std::move(trial);
          reached = value;
          moved = true;
        }
      }
    }
    if (reached < value_) value_ = reached, best_ = std::move(from);
  }

  const Tightened& tightened_;
  const Objective& objective_;
  Decider& decider_;
  Solution& best_;
  std::int64_t left_;  // evaluations
  int seeds_;
  bool sure_ = true;
  double value_ = 0;
  std::vector<std::size_t> moving_;
  std::vector<std::vector<Ticks>> choices_;  // by moving_
};

}  // namespace

Reached least_on_raster(const Tightened& tightened, const Objective& objective, const Effort& effort, Decider& decider,
                        Solution& best) {
  TTF_CHECK(objective.function && objective.raster > 0, "a raster of {} ticks", objective.raster);
  Raster raster(tightened, objective, effort, decider, best);
  return raster.few() ? raster.all() : raster.some();
}

}  // namespace ttf::schedules::synthesis::solver
