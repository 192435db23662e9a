#include "schedules/analysis/processor/busy_period.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/int128.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis::processor {
namespace {

constexpr int kMostRounds = 10'000;

// `work` is added in windows of length `window` or more.
struct Load {
  std::int64_t window = 0;
  std::int64_t work = 0;
};

// Returns the work that time activates from one instant on, or up to it, in windows up to `most`; by window.
std::vector<Load> timed_loads(const TaskChains& set, std::size_t instant, std::int64_t most,
                              TimedInstants::Direction direction) {
  std::vector<Load> loads;
  for (const TimedInstants::Neighbour& other : set.timed.within(instant, most, direction))
    loads.push_back({other.distance, set.chains[other.chain].work});
  std::sort(loads.begin(), loads.end(), [](const Load& a, const Load& b) { return a.window < b.window; });
  return loads;
}

std::int64_t timed_work(const TaskChains& set, std::int64_t window) {
  std::int64_t most = 0;
  for (std::size_t i = 0; i < set.timed.size(); ++i) {
    std::int64_t work = 0;
    for (const TimedInstants::Neighbour& other : set.timed.within(i, window, TimedInstants::kForward))
      work += set.chains[other.chain].work;
    most = std::max(most, work);
  }
  return most;
}

Int128 work_of(std::int64_t, const ByTime&, std::int64_t) { return 0; }
Int128 work_of(std::int64_t work, const ActivationBounds& by, std::int64_t window) {
  return static_cast<Int128>(work) * by.most(window);
}
// Counts the last activation in full, and of earlier ones the work that fits between the pauses.
Int128 work_of(std::int64_t work, const ByFollower& by, std::int64_t window) {
  if (window < by.shortest_round()) return work;
  return work + static_cast<Int128>(window) * by.worst / (by.worst + by.pause);
}

std::int64_t lead_of(Leads leads, std::size_t chain) { return leads.empty() ? 0 : leads[chain]; }

// Returns the work activated at any phase, cut at twice the longest busy time, which already means unbounded.
std::int64_t sporadic_work(const TaskChains& set, Leads leads, std::int64_t window) {
  Int128 work = 0;
  for (std::size_t c = 0; c < set.chains.size(); ++c) {
    const Chain& chain = set.chains[c];
    // A chain whose newest activation precedes the window's end by its lead has no activation in that time.
    const std::int64_t before = window - lead_of(leads, c);
    if (before >= 0)
      work += std::visit([&](const auto& by) { return work_of(chain.work, by, before); }, chain.activation);
  }
  return static_cast<std::int64_t>(std::min<Int128>(work, 2 * kLongestBusy_ns));
}

void add_steps(const ByTime&, std::int64_t, std::int64_t, std::vector<std::int64_t>&) {}
void add_steps(const ActivationBounds& by, std::int64_t lead, std::int64_t busy, std::vector<std::int64_t>& steps) {
  for (const ActivationBound& one : by.all)
    for (std::int64_t at = one.period - one.jitter % one.period; at <= busy; at += one.period)
      steps.push_back(lead + at);
}
// After its step, this work grows more slowly than the window.
void add_steps(const ByFollower& by, std::int64_t lead, std::int64_t, std::vector<std::int64_t>& steps) {
  steps.push_back(lead + by.shortest_round());
}

// Returns the window lengths at which sporadic work may increase: in order, from zero.
std::vector<std::int64_t> sporadic_steps(const TaskChains& set, Leads leads, std::int64_t busy) {
  std::vector<std::int64_t> steps{0};
  for (std::size_t c = 0; c < set.chains.size(); ++c) {
    const Chain& chain = set.chains[c];
    const std::int64_t lead = lead_of(leads, c);
    if (lead > 0 && !chain.by_time()) steps.push_back(lead);
    std::visit([&](const auto& by) { add_steps(by, lead, busy, steps); }, chain.activation);
  }
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  return steps;
}

// Returns the largest W(a) - a, given the work activated by time. It lies at a step of W.
std::int64_t latest(const TaskChains& set, Leads leads, const std::vector<std::int64_t>& steps,
                    const std::vector<Load>& timed) {
  std::int64_t worst = 0, timed_so_far = 0;
  auto step = steps.begin();
  auto load = timed.begin();
  while (step != steps.end() || load != timed.end()) {
    const bool sporadic_next = load == timed.end() || (step != steps.end() && *step <= load->window);
    const std::int64_t window = sporadic_next ? *step++ : load->window;
    for (; load != timed.end() && load->window <= window; ++load) timed_so_far += load->work;
    worst = std::max(worst, sporadic_work(set, leads, window) + timed_so_far - window);
  }
  return worst;
}

}  // namespace

