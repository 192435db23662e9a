#include "schedules/timing/task_set/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "core/int128.h"
#include "core/time.h"
#include "schedules/timing/chain/stage.h"
#include "schedules/timing/chain/timetable.h"
#include "schedules/timing/response/simulation.h"
#include "schedules/timing/task_set/fields.h"

namespace ttf::schedules::timing::task_set {
namespace {

// The earliest start and the latest end of all jobs of a processor with preemptive fixed priorities, where all offsets
// are known: the jobs of a hyperperiod, simulated with best and with worst cases (schedules/timing/response/simulation.h).
struct PeriodicTask {
  Duration period{}, offset{};
  Duration best{}, worst{};
};

struct SimulatedJobs {
  Duration hyperperiod{};
  std::vector<std::vector<chain::Job>> jobs;  // for each task those of one hyperperiod
};

constexpr std::int64_t kMostSimulated = 400'000;  // jobs in two hyperperiods

std::vector<response::PeriodicWork> as_works(std::span<const PeriodicTask> tasks, Duration PeriodicTask::*work) {
  std::vector<response::PeriodicWork> works;
  for (const PeriodicTask& task : tasks)
    works.push_back({.period = task.period.ns, .offset = task.offset.ns, .work = (task.*work).ns});
  return works;
}

// Takes the tasks by priority, the highest first. Returns none if the load exceeds one, the jobs exceed kMostSimulated
// or the hyperperiod exceeds a quarter of chain::kLongest.
std::optional<SimulatedJobs> simulated_jobs(std::span<const PeriodicTask> by_priority) {
  const auto at_worst = as_works(by_priority, &PeriodicTask::worst);
  // The last ends are less than two hyperperiods later.
  const auto hyperperiod = response::simulated_hyperperiod(at_worst, chain::kLongest.ns / 4, kMostSimulated);
  if (!hyperperiod) return std::nullopt;
  SimulatedJobs found{.hyperperiod = Duration{*hyperperiod}, .jobs = {}};
  for (const PeriodicTask& task : by_priority)
    found.jobs.emplace_back(static_cast<std::size_t>(*hyperperiod / task.period.ns));
  const auto place = [&](const response::EndedJob& job) -> chain::Job& {
    return found.jobs[job.task][static_cast<std::size_t>(job.release / by_priority[job.task].period.ns)];
  };
  response::simulate_jobs(as_works(by_priority, &PeriodicTask::best), *hyperperiod,
                          [&](const response::EndedJob& job) { place(job).reads = Duration{job.start}; });
  response::simulate_jobs(at_worst, *hyperperiod,
                          [&](const response::EndedJob& job) { place(job).writes = Duration{job.end}; });
  return found;
}

constexpr Duration kLongestSum{chain::kLongest.ns / 2};  // offsets and periods come on top of the responses

class Stages {
 public:
  Stages(const TaskSet& set, const Responses& responses)
      : set_(set), responses_(responses), simulated_(set.resources.size()), rank_(set.tasks.size()) {
    for (std::size_t r = 0; r < set.resources.size(); ++r) {
      origins_.try_emplace(set.resources[r].clock, origins_.size());
      const std::vector<std::size_t>& order = responses.resources[r].by_priority;
      for (std::size_t p = 0; p < order.size(); ++p) rank_[order[p]] = p;
      simulate(r);
    }
  }

  // Returns why a stage has no times, or an empty text.
  std::string why_none(std::size_t t) const {
    const Task& task = set_.tasks[t];
    if (!responses_.resources[task.resource].overlap.empty())
      return fmt::format("jobs overlap on {}", set_.resources[task.resource].name);
    if (!responses_.tasks[t].bounded()) return fmt::format("no bound found for the response of {}", task.name);
    if (task.communication == Communication::kLet && !keeps_deadline(set_, responses_, t))
      return fmt::format("{} may not have ended when it is to write", task.name);
    return "";
  }

