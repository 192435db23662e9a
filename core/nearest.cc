#include "core/nearest.h"

#include <algorithm>
#include <utility>

namespace ttf {
namespace {

constexpr std::size_t kShortest = 3;  // abbreviation

bool is_near(std::string_view typed, std::string_view name, std::size_t distance) {
  const std::size_t letters = std::max(typed.size(), name.size());
  const bool shares_letters = distance < letters;
  return (shares_letters && distance <= std::max<std::size_t>(1, letters / 3)) ||
         (typed.size() >= kShortest && name.starts_with(typed));
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest(std::string_view typed, const std::vector<std::string>& names) {
  std::optional<std::string> best;
  std::size_t least = 0;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(typed, name);
    if (!is_near(typed, name, distance) || (best && distance >= least)) continue;
    best = name;
    least = distance;
  }
  return best;
}

std::string did_you_mean(std::string_view typed, const std::vector<std::string>& names) {
  const auto near = nearest(typed, names);
  return near ? "; did you mean " + *near + "?" : "";
}

}  // namespace ttf
