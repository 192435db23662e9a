#include "nodes/runner/runner.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "bus/wire/strobe.h"
#include "nodes/host/node_clock.h"
#include "recording/records/tee.h"
#include "schedules/model/sensor_lines.h"

namespace ttf::nodes::runner {
namespace {

constexpr Duration kHealthEvery = Duration::milliseconds(1000);
constexpr Duration kRoomForHealth = Duration::microseconds(500);  // until the next due instant
constexpr std::uint64_t kDoneBetweenLooks = 1024;                 // a stop is seen even while catching up
constexpr Duration kUntilTakenIn = Duration::milliseconds(1);
constexpr std::int64_t kCyclesUntilAnew = 64;
constexpr std::size_t kListsWaiting = 4;  // on a CAN, each of the largest size

std::size_t frames_waiting(const schedules::model::Cluster& cluster, const schedules::model::CanBus& bus) {
  std::size_t most = 1;
  for (const schedules::model::CanMessage& message : bus.messages)
    most = std::max(most, static_cast<std::size_t>(cluster.pdu(message.pdu).max_fragments()));
  return kListsWaiting * most;
}

}  // namespace

class Runner::Watch final : public recording::records::Sink {
 public:
  using recording::records::Sink::on;
  void on(const recording::records::ClockCorrected& corrected) override {
    largest = std::max(largest, std::abs(corrected.offset_microticks));
  }
  int largest = 0;  // offset correction [uT]
  std::unique_ptr<recording::records::Tee> out;
};

Runner::Runner(const RunnerConfig& config, std::vector<std::shared_ptr<host::Step>> steps,
               bus::ports::LiveMedium& medium, MachineClock& machine_clock, recording::records::Sink& sink)
    : config_(config), cluster_(*config.cluster),
      oscillator_(
          host::drawn_oscillator(cluster_.node(config.node), index_of(config.node), config.seed, config.replication)),
      medium_(medium), machine_clock_(machine_clock), watch_(std::make_unique<Watch>()),
      account_([this](Microticks at) { return executive_->stamp(at); }, sink),
      arrival_window_(cluster_, config.node,
                      {ticks(config.clock.in_drive(cluster_.arrival_window->early)),
                       ticks(config.clock.in_drive(cluster_.arrival_window->late))},
                      *this),
      flexray_(config_.clock, machine_clock, oscillator_, cluster_.arrival_window->late, medium, arrival_window_,
               account_) {
  const schedules::model::Node& node = cluster_.node(config.node);
  watch_->out = std::make_unique<recording::records::Tee>(std::vector<recording::records::Sink*>{&sink, watch_.get()});
  std::vector<bus::ports::CanPort*> ports;
  for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b) {
    const std::size_t most = frames_waiting(cluster_, cluster_.can_buses[b]);
    cans_.push_back(!schedules::model::is_on_can(node, b)
                        ? nullptr
                        : std::make_unique<PacedCan>(cluster_, b, most, [this] { return executive_->stamp(last_); }));
    ports.push_back(cans_.back().get());
    can_states_.push_back(recording::records::CanState::kActive);
  }
  for (std::size_t s = 0; s < cluster_.sensors.size(); ++s)
    sensor_can_.push_back(schedules::model::can_of_lines(cluster_, static_cast<SensorId>(s)));
  const bool integrated = !config.power_on.has_value();
  const TrueTime begin = integrated ? config.first_cycle : std::max(*config.power_on, now());
  last_ = ticks(begin);
  if (!integrated) powered_on_ = config.clock.machine_time(begin);
  const host::ExecutiveConfig executive{
      &cluster_,
      config.node,
      oscillator_,
      integrated && node.flexray
          ? std::optional(host::integrated_clock(oscillator_, cluster_, node, config.first_cycle))
          : std::nullopt,
      config.seed,
      config.replication,
      last_,
      config.cold.how,
      config.cold.after,
      this};
  executive_ =
      std::make_unique<host::Executive>(executive, std::move(steps), node.flexray ? &flexray_ : nullptr,
                                        std::move(ports), static_cast<host::SensorLines&>(*this), *watch_->out);
  if (node.flexray) flexray_.bind(*executive_->controller());
  if (!integrated && !executive_->asleep())
    watch_->out->on(recording::records::PowerChanged{executive_->stamp(last_), true});
  health_due_ = next_health(machine_clock_.now());
}

