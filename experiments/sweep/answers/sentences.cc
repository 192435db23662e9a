#include "experiments/sweep/answers/sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/counted.h"
#include "experiments/sweep/answers/figures.h"
#include "experiments/sweep/measures.h"

namespace ttf::experiments::sweep::answers {
namespace {

using results::Interval;
using results::Ratio;

constexpr const char* kNoDifference = "no difference that these drives can tell";

std::string with_unit(const SweepFile& sweep, std::size_t measure, const std::string& text) {
  const std::string_view unit = find_measure(sweep.measures[measure])->unit;
  return unit.empty() || text == "-" ? text : fmt::format("{} {}", text, unit);
}

// The size of a difference behind "less by" or "more by".
std::string size_of(const SweepFile& sweep, std::size_t measure, Interval difference) {
  difference.mean = std::abs(difference.mean);
  return with_unit(sweep, measure, interval_text(difference, false));
}

// Two things whose first measure is compared at some points.
struct Compared {
  std::string one, other;  // "X of tt", "that of adva"
  std::string between;     // "between tt and adva"
  std::size_t paradigm = 0;
  std::vector<const PointAnswer*> points;
};

std::vector<Compared> compared_of(const SweepFile& sweep, const SweepAnswer& answer) {
  std::vector<Compared> all;
  const std::string& measure = sweep.measures.front();
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p) {
    const std::string& name = sweep.paradigms[p].name;
    if (!sweep.compared_axis) {
      if (p == sweep.baseline) continue;
      const std::string& baseline = sweep.paradigms[sweep.baseline].name;
      Compared& one = all.emplace_back(Compared{fmt::format("{} of {}", measure, name),
                                                "that of " + baseline,
                                                fmt::format("between {} and {}", name, baseline),
                                                p,
                                                {}});
      for (const PointAnswer& point : answer.points) one.points.push_back(&point);
      continue;
    }
    const Axis& axis = *sweep.grid()[sweep.compared_axis->axis];
    const Setting& baseline = axis.settings[sweep.compared_axis->baseline];
    for (const Setting& setting : axis.settings) {
      if (&setting == &baseline) continue;
      Compared& one = all.emplace_back(
          Compared{fmt::format("{} of {} with {} {}", measure, name, axis.name, setting.label),
                   fmt::format("with {}", baseline.label),
                   fmt::format("of {} between {} {} and {}", name, axis.name, setting.label, baseline.label),
                   p,
                   {}});
      for (const PointAnswer& point : answer.points)
        if (sweep.settings_of(point.point)[sweep.compared_axis->axis] == &setting) one.points.push_back(&point);
    }
  }
  return all;
}

// Collects effects of several points.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (std::isnan(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  std::string in_percent() const { return low <= high ? percent_range(low, high) : ""; }
};

std::string in_brackets(const std::string& text) { return text.empty() ? "" : " (" + text + ")"; }

std::string sentence_at_one(const SweepFile& sweep, const Compared& of) {
  const Interval& difference = of.points[0]->differences[of.paradigm].front();
  const Ratio& ratio = of.points[0]->ratios[of.paradigm].front();
  const bool told = difference.below(0.0) || difference.above(0.0);
  const std::string plain = with_unit(sweep, 0, interval_text(difference, true));
  if (!told) {
    const std::string size = std::isnan(ratio.low) ? plain : percent_text(ratio);
    return fmt::format("There is no difference of {} {} that these drives can tell{}.\n", sweep.measures.front(),
                       of.between, size == "-" ? "" : ": " + size);
  }
  return fmt::format("{} is {} than {}, by {}.\n", of.one, verdict(difference), of.other,
                     std::isnan(ratio.low) ? size_of(sweep, 0, difference) : percent_size(ratio));
}

