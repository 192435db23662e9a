#include "experiments/sweep/answers/sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "core/counted.h"
#include "evaluation/measures/measure.h"
#include "experiments/sweep/answers/figures.h"

namespace ttf::experiments::sweep::answers {
namespace {

using evaluation::measures::find_measure;

using results::Interval;
using results::Ratio;

constexpr const char* kNoDifference = "no difference that these drives can tell";
constexpr std::uint64_t kEnough = 20;  // replications, for the jackknife's interval

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

// Collects estimates of several points: in per cent, or in a unit.
struct Range {
  std::string_view unit;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (std::isnan(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const Range& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  bool empty() const { return low > high; }
  // "-12 %" of one point, or "estimates from -12 to -7 %", which is no interval.
  std::string estimates() const {
    if (empty()) return "";
    const std::string text = range_text(low, high, true, unit);
    return text.find(" to ") == std::string::npos ? text : "estimates from " + text;
  }
  std::string in_brackets() const { return empty() ? "" : " (" + estimates() + ")"; }
};

std::string_view unit_of(const SweepFile& sweep, std::size_t measure, bool by_ratio) {
  return by_ratio ? "%" : find_measure(sweep.measures[measure])->unit;
}

std::string sentence_at_one(const SweepFile& sweep, const Compared& of) {
  const Interval& difference = of.points[0]->differences[of.paradigm].front();
  const Ratio& ratio = of.points[0]->ratios[of.paradigm].front();
  const bool certain = difference.below(0.0) || difference.above(0.0);
  const std::string plain = with_unit(sweep, 0, interval_text(difference, true));
  if (!certain) {
    const std::string size = std::isnan(ratio.low) ? plain : percent_text(ratio);
    return fmt::format("There is no difference of {} {} that these drives can tell{}.\n", sweep.measures.front(),
                       of.between, size == "-" ? "" : ": " + size);
  }
  return fmt::format("{} is {} than {}, by {}.\n", of.one, verdict(difference), of.other,
                     std::isnan(ratio.low) ? size_of(sweep, 0, difference) : percent_size(ratio));
}

std::string sentence_at_many(const SweepFile& sweep, const Compared& of) {
  int less = 0, more = 0, undecided = 0;
  const bool by_ratio = std::ranges::all_of(
      of.points, [&](const PointAnswer* point) { return !std::isnan(point->ratios[of.paradigm].front().value); });
  Range all{unit_of(sweep, 0, by_ratio)}, range_less = all, range_more = all;
  for (const PointAnswer* point : of.points) {
    const Interval& difference = point->differences[of.paradigm].front();
    const double estimate = by_ratio ? in_percent(point->ratios[of.paradigm].front().value) : difference.mean;
    all.add(estimate);
    if (difference.below(0.0)) {
      ++less;
      range_less.add(estimate);
    } else if (difference.above(0.0)) {
      ++more;
      range_more.add(estimate);
    } else {
      ++undecided;
    }
  }
  if (less + more == 0)
    return fmt::format("There is no difference of {} {} that these drives can tell, at any of {}{}.\n",
                       sweep.measures.front(), of.between, counted(of.points.size(), "point"), all.in_brackets());
  return fmt::format("{} is less than {} at {}{}, more at {}{}, undecided at {}.\n", of.one, of.other,
                     counted(static_cast<std::uint64_t>(less), "point"), range_less.in_brackets(), more,
                     range_more.in_brackets(), undecided);
}

// Names up to three points, without one axis; counts more.
std::string places(const SweepFile& sweep, const std::vector<std::uint32_t>& points, std::size_t without) {
  if (points.size() > 3) return counted(points.size(), "point");
  std::vector<std::string> labels;
  for (const std::uint32_t point : points) labels.push_back(sweep.label_without(point, without));
  return joined(labels, " and ");
}

enum class Direction : std::uint8_t { kMore, kLess, kNothing };

Direction direction_of(const InteractionPoint& here) {
  return !here.stays ? Direction::kNothing : here.interaction.mean < 0.0 ? Direction::kMore : Direction::kLess;
}

std::string begin_of(Direction direction, const std::string& first, bool lowers) {
  switch (direction) {
    case Direction::kMore: return lowers ? "Yes" : fmt::format("No, it only raises {} less", first);
    case Direction::kLess: return "No";
    case Direction::kNothing: break;
  }
  return std::string("There is ") + kNoDifference;
}

std::string beside(const SweepFile& sweep, const Interaction& of, const InteractionPoint& here, Direction direction) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  const bool ratio = of.scale == Scale::kRatio;
  if (std::isnan(here.interaction.half_width)) return "";
  const std::string effect = interaction_effect(sweep, of, here);
  if (direction == Direction::kNothing) return fmt::format(" {} against {}: {}.", first, second, effect);
  return fmt::format(
      " Beside that of {}, {}'s becomes {} by {}.", second, first, direction == Direction::kMore ? "less" : "more",
      ratio ? percent_size(results::exponential(here.interaction)) : size_of(sweep, of.measure, here.interaction));
}

std::string interaction_at_one(const SweepFile& sweep, const Interaction& of, const InteractionPoint& here) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  const Direction direction = direction_of(here);
  return fmt::format("{}: {} changes {} of {} by {}, and that of {} by {}.{}\n",
                     begin_of(direction, first, here.first.difference.mean < 0.0), change_name(sweep, of),
                     sweep.measures[of.measure], first, change_effect(sweep, of, here.first), second,
                     change_effect(sweep, of, here.second), beside(sweep, of, here, direction));
}

// Points at which an interaction is reported alike, and the first paradigm's change has the same sign.
struct Alike {
  Direction direction = Direction::kNothing;
  bool lowers = false;
  std::vector<std::uint32_t> points;
  Range first, second, both;  // the changes, and the first one against the second
};

// Points without a verdict are one group, whatever their changes' signs.
std::vector<Alike> alike_of(const SweepFile& sweep, const Interaction& of, const InteractionAnswer& answer) {
  const bool by_ratio = of.scale == Scale::kRatio && std::ranges::all_of(answer.points, [](const auto& here) {
                          return !std::isnan(here.first.ratio.value) && !std::isnan(here.second.ratio.value);
                        });
  const Range range{unit_of(sweep, of.measure, by_ratio)};
  std::vector<Alike> groups;
  for (const InteractionPoint& here : answer.points) {
    const Direction direction = direction_of(here);
    const bool lowers = direction != Direction::kNothing && here.first.difference.mean < 0.0;
    auto group =
        std::ranges::find_if(groups, [&](const Alike& g) { return g.direction == direction && g.lowers == lowers; });
    if (group == groups.end())
      group = groups.insert(
          groups.end(),
          Alike{direction, lowers, {}, range, range, Range{unit_of(sweep, of.measure, of.scale == Scale::kRatio)}});
    group->points.push_back(here.point);
    group->first.add(by_ratio ? in_percent(here.first.ratio.value) : here.first.difference.mean);
    group->second.add(by_ratio ? in_percent(here.second.ratio.value) : here.second.difference.mean);
    group->both.add(of.scale == Scale::kRatio ? in_percent(std::exp(here.interaction.mean)) : here.interaction.mean);
  }
  return groups;
}

// "tt's factor is 12 % below adva's": of a group whose interactions all have the same sign.
std::string against(const SweepFile& sweep, const Interaction& of, const Alike& group, const std::string& where) {
  const std::string sizes =
      range_text(std::min(std::abs(group.both.low), std::abs(group.both.high)),
                 std::max(std::abs(group.both.low), std::abs(group.both.high)), false, group.both.unit);
  return fmt::format(" {}{}'s {} is {}{} {} {}'s.", where, sweep.paradigms[of.first].name,
                     of.scale == Scale::kRatio ? "factor" : "change",
                     sizes.find(" to ") == std::string::npos ? "" : "estimated ", sizes,
                     group.direction == Direction::kMore ? "below" : "above", sweep.paradigms[of.second].name);
}

// Whether the same can be said of all points.
bool one_for_all(const std::vector<Alike>& groups) {
  return std::ranges::all_of(groups, [&](const Alike& group) {
    return group.direction == groups[0].direction &&
           (group.direction != Direction::kMore || group.lowers == groups[0].lowers);
  });
}

std::string interaction_at_many(const SweepFile& sweep, const Interaction& of, const InteractionAnswer& answer) {
  const std::string &first = sweep.paradigms[of.first].name, &second = sweep.paradigms[of.second].name;
  const std::vector<Alike> groups = alike_of(sweep, of, answer);
  const std::string change = change_name(sweep, of), &measure = sweep.measures[of.measure];
  const bool alike = one_for_all(groups);
  std::string text, nothing, behind;
  if (alike) {
    Range ones = groups[0].first, others = groups[0].second;
    for (const Alike& group : groups) {
      ones.add(group.first);
      others.add(group.second);
    }
    text = fmt::format(
        "{}, at {} {}: {} changes {} of {}{} and of {}{}", begin_of(groups[0].direction, first, groups[0].lowers),
        groups[0].direction == Direction::kNothing ? "any of" : "all", counted(answer.points.size(), "point"), change,
        measure, first, ones.in_brackets(), second, others.in_brackets());
  } else {
    bool yes = false, no = false;
    std::vector<std::string> clauses;
    for (const Alike& group : groups) {
      if (group.direction == Direction::kNothing) {
        nothing = fmt::format("; at {} there is {}", places(sweep, group.points, of.axis), kNoDifference);
        continue;
      }
      const bool lowers_more = group.direction == Direction::kMore && group.lowers;
      (lowers_more ? yes : no) = true;
      const bool by_more = (group.direction == Direction::kMore) == group.lowers;
      clauses.push_back(fmt::format("{} {} of {}{} {} than that of {}{} at {}", group.lowers ? "lowers" : "raises",
                                    measure, first, group.first.in_brackets(), by_more ? "more" : "less", second,
                                    group.second.in_brackets(), places(sweep, group.points, of.axis)));
    }
    text = fmt::format("{}: {} {}{}",
                       !no   ? "In part"
                       : yes ? "It depends"
                             : "No",
                       change, joined(clauses, ", and "), nothing);
  }
  for (const Alike& group : groups)
    if (group.direction != Direction::kNothing && !group.both.empty())
      behind += against(sweep, of, group,
                        groups.size() == 1 ? "" : fmt::format("At {} ", places(sweep, group.points, of.axis)));
  if (groups[0].direction == Direction::kNothing && groups.size() == 1 && !groups[0].both.empty())
    behind = fmt::format(" {} against {}: {}.", first, second, groups[0].both.estimates());
  return text + '.' + behind + '\n';
}

// Names all pairs of paradigms that stay certain together, or "".
std::string certain_pairs(const SweepFile& sweep, const SweepAnswer& answer) {
  std::vector<std::string> paradigms, points;
  for (const Paradigm& paradigm : sweep.paradigms) paradigms.push_back(paradigm.name);
  for (const PointAnswer& point : answer.points) points.push_back(sweep.label_of(point.point));
  return results::certain_pairs(answer.pairs, paradigms, points);
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

std::string lost_lines(const SweepFile& sweep, const SweepAnswer& answer) {
  if (!answer.lost) return "";
  std::vector<std::string> shares;
  for (std::size_t p = 0; p < sweep.paradigms.size(); ++p)
    shares.push_back(fmt::format("{} of {} of {}", answer.lost->lost[p], counted(answer.lost->drives[p], "drive"),
                                 sweep.paradigms[p].name));
  std::string text = fmt::format("An object lost its track in {}.\n", joined(shares));
  if (answer.lost->left_out == 0) return text;
  SweepAnswer without;
  without.points = answer.lost->points;
  const auto has_drives = [](const PointAnswer& point) { return point.means.front().front().count > 0; };
  if (std::ranges::none_of(without.points, has_drives)) return text + "No replication is without a lost track.\n";
  const std::string lines = answer_lines(sweep, without);
  if (lines.empty()) return text;
  return text +
         fmt::format("Without {} that lost a track, left out for all paradigms:\n",
                     counted(answer.lost->left_out, "replication")) +
         lines;
}

std::string family_lines(const SweepFile& sweep, const SweepAnswer& answer) {
  std::string text;
  if (answer.comparisons > 0)
    text += fmt::format(
        "{} of {}, marked *, stay certain together by Holm's method at {}; each interval stands for itself.\n",
        answer.certain, counted(answer.comparisons, "comparison"), level(sweep));
  if (answer.pairs.family.comparisons > 0) {
    const std::string names = certain_pairs(sweep, answer);
    text += fmt::format("Of all pairs of paradigms, {} of {} stay certain together likewise{}{}.\n",
                        answer.pairs.family.certain, counted(answer.pairs.family.comparisons, "comparison"),
                        names.empty() ? "" : ": ", names);
  }
  std::size_t interactions = 0, certain = 0;
  std::uint64_t fewest = kEnough;
  for (std::size_t i = 0; i < answer.interactions.size(); ++i)
    for (const InteractionPoint& here : answer.interactions[i].points) {
      if (std::isnan(here.interaction.half_width)) continue;
      ++interactions;
      certain += here.stays;
      if (sweep.interactions[i].scale == Scale::kRatio) fewest = std::min(fewest, here.interaction.count);
    }
  if (interactions > 0)
    text += fmt::format("{} of {}, marked *, stay certain together by Holm's method at {}, as a family of their own.\n",
                        certain, counted(interactions, "interaction"), level(sweep));
  if (fewest < kEnough)
    text += fmt::format("The jackknife's interval of an interaction needs some twenty replications, and here has {}.\n",
                        fewest);
  return text;
}

}  // namespace ttf::experiments::sweep::answers