  // Returns whether the responses of the stages, each of which is bounded, are too long to add up.
  bool too_long(const std::vector<std::size_t>& stages) const {
    Int128 sum = 0;
    for (const std::size_t t : stages) sum += responses_.tasks[t].response.longest;
    return sum > kLongestSum.ns;
  }

  // The stage at place `s` of a chain.
  chain::Stage stage(const std::vector<std::size_t>& stages, std::size_t s) const {
    const std::size_t t = stages[s];
    const Task& task = set_.tasks[t];
    const bool activates = s + 1 < stages.size() && set_.tasks[stages[s + 1]].is_event();
    if (task.is_event()) return activated(t, s == 0);
    chain::Stage stage = periodic(t, activates);
    if (task.offset) stage.origin = origins_.at(set_.resources[task.resource].clock);
    stage.behind_sender = s > 0 && is_behind(t, stages[s - 1]);
    return stage;
  }

 private:
  bool is_alone(std::size_t t) const { return responses_.resources[set_.tasks[t].resource].by_priority.size() == 1; }

  // A first stage has whatever jitter its events have: it ends its whole response behind each at most.
  chain::Stage activated(std::size_t t, bool first) const {
    const Task& task = set_.tasks[t];
    const TaskTiming& timing = responses_.tasks[t];
    const Duration longest = Duration{timing.response.longest} - (first ? Duration{} : timing.jitter);
    return chain::activated_stage(task.name, longest,
                                  is_alone(t) && timing.jitter == Duration{} && longest == task.worst);
  }

  chain::Stage periodic(std::size_t t, bool activates) const {
    const Task& task = set_.tasks[t];
    const Duration period = *task.period;
    if (task.communication == Communication::kLet)
      return chain::let_stage(task.name, period, task.offset, *task.deadline);
    if (set_.resources[task.resource].policy == Policy::kTable)
      return chain::let_stage(task.name, period, task.offset, task.worst);
    const std::optional<SimulatedJobs>& simulated = simulated_[task.resource];
    if (!simulated || activates) {  // a task that it activates counts from its longest response
      const Duration response{responses_.tasks[t].response.longest};
      chain::Stage stage = chain::sampled_stage(task.name, period, task.offset, response);
      stage.exact = is_alone(t) && task.jitter == Duration{} && response == task.worst;
      return stage;
    }
    chain::Stage stage;
    stage.name = task.name;
    stage.cycle = simulated->hyperperiod;
    stage.jobs = simulated->jobs[rank_[t]];
    const std::vector<std::size_t>& order = responses_.resources[task.resource].by_priority;
    stage.exact = is_alone(t) ||
                  std::all_of(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(rank_[t]) + 1,
                              [&](std::size_t other) { return set_.tasks[other].best == set_.tasks[other].worst; });
    return stage;
  }

  void simulate(std::size_t r) {
    if (set_.resources[r].policy != Policy::kPreemptive) return;
    std::vector<PeriodicTask> tasks;
    for (const std::size_t t : responses_.resources[r].by_priority) {
      const Task& task = set_.tasks[t];
      if (!task.offset || task.jitter != Duration{}) return;
      tasks.push_back({.period = *task.period, .offset = *task.offset, .best = task.best, .worst = task.worst});
    }
    simulated_[r] = simulated_jobs(tasks);
  }

  // Whether no earlier release of the sender is pending whenever the task starts (chain::Stage::behind_sender).
  bool is_behind(std::size_t t, std::size_t sender) const {
    const Task& task = set_.tasks[t];
    const Task& before = set_.tasks[sender];
    const Policy policy = set_.resources[task.resource].policy;
    return before.resource == task.resource && (policy == Policy::kPreemptive || policy == Policy::kNonPreemptive) &&
           !task.is_message && task.communication == Communication::kImplicit &&
           before.communication == Communication::kImplicit && before.jitter == Duration{} && rank_[sender] < rank_[t];
  }