std::string sentence_at_many(const SweepFile& sweep, const Compared& of) {
  int less = 0, more = 0, undecided = 0;
  Range range_less, range_more, range;
  for (const PointAnswer* point : of.points) {
    const Interval& difference = point->differences[of.paradigm].front();
    const double ratio = point->ratios[of.paradigm].front().value;
    range.add(ratio);
    if (difference.below(0.0)) {
      ++less;
      range_less.add(ratio);
    } else if (difference.above(0.0)) {
      ++more;
      range_more.add(ratio);
    } else {
      ++undecided;
    }
  }
  if (less + more == 0)
    return fmt::format("There is no difference of {} {} that these drives can tell, at any of {}{}.\n",
                       sweep.measures.front(), of.between, counted(of.points.size(), "point"),
                       in_brackets(range.in_percent()));
  return fmt::format("{} is less than {} at {}{}, more at {}{}, undecided at {}.\n", of.one, of.other,
                     counted(static_cast<std::uint64_t>(less), "point"), in_brackets(range_less.in_percent()), more,
                     in_brackets(range_more.in_percent()), undecided);
}

// Names up to three points, without one axis; counts more.
std::string places(const SweepFile& sweep, const std::vector<std::uint32_t>& points, std::size_t without) {
  if (points.size() > 3) return counted(points.size(), "point");
  std::vector<std::string> labels;
  for (const std::uint32_t point : points) labels.push_back(sweep.label_without(point, without));
  return joined(labels, " and ");
}

enum class Told : std::uint8_t { kMore, kLess, kNothing };

Told told_of(const InteractionPoint& here) {
  return !here.stays ? Told::kNothing : here.interaction.mean < 0.0 ? Told::kMore : Told::kLess;
}

std::string begin_of(Told told, const std::string& first, bool lowers) {
  switch (told) {
    case Told::kMore: return lowers ? "Yes" : fmt::format("No, it only raises {} less", first);
    case Told::kLess: return "No";
    case Told::kNothing: break;
  }
  return std::string("There is ") + kNoDifference;
}

std::string beside(const SweepFile& sweep, const Interaction& of, const InteractionPoint& here, Told told) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  const bool ratio = of.scale == Scale::kRatio;
  if (std::isnan(here.interaction.half_width)) return "";
  const std::string effect = interaction_effect(sweep, of, here);
  if (told == Told::kNothing) return fmt::format(" {} against {}: {}.", first, second, effect);
  return fmt::format(
      " Beside that of {}, {}'s becomes {} by {}.", second, first, told == Told::kMore ? "less" : "more",
      ratio ? percent_size(results::exponential(here.interaction)) : size_of(sweep, of.measure, here.interaction));
}

std::string interaction_at_one(const SweepFile& sweep, const Interaction& of, const InteractionPoint& here) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  const Told told = told_of(here);
  return fmt::format("{}: {} changes {} of {} by {}, and that of {} by {}.{}\n",
                     begin_of(told, first, here.first.difference.mean < 0.0), change_name(sweep, of),
                     sweep.measures[of.measure], first, change_effect(sweep, of, here.first), second,
                     change_effect(sweep, of, here.second), beside(sweep, of, here, told));
}