Runner::~Runner() = default;

Microticks Runner::ticks(Duration drive) const {
  const std::int64_t period = cluster_.node(config_.node).microtick_ps;
  return {(drive.ns * 1000 + period - 1) / period};
}

Duration Runner::in_real(Microticks ticks) const {
  return config_.clock.in_real({ticks.value * cluster_.node(config_.node).microtick_ps / 1000});
}

const timebase::CycleClock* Runner::schedule() const {
  const bus::controller::FlexRayController* controller = executive_->controller();
  return controller != nullptr && controller->clock() ? &*controller->clock() : nullptr;
}

// ---- the sensor's wires, as frames on its CAN

void Runner::trigger(SensorId sensor) {
  if (const auto can = sensor_can_[index_of(sensor)])
    (void)medium_.send_can(*can, {schedules::model::trigger_identifier(sensor), false, {}});
}

void Runner::strobe(SensorId sensor, std::uint32_t sequence) {
  const auto data = bus::wire::strobe_data(sequence);
  if (const auto can = sensor_can_[index_of(sensor)])
    (void)medium_.send_can(*can, {schedules::model::strobe_identifier(sensor), false, data});
}

void Runner::actuate(const host::Actuation& actuation) {
  if (config_.vehicle != nullptr) config_.vehicle->report(actuation);
}

// ---- arrivals

void Runner::arrived(Microticks behind) { account_.arrivals.add(in_real(behind)); }

void Runner::missed_window(std::int64_t cycle, int slot, schedules::model::Channel channel, Microticks behind) {
  account_.missed_window(last_, in_real(behind), cycle, slot, channel);
}

void Runner::lost(std::int64_t cycle, int slot, schedules::model::Channel channel, std::uint32_t count) {
  account_.frames_lost(last_, machine_clock_.now() - machine_time(last_), cycle, slot, channel, count);
}

void Runner::take_in() {
  if (config_.vehicle != nullptr) config_.vehicle->take_in();
  while (const auto arrival = medium_.receive()) {
    if (arrival->left) account_.transits.add(arrival->received - *arrival->left);
    if (arrival->at < powered_on_) continue;  // without power the node receives nothing
    if (arrival->kind == bus::ports::LiveArrival::Kind::kCanReport) {
      report_errors(*arrival);
      continue;
    }
    std::optional<Microticks> late;
    if (arrival->late) late = ticks(config_.clock.in_drive(*arrival->late));
    arrival_window_.arrive(*arrival, ticks(config_.clock.drive_time(arrival->at)), late,
                           ticks(config_.clock.in_drive(arrival->signal.duration)), schedule());
  }
}

// Records the errors of the node's own controller on a private CAN, as its interface reports them.
void Runner::report_errors(const bus::ports::LiveArrival& arrival) {
  const bus::ports::CanReport& report = arrival.report;
  const auto can_bus = static_cast<std::uint8_t>(arrival.can_bus);
  const recording::records::Stamp stamp = executive_->stamp(ticks(config_.clock.drive_time(arrival.at)));
  can_reported_ = true;
  if (report.error != recording::records::CanError::kNone) {
    ++can_errors_;
    watch_->out->on(recording::records::CanErrorFrame{stamp, can_bus, report.error, report.as_transmitter,
                                                      report.transmit_errors, report.receive_errors});
  }
  recording::records::CanState& state = can_states_[arrival.can_bus];
  if (!report.state || *report.state == state) return;
  watch_->out->on(recording::records::CanStateChanged{stamp, can_bus, state, *report.state, report.transmit_errors,
                                                      report.receive_errors});
  state = *report.state;
}

