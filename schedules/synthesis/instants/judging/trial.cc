#include "schedules/synthesis/instants/judging/trial.h"

#include "core/check.h"

namespace ttf::schedules::synthesis::instants::judging {

std::optional<Read> read_of(const plan::Plan& plan, const Trial& trial) {
  auto read = read_of(plan, trial.candidate);
  if (read)
    for (const Trial::Pin& pin : trial.pins) read->reading.problem.activities[pin.activity].fixed = pin.at;
  return read;
}

void pin(const Problem& problem, Trial& trial) {
  TTF_CHECK(trial.placed.has_value(), "a trial without instants is pinned");
  for (const Chain& chain : problem.chains)
    for (const std::size_t activity : {chain.activities.front(), chain.activities.back()})
      trial.pins.push_back({activity, trial.placed->solution.offsets[activity]});
  trial.limits.largest_ages = trial.placed->ages;
  trial.limits.beyond.clear();
  trial.limits.worst_age.reset();
}

}  // namespace ttf::schedules::synthesis::instants::judging
