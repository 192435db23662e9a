#include "cli/experiment/answer_json.h"

#include <cmath>

#include "evaluation/measures/measure.h"
#include "experiments/results/multiplicity.h"
#include "experiments/results/ratio.h"

namespace ttf::cli::experiment {

namespace {

namespace answers = experiments::sweep::answers;
namespace results = experiments::results;
using experiments::sweep::SweepFile;

nlohmann::ordered_json to_json(double value) {
  return std::isnan(value) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}
nlohmann::ordered_json to_json(const results::Interval& interval) {
  nlohmann::ordered_json json{
      {"count", interval.count}, {"mean", to_json(interval.mean)}, {"half_width", to_json(interval.half_width)}};
  if (interval.uneven()) {
    json["low"] = interval.low();
    json["high"] = interval.high();
  }
  return json;
}

// A ratio as a change in per cent, with its interval.
nlohmann::ordered_json percent_json(const results::Ratio& ratio) {
  const auto percent = [](double value) { return to_json(100.0 * (value - 1.0)); };
  return {{"mean", percent(ratio.value)}, {"low", percent(ratio.low)}, {"high", percent(ratio.high)}};
}

std::string baseline_of(const SweepFile& sweep) {
  if (!sweep.compared_axis) return sweep.paradigms[sweep.baseline].name;
  return sweep.grid()[sweep.compared_axis->axis]->settings[sweep.compared_axis->baseline].label;
}

nlohmann::ordered_json change_json(const answers::Change& change) {
  nlohmann::ordered_json json = to_json(change.difference);
  if (!std::isnan(change.ratio.value)) json["percent"] = percent_json(change.ratio);
  return json;
}

nlohmann::ordered_json interaction_json(const SweepFile& sweep, const experiments::sweep::Interaction& of,
                                        const answers::InteractionAnswer& answer) {
  const auto axes = sweep.grid();
  const experiments::sweep::Axis& axis = *axes[of.axis];
  const bool ratio = of.scale == experiments::sweep::Scale::kRatio;
  nlohmann::ordered_json json{{"measure", sweep.measures[of.measure]},
                              {"by", ratio ? "ratio" : "difference"},
                              {"axis", axis.name},
                              {"from", axis.settings[of.before].label},
                              {"to", axis.settings[of.after].label},
                              {"lowers", sweep.paradigms[of.first].name},
                              {"more_than", sweep.paradigms[of.second].name},
                              {"points", nlohmann::ordered_json::array()}};
  for (const answers::InteractionPoint& here : answer.points) {
    nlohmann::ordered_json one{{"axes", nlohmann::ordered_json::object()},
                               {"first", change_json(here.first)},
                               {"second", change_json(here.second)}};
    const auto settings = sweep.settings_of(here.point);
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (a != of.axis) one["axes"][axes[a]->name] = settings[a]->label;
    // By ratio, the interval is symmetrical in the logarithm of the ratio of ratios.
    one["interaction"] = to_json(here.interaction);
    if (ratio) one["interaction"]["percent"] = percent_json(results::exponential(here.interaction));
    one["interaction"]["p"] = to_json(results::p_value(here.interaction, sweep.confidence));
    one["interaction"]["stays_certain"] = here.stays;
    json["points"].push_back(std::move(one));
  }
  return json;
}

// The first measure's comparisons of all pairs of paradigms, and those that stay certain together.
nlohmann::ordered_json pairs_json(const SweepFile& sweep, const results::Pairs& pairs) {
  nlohmann::ordered_json json{{"comparisons", pairs.family.comparisons}, {"certain", nlohmann::ordered_json::array()}};
  for (const results::PairedDifference& pair : pairs.all) {
    if (!pair.stays) continue;
    json["certain"].push_back({{"point", pair.point},
                               {"paradigm", sweep.paradigms[pair.one].name},
                               {"against", sweep.paradigms[pair.other].name},
                               {"difference", to_json(pair.difference)}});
  }
  return json;
}

}  // namespace

nlohmann::ordered_json answer_json(const SweepFile& sweep, const answers::SweepAnswer& answer,
                                   const std::map<std::string, std::string>& libraries) {
  nlohmann::ordered_json json{{"experiment", sweep.name},
                              {"file", sweep.file},
                              {"question", sweep.question},
                              {"seed", sweep.seed},
                              {"confidence", sweep.confidence},
                              {"runs", answer.drives},
                              {"failed", answer.failed},
                              {"baseline", baseline_of(sweep)},
                              {"comparisons", answer.comparisons},
                              {"stay_certain", answer.certain},
                              {"answer", answers::answer_sentences(sweep, answer)}};
  if (!libraries.empty()) json["libraries"] = libraries;
  if (sweep.compared_axis) json["compared_axis"] = sweep.grid()[sweep.compared_axis->axis]->name;
  for (const std::string& name : sweep.measures) {
    const evaluation::measures::Measure& measure = *evaluation::measures::find_measure(name);
    json["measures"][name] = {{"unit", measure.unit}, {"meaning", measure.meaning}};
  }
  if (answer.lost) {
    json["lost_tracks"]["replications"] = answer.lost->left_out;
    for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
      json["lost_tracks"]["paradigms"][sweep.paradigms[p].name] = {{"drives", answer.lost->drives[p]},
                                                                   {"lost", answer.lost->lost[p]}};
  }
  const auto axes = sweep.grid();
  for (const answers::PointAnswer& point : answer.points) {
    nlohmann::ordered_json one{{"point", point.point}};
    const auto settings = sweep.settings_of(point.point);
    for (std::size_t a = 0; a < axes.size(); ++a) one["axes"][axes[a]->name] = settings[a]->label;
    for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
      for (std::size_t m = 0; m < sweep.measures.size(); ++m) {
        nlohmann::ordered_json& cell = one["paradigms"][sweep.paradigms[p].name][sweep.measures[m]];
        cell = to_json(point.means[p][m]);
        if (!sweep.reference_of(point.point, p)) continue;
        cell["difference"] = to_json(point.differences[p][m]);
        cell["difference"]["p"] = to_json(results::p_value(point.differences[p][m], sweep.confidence));
        if (!std::isnan(point.ratios[p][m].value)) cell["difference"]["percent"] = percent_json(point.ratios[p][m]);
        if (m == 0) cell["difference"]["stays_certain"] = static_cast<bool>(point.stays[p]);
      }
    json["points"].push_back(std::move(one));
  }
  json["pairs"] = pairs_json(sweep, answer.pairs);
  for (const answers::Crossing& crossing : answer.crossings)
    json["crossings"].push_back({{"paradigm", sweep.paradigms[crossing.paradigm].name},
                                 {"axis", crossing.axis},
                                 {"at", crossing.at},
                                 {"others", crossing.others},
                                 {"certain", crossing.certain}});
  for (std::size_t i = 0; i < answer.interactions.size(); ++i)
    json["interactions"].push_back(interaction_json(sweep, sweep.interactions[i], answer.interactions[i]));
  for (const answers::ExpectationAnswer& expectation : answer.expectations) {
    nlohmann::ordered_json one{{"expected", expectation.text},
                               {"holds", expectation.holds()},
                               {"outcome", to_text(expectation.outcome)},
                               {"where_not", nlohmann::ordered_json::array()},
                               {"why_not", nlohmann::ordered_json::array()}};
    for (const answers::Unmet& unmet : expectation.unmet) {
      one["where_not"].push_back(unmet.point);
      one["why_not"].push_back(unmet.why);
    }
    json["expectations"].push_back(std::move(one));
  }
  return json;
}

}  // namespace ttf::cli::experiment
