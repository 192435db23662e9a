#include "nodes/host/executive.h"

#include <algorithm>
#include <utility>

#include "bus/wire/symbols.h"
#include "core/check.h"

namespace ttf::nodes::host {
namespace {

constexpr std::int64_t kNoCycle = -1;

class ListsOnFlexRay final : public ListMedium {
 public:
  explicit ListsOnFlexRay(bus::controller::FlexRayController& controller) : controller_(controller) {}
  bus::cni::IncomingList& incoming(PduId pdu) override { return controller_.incoming(pdu); }
  void send(PduId pdu, const bus::cni::ListView& list) override { controller_.outgoing(pdu).write(list); }

 private:
  bus::controller::FlexRayController& controller_;
};

class ListsOnCan final : public ListMedium {
 public:
  explicit ListsOnCan(bus::cni::CanController& controller) : controller_(controller) {}
  bus::cni::IncomingList& incoming(PduId pdu) override { return controller_.incoming(pdu); }
  void send(PduId pdu, const bus::cni::ListView& list) override { controller_.send(pdu, list); }

 private:
  bus::cni::CanController& controller_;
};

}  // namespace

Executive::Executive(const ExecutiveConfig& config, std::vector<std::shared_ptr<Step>> steps,
                     bus::ports::FlexRayPort* flexray, const std::vector<bus::ports::CanPort*>& cans,
                     SensorLines& lines, recording::records::Sink& sink)
    : config_(config), node_(config.cluster->node(config.node)), steps_(std::move(steps)),
      time_(config.node, config.oscillator, config.true_clock), records_(*config.cluster, time_, sink),
      wiring_(*config.cluster, node_, steps_, connect(flexray, cans), time_, records_),
      processor_(node_.tasks, {config.seed, config.replication, config.node}, time_, records_.counts()),
      sensors_(*config.cluster, config.node, {config.seed, config.replication}, time_, lines), lines_(lines),
      asleep_(flexray_ && !config.clock && config.cold == ColdStart::kSleeps) {
  if (flexray_ && config.clock) flexray_->start_integrated(*config.clock);
  if (!asleep_) power_on(config.power_on);
  arm_cycle();
  look_ahead();
}

// Makes a controller for each medium that the node is on, and its lists for the wiring.
std::vector<Connection> Executive::connect(bus::ports::FlexRayPort* flexray,
                                           const std::vector<bus::ports::CanPort*>& cans) {
  const schedules::model::Cluster& cluster = *config_.cluster;
  std::vector<Connection> media;
  if (node_.flexray) {
    TTF_CHECK(flexray != nullptr, "{} needs a FlexRay port", node_.name);
    flexray_ = std::make_unique<bus::controller::FlexRayController>(
        cluster, config_.node, *flexray, static_cast<bus::controller::ControllerEvents&>(*this));
    time_.follow(*flexray_);
    media.push_back({schedules::model::kFlexRay, std::make_unique<ListsOnFlexRay>(*flexray_)});
  }
  cans_.resize(cluster.can_buses.size());
  for (std::size_t b = 0; b < std::min(cans.size(), cans_.size()); ++b) {
    if (cans[b] == nullptr) continue;
    cans_[b] = std::make_unique<bus::cni::CanController>(cluster, config_.node, b, *cans[b]);
    media.push_back({schedules::model::MediumId::can(b), std::make_unique<ListsOnCan>(*cans_[b])});
  }
  return media;
}

void Executive::power_on(Microticks now) {
  sensors_.power_on(now, config_.first_cycle.value_or(now));
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

// Lets the controller start up after the wake-up, whatever its result.
void Executive::start_up_after_waking(Microticks now) {
  if (!waking_ || flexray_->state().kind != bus::poc::PocKind::kReady) return;
  waking_ = false;
  if (node_.flexray->pKeySlotUsedForStartup) flexray_->command(bus::poc::PocEventKind::kAllowColdstart, now);
  flexray_->command(bus::poc::PocEventKind::kRun, now);
}

Microticks Executive::next_event() const {
  if (asleep_) return rises_.value_or(kNever<Microticks>);
  return flexray_ ? std::min(own_next_, flexray_->next_event()) : own_next_;
}

void Executive::look_ahead() {
  concerned_ = false;
  own_next_ = std::min(processor_.next_event(), sensors_.next_event());
}

Promise Executive::promise() const {
  Promise promise{next_event(), kNever<Microticks>, soonest_end(true), kNever<Microticks>};
  if (flexray_) promise.after_flexray = asleep_ || flexray_->answers_at_once() ? Microticks{} : soonest_end(false);
  if (sensors_.any_triggered()) promise.after_trigger = Microticks{};
  return promise;
}

Microticks Executive::soonest_end(bool on_can) const {
  Microticks soonest = kNever<Microticks>;
  for (std::size_t t = 0; t < node_.tasks.size(); ++t) {
    const schedules::model::Task& task = node_.tasks[t];
    const bool set_off =
        std::any_of(task.reads.begin(), task.reads.end(), [&](const schedules::model::PortBinding& port) {
          return port.medium.is_can() == on_can && activates(task, port);
        });
    if (set_off) soonest = std::min(soonest, time_.ticks(processor_.shortest(t)));
  }
  return soonest;
}

// Losing global time cancels what it scheduled.
void Executive::arm_cycle() {
  const timebase::CycleClock* global = clock();
  const std::int64_t cycle = global != nullptr ? global->cycle() : kNoCycle;
  if (cycle == armed_cycle_) return;
  armed_cycle_ = cycle;
  if (global == nullptr) {
    processor_.disarm();
    sensors_.disarm();
  } else {
    processor_.arm(cycle);
    sensors_.arm(cycle);
  }
}

void Executive::advance(Microticks now) {
  if (asleep_) {
    if (!rises_ || *rises_ > now) return;
    asleep_ = false;
    concerned_ = true;
    records_.woke_up(now);
    power_on(now);
  }
  concerned_ |= own_next_ <= now;
  if (processor_.ends_by(now)) finish(now);
  if (flexray_) {
    flexray_->advance(now);
    start_up_after_waking(now);
  }
  // As a rule only the controller had something to do: a frame to send.
  if (!concerned_) return;
  arm_cycle();
  for (const std::size_t task : sensors_.act(now)) processor_.activate(task, now);
  processor_.activate_by_time(now);
  start_next(now);
  look_ahead();
}

void Executive::start_next(Microticks now) {
  while (const Processor::Running* const running = processor_.start_next(now)) {
    run_step(*running);
    if (processor_.ends_by(now)) finish(now);
  }
}

void Executive::run_step(const Processor::Running& running) {
  const recording::records::Stamp& start = running.run.start;
  StepContext context;
  context.stamp = start;
  context.activation = running.activation;
  context.measurement = sensors_.measurement(running.task);
  context.global_time = clock() != nullptr;
  context.inputs = wiring_.read(running.task, start);
  context.outputs = wiring_.outputs(running.task);
  context.strobes = sensors_.strobes();
  context.turn = running.turn;
  context.sink = &records_.sink();
  steps_[running.task]->run(context);
  if (context.turn != running.turn) processor_.choose_mode(context.turn->mode);
  records_.counts().unlisted_fates += context.unlisted;
  actuation_ = context.actuation;
  wiring_.report_discarded(running.task, start);
}

void Executive::finish(Microticks now) {
  const Processor::Running& ended = processor_.finish(now);
  wiring_.write(ended.task, ended.run.end);
  if (actuation_) lines_.actuate(*std::exchange(actuation_, std::nullopt));
  records_.task_run(ended.run);
  processor_.activate_after(ended.task, now);
  if (!processor_.waits(ended.task)) sensors_.task_ended(ended.task);
}

void Executive::receive(const bus::ports::Reception& reception) {
  if (asleep_) {
    if (reception.signal == bus::ports::Signal::kWakeup && !rises_ && bus::wire::wakes(config_.cluster->flexray))
      rises_ = reception.end + time_.ticks(config_.boots);
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
    arrived({schedules::model::MediumId::can(can_bus), arrival->pdu, arrival->effect, arrival->sequence, arrival->torn},
            now);
  else
    ++records_.counts().refused_can_frames;
  if (concerned_) look_ahead();
}

void Executive::can_frame_sent(const recording::records::CanFrameSent& frame, Microticks now) {
  records_.can_frame_sent(frame, *cans_[frame.bus], now);
}

void Executive::arrived(const ListArrival& arrival, Microticks at) {
  for (const std::size_t task : wiring_.arrived(arrival, at)) concerned_ |= processor_.activate(task, at);
}

void Executive::trigger(SensorId sensor, Microticks now) {
  if (asleep_) return;
  sensors_.triggered(sensor, now);
  look_ahead();
}

void Executive::strobe(SensorId sensor, std::uint32_t sequence, Microticks now) {
  sensors_.latch(sensor, sequence, now);
}

}  // namespace ttf::nodes::host
