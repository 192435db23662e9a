#include "schedules/synthesis/instants/judging/attainable.h"

#include <algorithm>
#include <optional>

#include "schedules/synthesis/instants/bounds.h"

namespace ttf::schedules::synthesis::instants::judging {
namespace {

// The fusion on a chain's way, and the ages that are asked for.
struct Fusion {
  std::size_t activity = 0;
  NodeId node{};
  Ticks head = 0, tail = 0;  // least ages: of the measurement at its beginning, of its end at the use
  Ticks duration = 0, youngest = 0, oldest = 0;

  bool beside(const Reading& reading, const Fusion& other) const {
    const std::vector<Activity>& activities = reading.problem.activities;
    return node == other.node && activity != other.activity &&
           activities[activity].resource == activities[other.activity].resource;
  }
};

std::optional<Fusion> fusion_of(const Reading& reading, const Chain& chain) {
  const auto fused = std::find_if(reading.fused.begin(), reading.fused.end(),
                                  [&](const Fused& one) { return one.measuring == chain.activities.front(); });
  if (fused == reading.fused.end() || !reading.problem.activities[fused->fusing].resource) return std::nullopt;
  Fusion found{fused->fusing, fused->node, 0, 0, reading.problem.activities[fused->fusing].duration, 0, 0};
  bool behind = false;
  for (std::size_t i = 0; i < chain.activities.size(); ++i) {
    behind = behind || chain.activities[i] == fused->fusing;
    if (i + 1 == chain.activities.size()) break;
    (behind ? found.tail : found.head) += reading.problem.activities[chain.activities[i]].duration + chain.gaps[i];
  }
  if (!behind) return std::nullopt;
  found.tail -= found.duration;
  return found;
}

// Lets each fusion end before those of all newer lists. `fusions` rise in `oldest`: the newer ones stand before.
void wait_for_newer(const Reading& reading, std::vector<Fusion>& fusions) {
  for (std::size_t i = 0; i < fusions.size(); ++i) {
    std::vector<std::pair<Ticks, Ticks>> newer;  // tail, duration
    for (std::size_t j = 0; j < i; ++j)
      if (fusions[j].oldest < fusions[i].youngest && fusions[j].beside(reading, fusions[i]))
        newer.push_back({fusions[j].tail, fusions[j].duration});
    std::sort(newer.begin(), newer.end());
    Ticks done = 0;
    for (const auto& [tail, duration] : newer) done = std::max(done, tail) + duration;
    fusions[i].tail = std::max(fusions[i].tail, done);
  }
}

// Whether one processor can fuse the lists of each node by then.
bool fused_in_order(const Reading& reading, const EndChains& end, const std::vector<Ticks>& youngest,
                    const std::vector<Ticks>& oldest) {
  std::vector<Fusion> fusions;
  for (std::size_t i = 0; i < end.chains.size(); ++i)
    if (auto fusion = fusion_of(reading, reading.problem.chains[end.chains[i]])) {
      fusion->youngest = youngest[i];
      fusion->oldest = oldest[i];
      fusions.push_back(*fusion);
    }
  std::stable_sort(fusions.begin(), fusions.end(),
                   [](const Fusion& a, const Fusion& b) { return a.oldest < b.oldest; });
  wait_for_newer(reading, fusions);
  for (const Fusion& first : fusions) {
    // Jackson's largest age is at most this one if each is at most its oldest.
    const Ticks latest = fusions.back().oldest;
    std::vector<Piece> pieces;
    for (const Fusion& one : fusions)
      if (one.activity == first.activity || one.beside(reading, first))
        pieces.push_back({one.tail, one.duration, one.head + latest - one.oldest});
    if (jackson(std::move(pieces)) > latest) return false;
  }
  return true;
}

bool of_one_period(const Problem& problem, const EndChains& end) {
  const Ticks period = problem.activities[problem.chains[end.chains.front()].activities.back()].period;
  return std::all_of(end.chains.begin(), end.chains.end(), [&](std::size_t chain) {
    const std::vector<std::size_t>& way = problem.chains[chain].activities;
    return std::all_of(way.begin(), way.end(),
                       [&](std::size_t activity) { return problem.activities[activity].period == period; });
  });
}

}  // namespace

Ticks least_worst_of(const Problem& problem, const std::vector<std::size_t>& chains, const std::vector<Ticks>& beyond) {
  constexpr Ticks kAny = Ticks{1} << 50;
  std::vector<Ticks> of_all(problem.chains.size(), -kAny);
  for (std::size_t i = 0; i < chains.size(); ++i) of_all[chains[i]] = beyond[i];
  return least_worst_age(problem, of_all);
}

bool attainable(const Reading& reading, const EndChains& end, std::int64_t tick_ps,
                const std::vector<Duration>& youngest, const std::vector<Duration>& oldest) {
  if (!of_one_period(reading.problem, end)) return true;
  std::vector<Ticks> from, to, beyond;
  for (const Duration age : youngest) from.push_back(age.ns * 1'000 / tick_ps);
  for (const Duration age : oldest) to.push_back((age.ns * 1'000 + tick_ps - 1) / tick_ps);
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] > end.largest_ages[i]) return false;
  const Ticks largest = *std::max_element(to.begin(), to.end());
  for (const Ticks age : to) beyond.push_back(largest - age);
  if (least_worst_of(reading.problem, end.chains, beyond) > largest) return false;
  return fused_in_order(reading, end, from, to);
}

}  // namespace ttf::schedules::synthesis::instants::judging