std::string interaction_at_many(const SweepFile& sweep, const Interaction& of, const InteractionAnswer& answer) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  std::vector<std::uint32_t> more, less, nothing;
  bool lowers = true;
  Range ones, others, both;
  for (const InteractionPoint& here : answer.points) {
    const Told told = told_of(here);
    (told == Told::kMore ? more : told == Told::kLess ? less : nothing).push_back(here.point);
    lowers = lowers && here.first.difference.mean < 0.0;
    ones.add(here.first.ratio.value);
    others.add(here.second.ratio.value);
    both.add(of.scale == Scale::kRatio ? std::exp(here.interaction.mean) : std::nan(""));
  }
  const std::size_t points = answer.points.size();
  const std::string change = change_name(sweep, of), &measure = sweep.measures[of.measure];
  const std::string one = first + in_brackets(ones.in_percent()), other = second + in_brackets(others.in_percent());
  std::string text;
  if (std::max({more.size(), less.size(), nothing.size()}) == points) {
    const Told told = !more.empty() ? Told::kMore : !less.empty() ? Told::kLess : Told::kNothing;
    text =
        fmt::format("{}, at {} {}: {} changes {} of {} and of {}.", begin_of(told, first, lowers),
                    told == Told::kNothing ? "any of" : "all", counted(points, "point"), change, measure, one, other);
  } else {
    const char* begin = less.empty() ? "In part" : more.empty() ? "No" : "It depends";
    text = fmt::format("{}: {} lowers {} of {}", begin, change, measure, one);
    if (!more.empty()) text += fmt::format(" more than that of {} at {}", other, places(sweep, more, of.axis));
    if (!less.empty())
      text += more.empty() ? fmt::format(" less than that of {} at {}", other, places(sweep, less, of.axis))
                           : fmt::format(", less at {}", places(sweep, less, of.axis));
    if (!nothing.empty()) text += fmt::format("; at {} there is {}", places(sweep, nothing, of.axis), kNoDifference);
    text += '.';
  }
  if (!both.in_percent().empty())
    text += fmt::format(" Beside that of {}, {}'s changes by {}.", second, first, both.in_percent());
  return text + '\n';
}

std::string level(const SweepFile& sweep) {
  return fmt::format("{:g} %", std::round(1e6 * (1.0 - sweep.confidence)) * 1e-4);
}

}  // namespace

std::string change_name(const SweepFile& sweep, const Interaction& interaction) {
  const Axis& axis = *sweep.grid()[interaction.axis];
  return fmt::format("{} from {} to {}", axis.name, axis.settings[interaction.before].label,
                     axis.settings[interaction.after].label);
}

std::string change_effect(const SweepFile& sweep, const Interaction& interaction, const Change& change) {
  if (interaction.scale == Scale::kRatio && !std::isnan(change.ratio.value)) return percent_text(change.ratio);
  return with_unit(sweep, interaction.measure, interval_text(change.difference, true));
}

std::string interaction_effect(const SweepFile& sweep, const Interaction& interaction, const InteractionPoint& here) {
  if (interaction.scale == Scale::kRatio) return percent_text(results::exponential(here.interaction));
  return with_unit(sweep, interaction.measure, interval_text(here.interaction, true));
}

std::string answer_lines(const SweepFile& sweep, const SweepAnswer& answer) {
  std::string text;
  for (std::size_t i = 0; i < answer.interactions.size(); ++i) {
    const InteractionAnswer& one = answer.interactions[i];
    text += one.points.size() == 1 ? interaction_at_one(sweep, sweep.interactions[i], one.points[0])
                                   : interaction_at_many(sweep, sweep.interactions[i], one);
  }
  for (const Compared& of : compared_of(sweep, answer)) {
    text += of.points.size() == 1 ? sentence_at_one(sweep, of) : sentence_at_many(sweep, of);
    for (const Crossing& crossing : answer.crossings)
      if (crossing.paradigm == of.paradigm && crossing.certain)
        text += fmt::format("They cross at {} {:.4g}{}.\n", crossing.axis, crossing.at,
                            crossing.others.empty() ? "" : ", with " + crossing.others);
  }
  return text;
}

std::string family_lines(const SweepFile& sweep, const SweepAnswer& answer) {
  std::string text;
  if (answer.comparisons > 0)
    text += fmt::format(
        "{} of {}, marked *, stay certain together by Holm's method at {}; each interval stands for itself.\n",
        answer.certain, counted(answer.comparisons, "comparison"), level(sweep));
  std::size_t interactions = 0, certain = 0;
  for (const InteractionAnswer& one : answer.interactions)
    for (const InteractionPoint& here : one.points) {
      interactions += !std::isnan(here.interaction.half_width);
      certain += here.stays;
    }
  if (interactions > 0)
    text += fmt::format("{} of {}, marked *, stay certain together by the same method, as a family of their own.\n",
                        certain, counted(interactions, "interaction"));
  return text;
}

}  // namespace ttf::experiments::sweep::answers