void Runner::hand_over(const ArrivalWindow::Due& due) {
  if (due.kind == bus::ports::LiveArrival::Kind::kFlexRay) return executive_->receive(due.reception);
  for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
    const auto sensor = static_cast<SensorId>(s);
    if (sensor_can_[s] != due.can_bus) continue;
    const bool classic = !due.can.flexible_data_rate;
    if (const auto sequence = bus::wire::strobe_sequence(due.can.data);
        due.can.identifier == schedules::model::strobe_identifier(sensor) && classic && sequence) {
      if (cluster_.sensors[s].host == config_.node) executive_->strobe(sensor, *sequence, due.at);
      return;
    }
    if (due.can.identifier == schedules::model::trigger_identifier(sensor) && classic && due.can.data.empty()) {
      if (cluster_.sensors[s].device == config_.node) executive_->trigger(sensor, due.at);
      return;
    }
  }
  // A frame with a line's identifier in the wrong form is refused there as foreign.
  executive_->receive_can(due.can_bus, due.can, last_);
}

// ---- due work

void Runner::leave(std::size_t can_bus) {
  const PacedCan::Departure departure = cans_[can_bus]->leave();
  (void)medium_.send_can(can_bus, departure.frame);
  executive_->can_frame_sent(departure.sent, last_);
}

Microticks Runner::next_due() const {
  Microticks next = std::min({executive_->next_event(), arrival_window_.next(), tries_again_});
  for (const auto& can : cans_)
    if (can && can->next() < config_.end) next = std::min(next, ticks(can->next()) + Microticks{1});
  return next;
}

void Runner::do_due(Microticks now) {
  const Microticks until = std::min(now, ticks(config_.end));
  std::uint64_t done = 0;
  for (Microticks next = next_due(); next <= until; next = next_due()) {
    if (++done % kDoneBetweenLooks == 0 && machine_clock_.readable(config_.stop_descriptor)) return;
    last_ = std::max(last_, next);
    flexray_.set_now(last_);
    if (const auto due = arrival_window_.take(last_, schedule())) {
      hand_over(*due);
    } else if (const auto can = std::find_if(cans_.begin(), cans_.end(),
                                             [this](const auto& one) { return one && ticks(one->next()) < last_; });
               can != cans_.end()) {
      leave(static_cast<std::size_t>(can - cans_.begin()));
    } else if (const Microticks due_tick = executive_->next_event(); due_tick <= last_) {
      const Duration late = machine_clock_.now() - machine_time(due_tick);
      account_.wake_ups.add(late);
      if (late > cluster_.arrival_window->late) account_.late_wakeup(last_, late);
      executive_->advance(last_);
    }
    look_after_controller();
    take_in();
  }
}

void Runner::look_after_controller() {
  const bus::controller::FlexRayController* controller = executive_->controller();
  if (controller == nullptr) return;
  const bus::poc::PocState& state = controller->state();
  const schedules::model::NodeParameters& node = *cluster_.node(config_.node).flexray;
  const bool gave_up = state.kind == bus::poc::PocKind::kIntegrationListen && node.pKeySlotUsedForStartup &&
                       bus::poc::attempts_exhausted(state);
  if (!gave_up)
    tries_again_ = kNever<Microticks>;
  else if (tries_again_ == kNever<Microticks>)
    tries_again_ = last_ + Microticks{kCyclesUntilAnew * node.pMicroPerCycle};
  if (state.kind != bus::poc::PocKind::kHalt && last_ < tries_again_) return;
  executive_->start_anew(last_);
  tries_again_ = kNever<Microticks>;
}

