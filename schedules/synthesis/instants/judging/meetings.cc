#include "schedules/synthesis/instants/judging/meetings.h"

#include <algorithm>
#include <numeric>

#include "core/check.h"
#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/grid.h"
#include "schedules/synthesis/instants/judging/attainable.h"
#include "schedules/synthesis/instants/written.h"

namespace ttf::schedules::synthesis::instants::judging {
namespace {

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
void wait_for_older(Meeting& meeting) {
  Duration latest = meeting.met.front().used;
  for (const int round : {0, 1})
    for (Met& one : meeting.met) {
      latest = std::max(latest, one.used + meeting.round * round);
      if (round == 1) one.used = latest - meeting.round;
    }
}

Meeting meeting_of(const End& end, const Problem& problem, std::int64_t tick_ps, const std::vector<Ticks>& offsets) {
  const Ticks every = problem.activities[end.activity].period;
  Ticks round = every;
  for (const std::size_t c : end.chains)
    round = std::lcm(round, problem.activities[problem.chains[c].activities.front()].period);
  Meeting meeting;
  meeting.round = duration_of(round, tick_ps);
  const Ticks first = modulo(offsets[end.activity], every);
  for (Ticks use = first; use < round; use += every) meeting.uses.push_back(duration_of(use, tick_ps));
  for (const std::size_t c : end.chains) {
    const Chain& chain = problem.chains[c];
    const std::size_t sensor = chain.activities.front();
    const Ticks period = problem.activities[sensor].period;
    for (Ticks at = modulo(offsets[sensor], period); at < round; at += period) {
      // The use is counted in whole rounds, so that it is one of `uses` to the nanosecond.
      const Ticks used = read_at(problem, chain, offsets, at);
      const Ticks within = modulo(used, round);
      const Duration of_round = meeting.uses[static_cast<std::size_t>((within - first) / every)];
      meeting.met.push_back({c, duration_of(at, tick_ps), of_round + meeting.round * ((used - within) / round)});
    }
  }
  std::stable_sort(meeting.met.begin(), meeting.met.end(),
                   [](const Met& a, const Met& b) { return a.measured < b.measured; });
  wait_for_older(meeting);
  return meeting;
}

}  // namespace

std::vector<Meeting> meetings(const plan::Plan& plan, const Problem& problem, std::int64_t tick_ps,
                              const std::vector<Ticks>& offsets) {
  std::vector<Meeting> found;
  for (const End& end : ends(plan, problem)) found.push_back(meeting_of(end, problem, tick_ps, offsets));
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

std::vector<Meeting> meetings(const plan::Plan& plan, const model::Cluster& cluster) {
  Candidate candidate{cluster.cycle(), {}, plan.payload ? 2 * cluster.flexray.gPayloadLengthStatic : 0, {}};
  for (const model::Sensor& sensor : cluster.sensors) candidate.repetitions.push_back(sensor.at.repetition);
  const auto read = read_of(plan, candidate);
  TTF_CHECK(read.has_value(), "a cluster of another plan");
  return meetings(plan, read->reading.problem, cluster.flexray.gdMacrotick_ps, offsets_of(*read, cluster));
}

double judged(const Judge& judge, const std::vector<double>& weights, const plan::Plan& plan,
              const model::Cluster& cluster) {
  return judge.of(meetings(plan, cluster), weights);
}

}  // namespace ttf::schedules::synthesis::instants::judging
