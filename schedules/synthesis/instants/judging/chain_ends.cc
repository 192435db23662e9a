#include "schedules/synthesis/instants/judging/chain_ends.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "core/check.h"
#include "core/time.h"
#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/instants/grid.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/instants/written.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants::judging {
namespace {

// Chains that end with one task.
struct EndChains {
  std::vector<std::size_t> chains;  // at least one
  std::vector<Ticks> largest_ages;  // by these chains
};

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

// Returns the least worst age of these chains, with so much added to each.
Ticks least_worst_of(const Problem& problem, const std::vector<std::size_t>& chains, const std::vector<Ticks>& beyond) {
  constexpr Ticks kAny = Ticks{1} << 50;
  std::vector<Ticks> of_all(problem.chains.size(), -kAny);
  for (std::size_t i = 0; i < chains.size(); ++i) of_all[chains[i]] = beyond[i];
  return least_worst_age(problem, of_all);
}

// Returns false if no instants have ages at first use between these, both included, by chain. Where a chain has several
// periods, nothing is ruled out: one measurement may be used late, and the next one soon.
//
// Chains wait for each other on processors and the static segment (least_worst_age). Lists that one processor fuses
// wait in the order of their measurements (Plan::in_order): looked at backwards from the use, a list's fusion begins
// where those of all newer lists have ended. Where ages lie apart, this order is known. The rest is Jackson's
// preemptive schedule of the fusions (bounds.h).
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

// A task that ends chains, and the chains.
struct End {
  std::size_t activity = 0;
  std::vector<std::size_t> chains;
};

std::vector<End> ends(const plan::Plan& plan, const Problem& problem) {
  std::vector<End> found;
  for (std::size_t c = 0; c < problem.chains.size(); ++c) {
    // Odometry measures its own vehicle, no object.
    if (!model::row_of(plan.cluster.sensor(plan.chains[c].from).kind).observes) continue;
    const std::size_t last = problem.chains[c].activities.back();
    auto end = std::find_if(found.begin(), found.end(), [&](const End& one) { return one.activity == last; });
    if (end == found.end()) end = found.insert(end, {last, {}});
    const bool known = std::any_of(end->chains.begin(), end->chains.end(),
                                   [&](std::size_t other) { return plan.chains[other].from == plan.chains[c].from; });
    if (!known) end->chains.push_back(c);
  }
  return found;
}

Duration duration_of(Ticks count, std::int64_t tick_ps) { return {count * tick_ps / 1'000}; }

// A list waits for older ones: no measurement is used before an older one.
void wait_for_older(ChainEnd& chain_end) {
  Duration latest = chain_end.first_uses.front().used;
  for (const int round : {0, 1})
    for (FirstUse& one : chain_end.first_uses) {
      latest = std::max(latest, one.used + chain_end.round * round);
      if (round == 1) one.used = latest - chain_end.round;
    }
}

ChainEnd chain_end_of(const End& end, const Problem& problem, std::int64_t tick_ps, const std::vector<Ticks>& offsets) {
  const Ticks every = problem.activities[end.activity].period;
  Ticks round = every;
  for (const std::size_t c : end.chains)
    round = std::lcm(round, problem.activities[problem.chains[c].activities.front()].period);
  ChainEnd chain_end;
  chain_end.round = duration_of(round, tick_ps);
  const Ticks first = modulo(offsets[end.activity], every);
  for (Ticks use = first; use < round; use += every) chain_end.uses.push_back(duration_of(use, tick_ps));
  for (const std::size_t c : end.chains) {
    const Chain& chain = problem.chains[c];
    const std::size_t sensor = chain.activities.front();
    const Ticks period = problem.activities[sensor].period;
    for (Ticks at = modulo(offsets[sensor], period); at < round; at += period) {
      // The use is counted in whole rounds, so that it is one of `uses` to the nanosecond.
      const Ticks used = read_at(problem, chain, offsets, at);
      const Ticks within = modulo(used, round);
      const Duration of_round = chain_end.uses[static_cast<std::size_t>((within - first) / every)];
      chain_end.first_uses.push_back(
          {c, duration_of(at, tick_ps), of_round + chain_end.round * ((used - within) / round)});
    }
  }
  std::stable_sort(chain_end.first_uses.begin(), chain_end.first_uses.end(),
                   [](const FirstUse& a, const FirstUse& b) { return a.measured < b.measured; });
  wait_for_older(chain_end);
  return chain_end;
}

}  // namespace

std::vector<ChainEnd> chain_ends(const plan::Plan& plan, const Problem& problem, std::int64_t tick_ps,
                                 const std::vector<Ticks>& offsets) {
  std::vector<ChainEnd> found;
  for (const End& end : ends(plan, problem)) found.push_back(chain_end_of(end, problem, tick_ps, offsets));
  return found;
}

std::vector<Prospect> prospects(const plan::Plan& plan, const Reading& reading, const Limits& limits,
                                std::int64_t tick_ps) {
  const Problem& problem = reading.problem;
  const std::vector<Ticks> least = least_ages(problem);
  std::vector<Prospect> found;
  for (const End& end : ends(plan, problem)) {
    Prospect prospect;
    prospect.every = duration_of(problem.activities[end.activity].period, tick_ps);
    for (const std::size_t c : end.chains) {
      const Ticks period = problem.activities[problem.chains[c].activities.front()].period;
      prospect.coming.push_back({c, duration_of(period, tick_ps), duration_of(least[c], tick_ps)});
    }
    prospect.least_worst_age =
        duration_of(least_worst_of(problem, end.chains, std::vector<Ticks>(end.chains.size())), tick_ps);
    EndChains of_end{end.chains, {}};
    for (const std::size_t c : end.chains) of_end.largest_ages.push_back(limit_of(problem, limits, c));
    prospect.attainable = [&reading, of_end, tick_ps](const auto& youngest, const auto& oldest) {
      return attainable(reading, of_end, tick_ps, youngest, oldest);
    };
    found.push_back(std::move(prospect));
  }
  return found;
}

std::vector<ChainEnd> chain_ends(const plan::Plan& plan, const model::Cluster& cluster) {
  Candidate candidate{cluster.cycle(), {}, plan.payload ? 2 * cluster.flexray.gPayloadLengthStatic : 0, {}};
  for (const model::Sensor& sensor : cluster.sensors) candidate.repetitions.push_back(sensor.at.repetition);
  const auto read = read_of(plan, candidate);
  TTF_CHECK(read.has_value(), "a cluster of another plan");
  return chain_ends(plan, read->reading.problem, cluster.flexray.gdMacrotick_ps, offsets_of(*read, cluster));
}

double judged(const Judge& judge, const std::vector<double>& weights, const plan::Plan& plan,
              const model::Cluster& cluster) {
  return judge.of(chain_ends(plan, cluster), weights);
}

}  // namespace ttf::schedules::synthesis::instants::judging
