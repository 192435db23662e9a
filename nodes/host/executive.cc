#include "nodes/host/executive.h"

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "core/random.h"
#include "schedules/model/limits.h"

namespace ttf::nodes::host {
namespace {

constexpr Microticks kNever{std::numeric_limits<std::int64_t>::max()};
constexpr std::int64_t kNoCycle = -1;

}  // namespace

struct Executive::TaskState {
  const schedules::model::Task* task = nullptr;
  std::shared_ptr<Step> step;
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  std::vector<std::optional<std::uint32_t>> unread;  // per input: complete, not read yet
  std::uint32_t activations = 0;
  std::uint32_t measurement = 0;
  bool armed = false;  // activation by time, still due in this cycle
  bool waiting = false;
  Microticks activated{};  // of the waiting activation, which may come while the one before still runs
  recording::records::Stamp activated_at;
  recording::records::TaskRun run;  // that is going on
};

struct Executive::SensorState {
  SensorId id{};
  const schedules::model::Sensor* sensor = nullptr;
  bool is_device = false, is_host = false;
  bool runs_freely = false, follows = false;  // device
  std::size_t task = 0;                       // the device's measuring task
  std::uint32_t measured = 0;                 // device: measurements so far
  bool armed = false;                         // host: trigger still due in this cycle
  Duration phase{};                           // device, free-running: from power-on to the first measurement
  LocalTime first{};                          // likewise: the instant of that
  std::optional<Microticks> due;     // device, scheduled or following: measures then, at the first advance() from it on
  Microticks ready{};                // device that follows: not before this
  std::optional<std::size_t> after;  // host, of one that follows: the task whose end triggers
};

Executive::Executive(const ExecutiveConfig& config, std::vector<std::shared_ptr<Step>> steps,
                     bus::ports::FlexRayPort* flexray, std::vector<bus::ports::CanPort*> cans, SensorLines& lines,
                     recording::records::Sink& sink)
    : config_(config), cluster_(*config.cluster), node_(cluster_.node(config.node)), lines_(lines), sink_(sink),
      wants_frames_(sink.wants_frames()), strobes_(cluster_.sensors.size()) {
  TTF_CHECK(steps.size() == node_.tasks.size(), "{} steps for {} tasks", steps.size(), node_.tasks.size());
  if (node_.flexray) {
    TTF_CHECK(flexray != nullptr, "{} needs a FlexRay port", node_.name);
    flexray_ = std::make_unique<bus::controller::FlexRayController>(
        cluster_, config.node, *flexray, static_cast<bus::controller::ControllerEvents&>(*this));
    if (config.clock) flexray_->start_integrated(*config.clock);
  }
  asleep_ = flexray_ && !config.clock && config.cold == ColdStart::kSleeps;
  cans_.resize(cluster_.can_buses.size());
  for (std::size_t b = 0; b < cans_.size(); ++b)
    if (b < cans.size() && cans[b] != nullptr)
      cans_[b] = std::make_unique<bus::cni::CanController>(cluster_, config.node, b, *cans[b]);
  for (std::size_t t = 0; t < steps.size(); ++t) {
    TaskState state;
    state.task = &node_.tasks[t];
    state.step = std::move(steps[t]);
    for (const auto& binding : state.task->reads)
      state.inputs.push_back({binding.port, binding.pdu, &cluster_.pdu(binding.pdu), std::nullopt, false});
    state.unread.resize(state.inputs.size());
    for (const auto& binding : state.task->writes)
      state.outputs.emplace_back(binding.port, binding.pdu, cluster_.pdu(binding.pdu));
    tasks_.push_back(std::move(state));
  }
  ready_.reserve(tasks_.size());
  for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
    const schedules::model::Sensor& sensor = cluster_.sensors[s];
    SensorState state;
    state.id = static_cast<SensorId>(s);
    state.sensor = &sensor;
    state.is_device = sensor.device == config.node;
    state.is_host = sensor.host == config.node;
    if (!state.is_device && !state.is_host) continue;
    state.follows = state.is_device && sensor.follows();
    state.runs_freely = state.is_device && !sensor.scheduled && !sensor.follows();
    if (state.is_device) {
      const auto measuring =
          std::find_if(node_.tasks.begin(), node_.tasks.end(), [&](const schedules::model::Task& task) {
            return task.activation.kind == schedules::model::ActivationKind::kSensor &&
                   task.activation.sensor == state.id;
          });
      TTF_CHECK(measuring != node_.tasks.end(), "{} has no measuring task for {}", node_.name, sensor.name);
      state.task = static_cast<std::size_t>(measuring - node_.tasks.begin());
      if (!sensor.scheduled) {
        RandomStream phase({config.seed, config.replication, Purpose::kSensorPhase, static_cast<std::uint16_t>(s), 0});
        state.phase = sensor.phase ? *sensor.phase : Duration{phase.integer(0, sensor.period.ns - 1)};
      }
    }
    if (state.is_host && sensor.follows()) {
      const auto after = std::find_if(node_.tasks.begin(), node_.tasks.end(),
                                      [&](const schedules::model::Task& task) { return task.name == sensor.after; });
      TTF_CHECK(after != node_.tasks.end(), "{} has no task {} for {}", node_.name, sensor.after, sensor.name);
      state.after = static_cast<std::size_t>(after - node_.tasks.begin());
    }
    sensors_.push_back(state);
  }
  if (!asleep_) rise(config.power_on);
  arm_cycle();
  look_ahead();
}