// A line is watched if an arrival on it needs an answer at once.
void Runner::watch_lines() {
  const bool listens = executive_->promise().after_flexray != host::Promise::kNever;
  if (listens == listens_) return;
  listens_ = listens;
  machine_clock_.clear();
  machine_clock_.watch(config_.stop_descriptor);
  if (config_.vehicle != nullptr) machine_clock_.watch(config_.vehicle->descriptor());
  for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
    medium_.watch(bus::ports::line_of(channel), listens);
    if (listens) machine_clock_.watch(medium_.descriptor(bus::ports::line_of(channel)));
  }
  for (std::size_t b = 0; b < cans_.size(); ++b) {
    if (!cans_[b]) continue;
    medium_.watch(bus::ports::line_of_can(b), true);
    machine_clock_.watch(medium_.descriptor(bus::ports::line_of_can(b)));
  }
}

// The nodes report in turn.
bus::ports::MachineTime Runner::next_health(bus::ports::MachineTime now) const {
  const auto turn = static_cast<std::int64_t>(index_of(config_.node) + 1);
  const Duration phase{kHealthEvery.ns * turn / static_cast<std::int64_t>(cluster_.nodes.size() + 1)};
  return config_.clock.next_turn(kHealthEvery, phase, now);
}

// Returns the instant of the next report, which may come sooner if a task ends before and makes room.
bus::ports::MachineTime Runner::report_health() {
  const bus::ports::MachineTime now = machine_clock_.now();
  if (now < health_due_) return health_due_;
  const Microticks next = next_due();
  const bool room = next == kNever<Microticks> || machine_time(next) > now + kRoomForHealth;
  if (!room && now < health_due_ + kHealthEvery) return health_due_ + kHealthEvery;
  health_due_ = next_health(now);
  record_account();
  if (on_health_) on_health_(health());
  return health_due_;
}

std::uint64_t Runner::dropped() const {
  std::uint64_t dropped = arrival_window_.dropped();
  for (const auto& can : cans_)
    if (can) dropped += can->dropped();
  return dropped;
}

void Runner::record_account() { account_.record(last_, machine_clock_.floor(), medium_.counts(), dropped()); }

Health Runner::health() const {
  Health health;
  health.timing = account_.counts();
  health.medium = medium_.counts();
  health.dropped = dropped();
  health.wakeup_p50 = account_.wake_ups.quantile(500);
  health.wakeup_p99 = account_.wake_ups.quantile(990);
  health.wakeup_longest = account_.wake_ups.longest();
  health.largest_offset = in_real(Microticks{watch_->largest});
  if (const auto* controller = executive_->controller()) health.state = controller->state().kind;
  health.can_errors = can_errors_;
  if (can_reported_) health.can_state = *std::max_element(can_states_.begin(), can_states_.end());
  if (config_.vehicle != nullptr) health.vehicle = config_.vehicle->counts();
  return health;
}

RunnerEnd Runner::run() {
  listens_ = true;  // forces watch_lines() to act
  if (executive_->promise().after_flexray != host::Promise::kNever) listens_ = false;
  watch_lines();
  const bus::ports::MachineTime end = config_.clock.machine_time(config_.end);
  RunnerEnd how = RunnerEnd::kDone;
  bool was_behind = false;
  while (true) {
    bus::ports::MachineTime now = machine_clock_.now();
    // A stopped process stopped the medium's threads, too: they take in their frames before these count as missed.
    const bool behind =
        next_due() != kNever<Microticks> && now - machine_time(next_due()) > config_.clock.in_real(cluster_.cycle());
    if (behind && !was_behind) {
      machine_clock_.sleep(kUntilTakenIn);
      now = machine_clock_.now();
    }
    was_behind = behind;
    take_in();
    do_due(ticks(config_.clock.drive_time(now)));
    if (!medium_.failure().empty()) {
      how = RunnerEnd::kFailed;
      break;
    }
    if (machine_clock_.readable(config_.stop_descriptor)) {
      how = RunnerEnd::kStopped;
      break;
    }
    if (now >= end) break;
    const bus::ports::MachineTime health_due = report_health();
    watch_lines();
    const Microticks next = next_due();
    const bus::ports::MachineTime due = next == kNever<Microticks> ? end : std::min(end, machine_time(next));
    machine_clock_.wait_until(std::min(due, health_due));
  }
  record_account();
  return how;
}

}  // namespace ttf::nodes::runner
