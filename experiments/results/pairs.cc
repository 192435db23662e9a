#include "experiments/results/pairs.h"

#include <algorithm>
#include <utility>

#include "core/counted.h"

namespace ttf::experiments::results {
namespace {

constexpr std::size_t kNamed = 3;  // points

// The certain points of two paradigms whose differences have the same sign.
struct Alike {
  std::size_t less = 0, more = 0;
  std::vector<std::string> points;
};

}  // namespace

Pairs judged_together(std::vector<PairedDifference> pairs, double confidence) {
  std::vector<Interval> differences;
  for (const PairedDifference& pair : pairs) differences.push_back(pair.difference);
  Pairs judged{std::move(pairs), family_of(differences, confidence)};
  for (std::size_t i = 0; i < judged.all.size(); ++i) judged.all[i].stays = judged.family.stays[i];
  return judged;
}

std::string certain_pairs(const Pairs& pairs, std::span<const std::string> paradigms,
                          std::span<const std::string> points) {
  std::vector<Alike> groups;
  for (const PairedDifference& pair : pairs.all) {
    if (!pair.stays) continue;
    const bool less = pair.difference.mean < 0.0;
    const std::size_t first = less ? pair.one : pair.other, second = less ? pair.other : pair.one;
    auto group = std::ranges::find_if(groups, [&](const Alike& of) { return of.less == first && of.more == second; });
    if (group == groups.end()) group = groups.insert(groups.end(), Alike{first, second, {}});
    group->points.push_back("at " + points[pair.point]);
  }
  std::string text;
  for (const Alike& group : groups) {
    text += (text.empty() ? "" : "; ") + paradigms[group.less] + " less than " + paradigms[group.more];
    if (group.points.size() > kNamed)
      text += " at " + std::to_string(group.points.size()) + " of " + counted(points.size(), "point");
    else if (points.size() > 1)
      text += " " + joined(group.points, " and ");
  }
  return text;
}

}  // namespace ttf::experiments::results