Executive::~Executive() = default;

recording::records::Stamp Executive::stamp(Microticks at) const {
  recording::records::Stamp stamp;
  stamp.true_time = config_.oscillator.time_of(at);
  if (config_.true_clock != nullptr) stamp.true_time = std::max(stamp.true_time, config_.true_clock->now());
  stamp.local = config_.oscillator.local_time(at);
  // A node that knows no global time has only its own.
  stamp.global = clock() != nullptr ? clock()->global_time(at) : GlobalTime{stamp.local.ns};
  stamp.node = config_.node;
  return stamp;
}

Microticks Executive::ticks(Duration duration) const {
  const std::int64_t period = config_.oscillator.nominal_period_ps();
  return {(duration.ns * 1000 + period - 1) / period};
}

void Executive::rise(Microticks now) {
  for (SensorState& state : sensors_) {
    state.first = config_.oscillator.local_time(now) + state.phase;
    if (state.follows) state.due = ticks(state.first - LocalTime{});
  }
  if (!flexray_ || config_.clock) return;
  waking_ = config_.cold == ColdStart::kWakes;
  if (!waking_) return flexray_->start_cold(now);
  for (const auto command :
       {bus::poc::PocEventKind::kConfig, bus::poc::PocEventKind::kConfigComplete, bus::poc::PocEventKind::kWakeup})
    flexray_->command(command, now);
}

void Executive::start_anew(Microticks now) {
  flexray_->start_cold(now);
  arm_cycle();
  look_ahead();
}

// However the wake-up ended, its host lets the controller start up then.
void Executive::start_up_after_waking(Microticks now) {
  if (!waking_ || flexray_->state().kind != bus::poc::PocKind::kReady) return;
  waking_ = false;
  if (node_.flexray->pKeySlotUsedForStartup) flexray_->command(bus::poc::PocEventKind::kAllowColdstart, now);
  flexray_->command(bus::poc::PocEventKind::kRun, now);
}

Microticks Executive::next_event() const {
  if (asleep_) return rises_.value_or(kNever);
  return flexray_ ? std::min(own_next_, flexray_->next_event()) : own_next_;
}

void Executive::look_ahead() {
  concerned_ = false;
  Microticks next = running_ ? running_end_ : kNever;
  if (!running_ && !ready_.empty()) next = tasks_[ready_.front()].activated;
  if (const timebase::CycleClock* global = clock()) {
    for (const TaskState& state : tasks_)
      if (state.armed) next = std::min(next, global->start_of(state.task->activation.at.offset));
    for (const SensorState& state : sensors_)
      if (state.armed) next = std::min(next, global->start_of(state.sensor->at.offset));
  }
  for (const SensorState& state : sensors_) {
    if (state.due) next = std::min(next, *state.due);
    if (state.runs_freely)
      next = std::min(next, ticks((state.first - LocalTime{}) + state.sensor->period * state.measured));
  }
  own_next_ = next;
}