  const TaskSet& set_;
  const Responses& responses_;
  std::map<std::string, std::size_t> origins_;  // of clocks
  std::vector<std::optional<SimulatedJobs>> simulated_;
  std::vector<std::size_t> rank_;  // on its resource, by priority
};

// Returns the times of the chains in the set's order.
std::vector<ChainTiming> chain_times(const TaskSet& set, const Responses& responses) {
  const Stages maker(set, responses);
  std::vector<ChainTiming> found;
  for (const Chain& chain : set.chains) {
    ChainTiming& timing = found.emplace_back();
    std::vector<chain::Stage> stages;
    for (std::size_t s = 0; s < chain.stages.size() && timing.why_none.empty(); ++s) {
      timing.why_none = maker.why_none(chain.stages[s]);
      if (timing.why_none.empty()) stages.push_back(maker.stage(chain.stages, s));
    }
    if (timing.why_none.empty() && maker.too_long(chain.stages)) timing.why_none = "its responses sum up to days";
    if (timing.why_none.empty()) timing.times = chain::end_to_end(stages);
  }
  return found;
}

void judge_resource(const TaskSet& set, std::size_t r, Verdict& verdict) {
  const ResourceTiming& here = verdict.responses.resources[r];
  if (here.overlap.empty()) return;
  const std::string& first = set.tasks[here.overlap[0]].name;
  const std::string& second = set.tasks[here.overlap[1]].name;
  verdict.misses.push_back(first == second
                               ? fmt::format("{}: {} takes longer than its period", set.resources[r].name, first)
                               : fmt::format("{}: {} and {} overlap", set.resources[r].name, first, second));
}

void judge_task(const TaskSet& set, std::size_t t, Verdict& verdict) {
  const Task& task = set.tasks[t];
  const response::Response& found = verdict.responses.tasks[t].response;
  if (keeps_deadline(set, verdict.responses, t)) return;
  if (!verdict.responses.resources[task.resource].overlap.empty()) return;  // said once
  verdict.misses.push_back(found.bounded()
                               ? fmt::format("{}: a response of {} misses its deadline of {}", task.name,
                                             duration_words(Duration{found.longest}), duration_words(*task.deadline))
                               : fmt::format("{}: no bound found for its response", task.name));
}

void judge_chain(const Chain& chain, const ChainTiming& timing, Verdict& verdict) {
  if (!timing.times) {
    verdict.misses.push_back(fmt::format("{}: no times: {}", chain.name, timing.why_none));
  } else if (!keeps_age(chain, timing)) {
    const std::string largest = duration_words(*chain.largest_age);
    verdict.misses.push_back(
        timing.times->age
            ? fmt::format("{}: data may be {} old, more than {}", chain.name, duration_words(timing.times->age->time),
                          largest)
            : fmt::format("{}: data have no largest age, as events begin it; the limit is {}", chain.name, largest));
  }
}

}  // namespace

bool ignores_errors(const TaskSet& set, const Chain& chain) {
  return std::ranges::any_of(chain.stages,
                             [&](std::size_t t) { return set.resources[set.tasks[t].resource].errors_per_s > 0; });
}

bool keeps_age(const Chain& chain, const ChainTiming& timing) {
  if (!chain.largest_age) return true;
  return timing.times && timing.times->age && timing.times->age->time <= *chain.largest_age;
}

Verdict verdict_on(const TaskSet& set) {
  Verdict verdict{.responses = responses_of(set), .chains = {}, .misses = {}};
  verdict.chains = chain_times(set, verdict.responses);
  for (std::size_t r = 0; r < set.resources.size(); ++r) judge_resource(set, r, verdict);
  for (std::size_t t = 0; t < set.tasks.size(); ++t) judge_task(set, t, verdict);
  for (std::size_t c = 0; c < set.chains.size(); ++c) judge_chain(set.chains[c], verdict.chains[c], verdict);
  return verdict;
}

}  // namespace ttf::schedules::timing::task_set
