#include "experiments/sweep/answers/interactions.h"

#include <cmath>
#include <utility>

#include "experiments/results/multiplicity.h"
#include "experiments/results/ratio.h"
#include "experiments/sweep/answers/point_drives.h"

namespace ttf::experiments::sweep::answers {
namespace {

using results::Moments;
using results::Quadruple;

// The same replication of both paradigms before and after. A replication without all four values is left out.
std::vector<Quadruple> values_of(const Interaction& of, const PointDrives& before, const PointDrives& after) {
  std::vector<Quadruple> values;
  const auto add = [&](double first_before, double first_after, double second_before, double second_after) {
    if (std::isfinite(first_before) && std::isfinite(first_after) && std::isfinite(second_before) &&
        std::isfinite(second_after))
      values.push_back({first_before, first_after, second_before, second_after});
  };
  std::vector<const results::Row*> firsts, seconds;  // before; of replications that are there after, too
  std::vector<double> first_after, second_after;
  for_each_pair(before.of(of.first), after.of(of.first), [&](const results::Row& one, const results::Row& other) {
    firsts.push_back(&one);
    first_after.push_back(after.value(other, of.measure));
  });
  for_each_pair(before.of(of.second), after.of(of.second), [&](const results::Row& one, const results::Row& other) {
    seconds.push_back(&one);
    second_after.push_back(after.value(other, of.measure));
  });
  for (std::size_t f = 0, s = 0; f < firsts.size() && s < seconds.size();) {
    const std::uint32_t first = firsts[f]->key.replication, second = seconds[s]->key.replication;
    if (first == second)
      add(before.value(*firsts[f], of.measure), first_after[f], before.value(*seconds[s], of.measure), second_after[s]);
    f += first <= second;
    s += second <= first;
  }
  return values;
}

// The change of one paradigm; as pairs of the value after and the value before.
Change change_of(const Interaction& of, const std::vector<Quadruple>& values, bool first, double confidence) {
  std::vector<std::pair<double, double>> pairs;
  Moments differences;
  for (const Quadruple& one : values) {
    pairs.emplace_back(first ? one.first_after : one.second_after, first ? one.first_before : one.second_before);
    differences.add(pairs.back().first - pairs.back().second);
  }
  Change change{interval_of(differences, confidence), {}};
  if (of.scale == Scale::kRatio) change.ratio = results::ratio_of(pairs, confidence);
  return change;
}

}  // namespace

std::vector<InteractionAnswer> interactions_of(const SweepFile& sweep, const results::Store& store) {
  std::vector<InteractionAnswer> answers;
  std::vector<results::Interval> all;
  for (const Interaction& of : sweep.interactions) {
    InteractionAnswer& answer = answers.emplace_back();
    for (std::uint32_t point = 0; point < sweep.points(); ++point) {
      if (sweep.moved(point, of.axis, of.before) != point) continue;
      const PointDrives before(sweep, store.of_point(point));
      const PointDrives after(sweep, store.of_point(sweep.moved(point, of.axis, of.after)));
      const std::vector<Quadruple> values = values_of(of, before, after);
      InteractionPoint& here = answer.points.emplace_back();
      here.point = point;
      here.first = change_of(of, values, true, sweep.confidence);
      here.second = change_of(of, values, false, sweep.confidence);
      here.interaction = of.scale == Scale::kRatio ? results::log_ratio_of_ratios(values, sweep.confidence)
                                                   : results::difference_of_differences(values, sweep.confidence);
      all.push_back(here.interaction);
    }
  }
  const results::Family family = results::family_of(all, sweep.confidence);
  auto stays = family.stays.begin();
  for (InteractionAnswer& answer : answers)
    for (InteractionPoint& here : answer.points) here.stays = *stays++;
  return answers;
}

}  // namespace ttf::experiments::sweep::answers