Promise Executive::promise() const {
  Promise promise{next_event(), kNever, soonest_end(true), kNever};
  if (flexray_) promise.after_flexray = asleep_ || flexray_->answers_at_once() ? Microticks{} : soonest_end(false);
  for (const SensorState& state : sensors_)
    if (state.is_device && !state.runs_freely) promise.after_trigger = Microticks{};
  return promise;
}

Microticks Executive::soonest_end(bool on_can) const {
  Microticks soonest = kNever;
  for (const TaskState& state : tasks_) {
    const schedules::model::Task& task = *state.task;
    if (task.activation.kind != schedules::model::ActivationKind::kMessage) continue;
    const bool set_off =
        std::any_of(task.reads.begin(), task.reads.end(), [&](const schedules::model::PortBinding& port) {
          return activates(task, port) && port.medium.is_can() == on_can;
        });
    const bool drawn = task.draw == schedules::model::ExecutionDraw::kUniform;
    if (set_off) soonest = std::min(soonest, ticks(drawn ? task.best_case : task.worst_case));
  }
  return soonest;
}

// Who loses the global time loses what was to happen by it.
void Executive::arm_cycle() {
  const timebase::CycleClock* global = clock();
  const std::int64_t cycle = global != nullptr ? global->cycle() : kNoCycle;
  if (cycle == armed_cycle_) return;
  armed_cycle_ = cycle;
  for (TaskState& state : tasks_)
    state.armed = global != nullptr && state.task->activation.kind == schedules::model::ActivationKind::kTime &&
                  in_cycle(state.task->activation.at, armed_cycle_);
  for (SensorState& state : sensors_)
    state.armed =
        global != nullptr && state.is_host && state.sensor->scheduled && in_cycle(state.sensor->at, armed_cycle_);
}

void Executive::advance(Microticks now) {
  if (asleep_) {
    if (!rises_ || *rises_ > now) return;
    asleep_ = false;
    concerned_ = true;
    sink_.on(recording::records::PowerChanged{stamp(now), true});
    rise(now);
  }
  concerned_ |= own_next_ <= now;
  if (running_ && running_end_ <= now) finish(now);
  if (flexray_) {
    flexray_->advance(now);
    start_up_after_waking(now);
  }
  // As a rule the controller had a frame to send, and nobody else anything to do.
  if (!concerned_) return;
  arm_cycle();
  activate_due(now);
  start_next(now);
  look_ahead();
}

void Executive::activate_due(Microticks now) {
  for (SensorState& state : sensors_) {
    if (state.armed && clock()->start_of(state.sensor->at.offset) <= now) {
      state.armed = false;
      lines_.trigger(state.id);
    }
    const bool by_itself =
        state.runs_freely && ticks((state.first - LocalTime{}) + state.sensor->period * state.measured) <= now;
    const bool due = state.due && *state.due <= now;
    if (due) state.due.reset();
    if (by_itself || due) measure(state, now);
  }
  for (std::size_t t = 0; t < tasks_.size(); ++t)
    if (tasks_[t].armed && clock()->start_of(tasks_[t].task->activation.at.offset) <= now) {
      tasks_[t].armed = false;
      activate(t, now);
    }
}

void Executive::measure(SensorState& sensor, Microticks now) {
  tasks_[sensor.task].measurement = sensor.measured;
  lines_.strobe(sensor.id, sensor.measured);
  ++sensor.measured;
  if (sensor.follows) {
    sensor.ready = now + ticks(sensor.sensor->period);
    sensor.due = now + ticks(sensor.sensor->longest);
  }
  activate(sensor.task, now);
}

void Executive::trigger(SensorId sensor, Microticks now) {
  if (asleep_) return;
  for (SensorState& state : sensors_)
    if (state.id == sensor && state.is_device) state.due = state.follows ? std::max(now, state.ready) : now;
  look_ahead();
}

