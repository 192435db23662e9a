#include "tests/fuzz/plan_laws.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/check.h"
#include "schedules/check/checker.h"
#include "schedules/exchange/cluster_yaml.h"
#include "schedules/file/loader.h"
#include "schedules/synthesis/instants/candidates.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/loader.h"
#include "tests/fuzz/harness.h"

namespace ttf::fuzz {
namespace {

namespace synthesis = schedules::synthesis;
using synthesis::plan::Plan;

constexpr std::size_t kMostSensors = 2, kMostChains = 4, kMostLists = 6, kMostChoices = 8;

// Leaves out most choices. Returns whether the rest is small.
bool narrowed(Plan& plan) {
  plan.cycle.longest = std::min(plan.cycle.longest, plan.cycle.shortest + plan.cycle.step);
  if (plan.payload)
    plan.payload->longest = std::min(plan.payload->longest, plan.payload->shortest + plan.payload->step);
  for (synthesis::plan::PlannedSensor& sensor : plan.sensors)
    if (sensor.rate) sensor.rate->longest = std::min(sensor.rate->longest, sensor.rate->shortest * 2);
  return plan.sensors.size() <= kMostSensors && plan.chains.size() <= kMostChains && plan.lists.size() <= kMostLists &&
         synthesis::instants::candidates(plan).size() <= kMostChoices;
}

void check_values(const Plan& plan, const synthesis::instants::Synthesis& made) {
  TTF_CHECK(made.reached.size() == plan.objective.size(), "{} of {} objectives", made.reached.size(),
            plan.objective.size());
  for (const auto& one : made.reached) {
    const bool more_is_better = one.goal == synthesis::plan::Goal::kRoom;
    TTF_CHECK(std::isfinite(one.value) && std::isfinite(one.bound), "{}: {}, bound {}",
              synthesis::plan::name_of(one.goal), one.value, one.bound);
    TTF_CHECK(more_is_better ? one.value <= one.bound : one.value >= one.bound, "{}: {} is beyond its bound {}",
              synthesis::plan::name_of(one.goal), one.value, one.bound);
  }
  TTF_CHECK(made.ages.size() == plan.chains.size(), "{} ages of {} chains", made.ages.size(), plan.chains.size());
  for (std::size_t c = 0; c < plan.chains.size(); ++c) {
    const auto& age = made.ages[c];
    TTF_CHECK(age.best <= age.worst, "chain {}: best {} ns, worst {} ns", c, age.best.ns, age.worst.ns);
    if (const auto& largest = plan.chains[c].largest_age)
      TTF_CHECK(age.worst <= *largest, "chain {}: {} ns of {} ns", c, age.worst.ns, largest->ns);
  }
}

}  // namespace

void check_plan(const std::string& text) {
  constexpr char kFile[] = "plan.yaml";
  Plan plan;
  if (!accepted(kFile, [&] { plan = synthesis::plan::parse_plan(text, kFile); }) || !narrowed(plan)) return;
  synthesis::instants::Synthesis made;
  if (!accepted(kFile, [&] { made = synthesis::instants::synthesize(plan); })) return;
  if (!made.found) {
    if (!made.refused.empty()) check_refusal(InputError(made.refused), kFile);
    return;
  }
  TTF_CHECK(schedules::check::check(made.cluster).empty(), "the check refuses a found cluster");
  check_values(plan, made);
  const std::string written = schedules::exchange::cluster_yaml(made.cluster, "");
  const schedules::model::Cluster again = schedules::file::parse_cluster(written, "made.yaml");
  TTF_CHECK(schedules::check::check(again).empty(), "the check refuses the written cluster");
  TTF_CHECK(schedules::exchange::cluster_yaml(again, "") == written, "a written cluster is another when read again");
}

}  // namespace ttf::fuzz