std::int64_t ClockCorrections::shortest(std::int64_t global_ns) const {
  if (global_ns == 0) return 0;
  const std::int64_t by_rate = static_cast<std::int64_t>(static_cast<Int128>(global_ns) * rate / microticks) + 1;
  const std::int64_t by_offset = offset_ns * (global_ns / (2 * cycle_ns) + 1);
  return std::max<std::int64_t>(0, global_ns - by_rate - by_offset - model::kGranularity_ns);
}

TimedInstants::TimedInstants(std::vector<Instant> instants, std::int64_t round_ns,
                             std::optional<ClockCorrections> corrections)
    : instants_(std::move(instants)), round_ns_(round_ns), corrections_(corrections) {
  std::sort(instants_.begin(), instants_.end());
}

std::int64_t TimedInstants::shortest(std::int64_t global_ns) const {
  return corrections_ ? corrections_->shortest(global_ns) : global_ns;
}

bool TimedInstants::can_be_counted_on() const { return shortest(round_ns_) >= round_ns_ / 2; }

TimedInstants::Instant TimedInstants::numbered(std::int64_t number) const {
  const auto count = static_cast<std::int64_t>(instants_.size());
  std::int64_t round = number / count, place = number % count;
  if (place < 0) {
    --round;
    place += count;
  }
  Instant instant = instants_[static_cast<std::size_t>(place)];
  instant.at += round * round_ns_;
  return instant;
}

std::vector<TimedInstants::Neighbour> TimedInstants::within(std::size_t instant, std::int64_t most,
                                                            Direction direction) const {
  std::vector<Neighbour> neighbours;
  for (auto number = static_cast<std::int64_t>(instant);; number += direction == kForward ? 1 : -1) {
    const Instant other = numbered(number);
    const std::int64_t distance = shortest(std::abs(other.at - instants_[instant].at));
    if (distance > most) return neighbours;
    neighbours.push_back({distance, other.chain});
  }
}

std::optional<std::int64_t> busy_time(const TaskChains& set, std::int64_t limit) {
  if (!set.timed.empty() && !set.timed.can_be_counted_on()) return std::nullopt;
  // Iterates from below, so that the smallest solution is found first.
  std::int64_t window = 0;
  for (int rounds = 0; rounds < kMostRounds; ++rounds) {
    const std::int64_t work = sporadic_work(set, {}, window) + timed_work(set, window);
    if (work <= window) return window;
    if (work > limit) return std::nullopt;
    window = work;
  }
  return std::nullopt;
}

std::int64_t worst_chain_response(const TaskChains& set, std::size_t chain, std::int64_t busy, Leads leads) {
  const std::vector<std::int64_t> steps = sporadic_steps(set, leads, busy);
  if (set.timed.empty()) return latest(set, leads, steps, {});
  // A chain activated by time comes at its own instants, after the work of time up to them. Any other chain may
  // come just when time begins to activate the most work.
  const bool by_time = set.chains[chain].by_time();
  const auto direction = by_time ? TimedInstants::kBackward : TimedInstants::kForward;
  std::int64_t worst = 0;
  for (std::size_t i = 0; i < set.timed.size(); ++i)
    if (!by_time || set.timed.chain(i) == chain)
      worst = std::max(worst, latest(set, leads, steps, timed_loads(set, i, busy, direction)));
  return worst;
}

}  // namespace ttf::schedules::analysis::processor