void Executive::strobe(SensorId sensor, std::uint32_t sequence, Microticks now) {
  // Without global time there is no time of measuring: as if the strobe had not been seen.
  const timebase::CycleClock* global = clock();
  if (global == nullptr) return;
  // In real time a strobe may be heard of when the cycle that it came in is over.
  const Microticks since = std::max(now, global->cycle_start());
  strobes_[index_of(sensor)].strobe(
      sequence,
      global->global_time(since) - Duration{(since - now).value * config_.oscillator.nominal_period_ps() / 1000});
}

void Executive::activate(std::size_t task, Microticks now) {
  TaskState& state = tasks_[task];
  if (state.waiting) {
    ++counts_.overruns;
    return;
  }
  concerned_ = true;
  state.waiting = true;
  state.activated = now;
  state.activated_at = stamp(now);
  const auto later = std::find_if(ready_.begin(), ready_.end(), [&](std::size_t other) {
    return tasks_[other].activated > now || (tasks_[other].activated == now && other > task);
  });
  ready_.insert(later, task);
}

void Executive::fill_inputs(TaskState& task) {
  for (std::size_t i = 0; i < task.inputs.size(); ++i) {
    const schedules::model::PortBinding& binding = task.task->reads[i];
    bus::cni::IncomingList& list = incoming(binding);
    Input& input = task.inputs[i];
    input.list = list.latest();
    input.fresh = list.mark_read();
    input.discarded = false;
    task.unread[i].reset();
    if (input.fresh)
      hop(task.run.start, recording::records::Hop::kRead, binding.pdu, input.list->sequence, binding.medium.number());
  }
}

void Executive::start_next(Microticks now) {
  while (!running_ && !ready_.empty()) {
    const std::size_t index = ready_.front();
    ready_.erase(ready_.begin());
    TaskState& state = tasks_[index];
    state.waiting = false;
    state.run = {};
    state.run.start = stamp(now);
    state.run.task = static_cast<std::uint8_t>(index);
    state.run.activated = state.activated_at;
    fill_inputs(state);
    StepContext context;
    context.stamp = state.run.start;
    context.activation = state.activations;
    context.measurement = state.measurement;
    context.global_time = clock() != nullptr;
    context.inputs = state.inputs;
    context.outputs = state.outputs;
    context.strobes = strobes_;
    context.sink = &sink_;
    state.step->run(context);
    counts_.unlisted_fates += context.unlisted;
    for (std::size_t i = 0; i < state.inputs.size(); ++i) {
      const Input& input = state.inputs[i];
      if (!input.discarded) continue;
      ++counts_.discarded_lists;
      hop(state.run.start, recording::records::Hop::kDiscarded, input.pdu, input.list->sequence,
          state.task->reads[i].medium.number());
    }

    Duration execution = state.task->worst_case;
    if (state.task->draw == schedules::model::ExecutionDraw::kUniform) {
      static_assert(schedules::model::kMostNamed * schedules::model::kMostTasks <= 1U << 16,
                    "every task has a stream of its own");
      const auto entity = static_cast<std::uint16_t>(index_of(config_.node) * schedules::model::kMostTasks + index);
      RandomStream stream({config_.seed, config_.replication, Purpose::kExecutionTime, entity, state.activations});
      execution = Duration{stream.integer(state.task->best_case.ns, state.task->worst_case.ns)};
    }
    ++state.activations;
    running_ = index;
    running_end_ = now + ticks(execution);
    state.run.deadline_met = running_end_ - state.activated <= ticks(state.task->deadline);
    if (!state.run.deadline_met) ++counts_.deadlines_missed;
    if (running_end_ <= now) finish(now);
  }
}

