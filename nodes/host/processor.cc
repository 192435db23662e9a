#include "nodes/host/processor.h"

#include <algorithm>

#include "core/check.h"
#include "core/random.h"
#include "schedules/model/limits.h"

namespace ttf::nodes::host {

using schedules::model::ActivationKind;

Processor::Processor(const std::vector<schedules::model::Task>& tasks, const ExecutionKey& key, const NodeTime& time,
                     ExecutiveCounts& counts)
    : config_(tasks), key_(key), time_(time), counts_(counts), tasks_(tasks.size()) {
  ready_.reserve(tasks.size());
  for (std::size_t t = 0; t < tasks.size(); ++t)
    if (tasks[t].activation.kind == ActivationKind::kModes) tasks_[t].frames.emplace(tasks[t]);
  for (const schedules::model::Task& before : tasks)
    for (std::size_t t = 0; t < tasks.size(); ++t)
      if (tasks[t].activation.kind == ActivationKind::kCompletion && tasks[t].activation.after == before.name)
        tasks_[static_cast<std::size_t>(&before - tasks.data())].successors.push_back(t);
}

bool Processor::activate(std::size_t task, Microticks now) {
  State& state = tasks_[task];
  if (state.waiting) {
    ++counts_.overruns;
    return false;
  }
  state.waiting = true;
  state.activated = now;
  state.activated_at = time_.stamp(now);
  const auto later = std::find_if(ready_.begin(), ready_.end(), [&](std::size_t other) {
    return tasks_[other].activated > now || (tasks_[other].activated == now && other > task);
  });
  ready_.insert(later, task);
  return true;
}

void Processor::activate_after(std::size_t task, Microticks now) {
  for (const std::size_t successor : tasks_[task].successors) activate(successor, now);
}

void Processor::activate_armed(Microticks now) {
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    if (!tasks_[t].armed || time_.global()->start_of(config_[t].activation.at.offset) > now) continue;
    State& state = tasks_[t];
    state.armed = false;
    --armed_;
    if (state.frames) {
      const ModeTurn turn = state.frames->take();
      if (!state.waiting) state.turn = turn;
    }
    activate(t, now);
  }
}

void Processor::arm(std::int64_t cycle) {
  armed_ = 0;
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    const schedules::model::Activation& activation = config_[t].activation;
    State& state = tasks_[t];
    state.armed = activation.kind == ActivationKind::kTime ? in_cycle(activation.at, cycle)
                                                           : state.frames && state.frames->due_in(cycle);
    armed_ += state.armed ? 1 : 0;
  }
}

void Processor::disarm() {
  for (State& state : tasks_) {
    state.armed = false;
    if (state.frames) state.frames->forget();
  }
  armed_ = 0;
}

const Processor::Running* Processor::start_next(Microticks now) {
  if (busy_ || ready_.empty()) return nullptr;
  const std::size_t task = ready_.front();
  ready_.erase(ready_.begin());
  State& state = tasks_[task];
  state.waiting = false;
  busy_ = true;
  running_.task = task;
  running_.activation = state.activations++;
  running_.turn = state.frames ? std::optional(state.turn) : std::nullopt;
  running_start_ = now;
  running_.run = {};
  running_.run.start = time_.stamp(now);
  running_.run.task = static_cast<std::uint8_t>(task);
  running_.run.activated = state.activated_at;
  running_.run.deadline_met = true;
  set_end(state.frames ? state.frames->lasts(state.turn) : execution_time(task, running_.activation));
  return &running_;
}

void Processor::set_end(Duration lasts) {
  running_end_ = running_start_ + time_.ticks(lasts);
  const bool in_time = running_end_ - tasks_[running_.task].activated <= time_.ticks(config_[running_.task].deadline);
  if (running_.run.deadline_met && !in_time) ++counts_.deadlines_missed;
  if (!running_.run.deadline_met && in_time) --counts_.deadlines_missed;
  running_.run.deadline_met = in_time;
}

void Processor::choose_mode(std::size_t mode) {
  State& state = tasks_[running_.task];
  TTF_CHECK(running_.turn && running_.turn->place == 0 && mode < state.frames->modes(), "mode {} of task {}", mode,
            running_.task);
  state.frames->choose(mode);
  running_.turn->mode = mode;
  set_end(state.frames->lasts(*running_.turn));
}

const Processor::Running& Processor::finish(Microticks now) {
  busy_ = false;
  running_.run.end = time_.stamp(now);
  return running_;
}

Duration Processor::execution_time(std::size_t task, std::uint32_t activation) const {
  const schedules::model::Task& config = config_[task];
  if (config.draw == schedules::model::ExecutionDraw::kWorst) return config.worst_case;
  static_assert(schedules::model::kMostNamed * schedules::model::kMostTasks <= 1U << 16,
                "every task has a stream of its own");
  const auto entity = static_cast<std::uint16_t>(index_of(key_.node) * schedules::model::kMostTasks + task);
  RandomStream stream({key_.seed, key_.replication, Purpose::kExecutionTime, entity, activation});
  return Duration{stream.integer(config.best_case.ns, config.worst_case.ns)};
}

Microticks Processor::next_event() const {
  Microticks next = kNever<Microticks>;
  if (busy_)
    next = running_end_;
  else if (!ready_.empty())
    next = tasks_[ready_.front()].activated;
  if (armed_ == 0) return next;
  if (const timebase::CycleClock* global = time_.global())
    for (std::size_t t = 0; t < tasks_.size(); ++t)
      if (tasks_[t].armed) next = std::min(next, global->start_of(config_[t].activation.at.offset));
  return next;
}

Duration Processor::shortest(std::size_t task) const {
  return config_[task].draw == schedules::model::ExecutionDraw::kUniform ? config_[task].best_case
                                                                         : config_[task].worst_case;
}

}  // namespace ttf::nodes::host