void Executive::finish(Microticks now) {
  const std::size_t ended = *running_;
  TaskState& state = tasks_[ended];
  running_.reset();
  state.run.end = stamp(now);
  for (std::size_t o = 0; o < state.outputs.size(); ++o) {
    Output& output = state.outputs[o];
    counts_.saturated_signals += static_cast<std::uint64_t>(output.take_saturated());
    if (!output.written()) continue;
    const schedules::model::MediumId medium = state.task->writes[o].medium;
    hop(state.run.end, recording::records::Hop::kWritten, output.pdu(), output.view().sequence, medium.number());
    if (medium.is_can())
      cans_[medium.can_index()]->send(output.pdu(), output.view());
    else
      flexray_->outgoing(output.pdu()).write(output.view());
    output.clear();
  }
  sink_.on(state.run);
  for (std::size_t t = 0; t < tasks_.size(); ++t)
    if (tasks_[t].task->activation.kind == schedules::model::ActivationKind::kCompletion &&
        tasks_[t].task->activation.after == state.task->name)
      activate(t, now);
  for (const SensorState& sensor : sensors_)
    if (sensor.after == ended && !state.waiting) lines_.trigger(sensor.id);
}

bus::cni::IncomingList& Executive::incoming(const schedules::model::PortBinding& binding) {
  return binding.medium.is_can() ? cans_[binding.medium.can_index()]->incoming(binding.pdu)
                                 : flexray_->incoming(binding.pdu);
}

void Executive::receive(const bus::ports::Reception& reception) {
  if (asleep_) {
    if (reception.signal == bus::ports::Signal::kWakeup && !rises_) rises_ = reception.end + ticks(config_.boots);
    return;
  }
  flexray_->receive(reception);
  start_up_after_waking(reception.end);
  if (concerned_) look_ahead();
}

bool Executive::receive_on_both(const bus::ports::Reception& reception) {
  if (asleep_) {
    receive(reception);
    return true;
  }
  const bool changed = flexray_->receive_on_both(reception);
  if (changed) start_up_after_waking(reception.end);
  if (!changed && !concerned_) return false;
  look_ahead();
  return true;
}

void Executive::receive_can(std::size_t can_bus, const bus::ports::CanFrame& frame, Microticks now) {
  if (!cans_[can_bus] || asleep_) return;
  if (const auto arrival = cans_[can_bus]->receive(frame))
    arrived(arrival->pdu, static_cast<int>(can_bus), arrival->effect, arrival->sequence, arrival->torn, now);
  else
    ++counts_.refused_can_frames;
  if (concerned_) look_ahead();
}

void Executive::list_arrived(PduId pdu, bus::cni::ArrivalEffect effect, std::uint32_t sequence,
                             std::optional<std::uint32_t> torn, Microticks at) {
  arrived(pdu, -1, effect, sequence, torn, at);
}

void Executive::arrived(PduId pdu, int can_bus, bus::cni::ArrivalEffect effect, std::uint32_t sequence,
                        std::optional<std::uint32_t> torn, Microticks at) {
  using enum bus::cni::ArrivalEffect;
  if (effect == kStale || effect == kMalformed) ++counts_.refused_fragments;
  // One fragment may end two lists: the one it tears, and its own if that is complete with it.
  if (!torn && effect != kCompleted && effect != kStale) return;
  const recording::records::Stamp stamp_at = stamp(at);
  bool reported = false;  // once per arrival, however many tasks read it; never where nobody does
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    TaskState& state = tasks_[t];
    for (std::size_t i = 0; i < state.inputs.size(); ++i) {
      const schedules::model::PortBinding& binding = state.task->reads[i];
      if (binding.pdu != pdu || binding.medium.number() != can_bus) continue;
      if (!reported && torn) {
        ++counts_.torn_lists;
        hop(stamp_at, recording::records::Hop::kTorn, pdu, *torn, can_bus);
      }
      if (!reported && effect == kCompleted) hop(stamp_at, recording::records::Hop::kReceived, pdu, sequence, can_bus);
      if (!reported && effect == kStale) hop(stamp_at, recording::records::Hop::kStale, pdu, sequence, can_bus);
      reported = true;
      if (effect != kCompleted) continue;
      if (state.unread[i]) {
        ++counts_.overwritten_lists;
        hop(stamp_at, recording::records::Hop::kOverwritten, pdu, *state.unread[i], can_bus);
      }
      state.unread[i] = sequence;
      if (activates(*state.task, binding)) activate(t, at);
    }
  }
}

}  // namespace ttf::nodes::host
