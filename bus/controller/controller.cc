#include "bus/controller/controller.h"

#include <algorithm>

#include "bus/controller/state.h"
#include "bus/wire/symbols.h"
#include "core/check.h"

namespace ttf::bus::controller {
namespace {

const schedules::model::NodeParameters& parameters(const schedules::model::Cluster& cluster, NodeId node) {
  TTF_CHECK(cluster.node(node).flexray.has_value(), "{} is not on FlexRay", cluster.node(node).name);
  return *cluster.node(node).flexray;
}

// Returns a static slot's microticks. Checks parameters that a test made by hand, past the checker.
timebase::Divisor nominal_slot(const schedules::model::GlobalParameters& g, const schedules::model::NodeParameters& p) {
  TTF_CHECK(g.gMacroPerCycle >= 1 && g.gdStaticSlot >= 1 && p.pMicroPerCycle >= g.gMacroPerCycle,
            "static slots of {} macroticks, {} macroticks and {} microticks per cycle", g.gdStaticSlot,
            g.gMacroPerCycle, p.pMicroPerCycle);
  return timebase::Divisor(static_cast<std::int64_t>(g.gdStaticSlot) * p.pMicroPerCycle / g.gMacroPerCycle);
}

}  // namespace

FlexRayController::State::State(const schedules::model::Cluster& c, NodeId n, ports::FlexRayPort& medium,
                                ControllerEvents& host)
    : cluster(c), g(c.flexray), p(parameters(c, n)), node(n), port(medium), by_content(medium.by_content()),
      events(host), poc_parameters(poc::poc_parameters(c.flexray, parameters(c, n))), slots(c, n),
      minislots(c.flexray), geometry{g.gMacroPerCycle, g.gdMacrotick_ps, p.pMicroPerCycle, g.gOffsetCorrectionStart},
      wants_receptions(host.wants_receptions()), nominal_slot(controller::nominal_slot(g, p)),
      static_frame(bits(schedules::model::frame_bits(g, g.gPayloadLengthStatic))), longest_cas(bits(g.gdCASRxLowMax)),
      pattern_wakes(wire::wakes(g)), poc(poc_power_on(poc_parameters)), cni(c, n),
      network_management(c.flexray.gNetworkManagementVectorLength), sync(c.flexray.gSyncNodeMax),
      initialisation(c.flexray, parameters(c, n)), board(g.gNumberOfStaticSlots),
      grid(static_cast<std::size_t>(g.gNumberOfStaticSlots + 1)), dynamic{Dynamic{DynamicSlotCounter(c.flexray)},
                                                                          Dynamic{DynamicSlotCounter(c.flexray)}} {}

Microticks FlexRayController::State::bits(int count) const {
  return {(count * g.gdBit_ps + p.pdMicrotick_ps - 1) / p.pdMicrotick_ps};
}

// ---- protocol operation control

void FlexRayController::State::apply(const poc::PocEvent& event, Microticks at) {
  const poc::PocKind from = poc.kind;
  const poc::PocStep step = poc_step(poc_parameters, poc, event);
  poc = step.next;
  act(step.actions, at);
  if (poc.kind != poc::PocKind::kWakeupSend) wakeup_sent = kNever<Microticks>;
  if (poc.kind != from) events.state_changed(from, step, at);
}

void FlexRayController::State::act(const poc::PocActions& actions, Microticks at) {
  if (actions.empty()) return;
  if (actions.has(poc::PocAction::kStopTimers)) listen_timer = noise_timer = kNever<Microticks>;
  if (actions.has(poc::PocAction::kDropSchedule)) drop_schedule();
  if (actions.has(poc::PocAction::kRestartListenTimer)) listen_timer = at + poc_parameters.listen_timeout();
  if (actions.has(poc::PocAction::kStopListenTimer)) listen_timer = kNever<Microticks>;
  if (actions.has(poc::PocAction::kRestartNoiseTimer)) noise_timer = at + poc_parameters.noise_timeout();
  if (actions.has(poc::PocAction::kSendWakeupPattern)) send_wakeup_pattern(at);
  if (actions.has(poc::PocAction::kSendCas)) send_cas(at);
  if (actions.has(poc::PocAction::kDeriveSchedule))
    initialisation.reset();  // receive_startup_frame() passes on the frame that caused this
}

void FlexRayController::State::drop_schedule() {
  clock.reset();
  initialisation.reset();
  partner_overdue = kNever<Microticks>;
  symbol_request.reset();
}

// Starts a clock for `cycle`, which begins at `start`: in the future, or in the past for a node that joins during it.
void FlexRayController::State::begin_schedule(Microticks start, int rate, std::int64_t cycle) {
  clock.emplace(geometry, start, rate, cycle);
  lay_cycle();
  next_rate = rate;
  slot_at = {0, clock->cycle_start(), clock->cycle_start(), 0, {}};
  sync.reset();
  sync_status = {};
  board.clear();
  going_on = {};
  window_last = {};
  network_management.reset();
}

// ---- the cycle

// Static slots lie before the clock's correction phase, so only its rate moves them.
void FlexRayController::State::lay_cycle() {
  const int round = g.gCycleCountMax + 1;  // 64 in 2.1; a power of two needs no division
  counter = static_cast<int>((round & (round - 1)) == 0 ? clock->cycle() & (round - 1) : clock->cycle() % round);
  if (grid_rate == clock->rate_correction()) return;
  grid_rate = clock->rate_correction();
  const auto into = [this](Macroticks at) { return clock->start_of(at) - clock->cycle_start(); };
  for (int slot = 1; slot <= g.gNumberOfStaticSlots; ++slot)
    grid[static_cast<std::size_t>(slot - 1)] = {into(slot_start(slot)), into(action_point(slot))};
  grid.back().from = into(static_end());
}

Microticks FlexRayController::State::next_event() const {
  const Microticks next = std::min(std::min(listen_timer, noise_timer), std::min(wakeup_sent, partner_overdue));
  if (!clock) return next;
  switch (segment) {
    case Segment::kBefore: return std::min(next, clock->cycle_start());
    case Segment::kStatic:
      return std::min(next, clock->cycle_start() + (next_static < slots.own_static().size()
                                                        ? line(slots.own_static()[next_static]->slot).action_point
                                                        : grid.back().from));
    case Segment::kDynamic:
      return std::min(std::min(std::min(next, symbol_point), std::min(dynamic[0].due, dynamic[1].due)),
                      g.gdSymbolWindow > 0 ? window_to : clock->cycle_end());
    case Segment::kRest: return std::min(next, clock->cycle_end());
  }
  return next;
}

// Handles one event that is due at `at`; the next call handles the next one.
void FlexRayController::State::handle(Microticks at) {
  const auto busy = [this] {
    return port.carrier(schedules::model::Channel::kA) || port.carrier(schedules::model::Channel::kB);
  };
  if (noise_timer == at) {
    noise_timer = kNever<Microticks>;
    return apply({poc::PocEventKind::kNoiseTimeout}, at);
  }
  if (listen_timer == at) {
    listen_timer = kNever<Microticks>;
    // Arriving activity may have stopped the timer, which restarts when the channels are idle again.
    const bool stopped = poc::listen_timer_follows_channels(poc.kind) && busy();
    return apply({stopped ? poc::PocEventKind::kChannelActive : poc::PocEventKind::kListenTimeout}, at);
  }
  if (wakeup_sent == at) {
    wakeup_sent = kNever<Microticks>;
    return apply({poc::PocEventKind::kWakeupSent}, at);
  }
  if (partner_overdue == at) {
    initialisation.reset();
    partner_overdue = kNever<Microticks>;
    return apply({poc::PocEventKind::kScheduleNotDerived}, at);
  }
  switch (segment) {
    case Segment::kBefore: return enter_cycle({}, at);
    case Segment::kStatic:
      if (next_static < slots.own_static().size()) return send_static(at);
      return close_static_segment(at);
    case Segment::kDynamic:
      for (const schedules::model::Channel channel : schedules::model::kBothChannels)
        if (dynamic[index_of(channel)].due == at) return send_dynamic(channel, at);
      if (symbol_point == at) return send_media_test_symbol(at);
      if (g.gdSymbolWindow > 0) return close_symbol_window();
      [[fallthrough]];
    case Segment::kRest: {
      const poc::StartupFramesSeen ended = sync.startup_frames(poc.reference);
      network_management.end_cycle(!poc::in_startup(poc.kind));
      clock->next_cycle(next_rate);
      lay_cycle();
      return enter_cycle(ended, at);
    }
  }
}

void FlexRayController::State::start_cycle() {
  board.begin_segment();
  slot_at = {0, clock->cycle_start(), clock->cycle_start(), 0, {}};
  sync.start_cycle(counter);
  segment = Segment::kStatic;
  next_static = 0;
  skip_to_own_static();
}

// `ended`: the startup frames received in the cycle before.
void FlexRayController::State::enter_cycle(const poc::StartupFramesSeen& ended, Microticks at) {
  apply(poc::PocEvent::cycle_started(counter, ended), at);
  if (!clock || clock->cycle_start() != at) return;  // dropped, or begun anew by a CAS
  start_cycle();
  events.cycle_started(clock->cycle(), at);
}

// Activity under way is not judged yet. It began at an unknown instant after all that was received on the channel.
void FlexRayController::State::note_what_goes_on() {
  for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
    bool& goes_on = going_on[index_of(channel)];
    const bool whole_cycle = goes_on;
    goes_on = port.carrier(channel);
    if (!goes_on) continue;
    const int last = board.slots();
    if (whole_cycle) board.crossed(channel, 1, last);
    for (int slot = board.last_received(channel) + 1; slot < last; ++slot)
      if (slots.expected(slot, counter, channel) != nullptr) board.crossed(channel, slot, slot);
    board.crossed(channel, last, last);
  }
}

void FlexRayController::State::report_slot_problems(Microticks at) {
  const int now = counter;
  if (board.are_pairs(slots.pairs(now))) return;
  for (int slot = 1; slot <= g.gNumberOfStaticSlots; ++slot) {
    const SlotBoard::Seen& status = board.at(slot);
    const bool both_valid = status.valid[0] && status.valid[1];
    if ((status.errors[0] | status.errors[1]) == kValidFrame && (both_valid || !slots.others_send_in(slot))) continue;
    const auto expected = slots.expected(slot, now);
    for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
      const auto c = index_of(channel);
      SlotStatus errors = status.errors[c];
      if (errors == kValidFrame && !status.valid[c] && includes(p.pChannels, channel) && expected[c] != nullptr)
        errors = kNoFrame;
      if (errors != kValidFrame) events.slot_problem(clock->cycle(), slot, channel, errors, at);
    }
  }
}

// All static frames of the cycle have been received: reports the missing ones, and computes the corrections in
// odd cycles.
void FlexRayController::State::close_static_segment(Microticks at) {
  const std::int64_t cycle = clock->cycle();
  note_what_goes_on();
  if (!poc::in_startup(poc.kind)) report_slot_problems(at);
  board.end_segment();
  const int valid_a = sync.valid(schedules::model::Channel::kA), valid_b = sync.valid(schedules::model::Channel::kB);
  (cycle % 2 == 0 ? sync_status.VSAE : sync_status.VSAO) = valid_a;
  (cycle % 2 == 0 ? sync_status.VSBE : sync_status.VSBO) = valid_b;
  events.static_segment_ended(cycle, at);
  segment = minislots.count() > 0 || g.gdSymbolWindow > 0 ? Segment::kDynamic : Segment::kRest;
  if (g.gdSymbolWindow > 0) plan_symbol_window();
  for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
    dynamic[index_of(channel)].counter.start();
    dynamic[index_of(channel)].next = 0;
    plan_dynamic(channel, at);
  }
  if (cycle % 2 == 0) return;

  const timebase::Correction offset = timebase::offset_correction(sync.odd(), p.pOffsetCorrectionOut);
  const timebase::Correction rate = timebase::rate_correction(sync.measurements(), clock->rate_correction(),
                                                              p.pClusterDriftDamping, p.pRateCorrectionOut);
  if (cluster.synchronisation && poc::corrects_clock(poc.kind)) {
    const bool external = !poc::in_startup(poc.kind);
    clock->set_offset_correction(offset.value + (external ? extern_offset : 0));
    next_rate = rate.value + (external ? extern_rate : 0);
  }
  sync_status.MOCS = offset.missing;
  sync_status.MRCS = rate.missing;
  sync_status.OCLR = offset.limit_reached;
  sync_status.RCLR = rate.limit_reached;
  events.clock_corrected(cycle, offset, rate, at);
  apply(poc::PocEvent::clock_corrected(offset.missing || rate.missing, offset.limit_reached || rate.limit_reached), at);
}

// ---- the public interface

FlexRayController::FlexRayController(const schedules::model::Cluster& cluster, NodeId node, ports::FlexRayPort& port,
                                     ControllerEvents& events)
    : state_(std::make_unique<State>(cluster, node, port, events)), poc_(state_->poc), clock_(state_->clock) {}

FlexRayController::~FlexRayController() = default;

void FlexRayController::start_integrated(const InitialClock& clock) {
  State& s = *state_;
  s.poc = poc_power_on(s.poc_parameters);
  s.poc.kind = poc::PocKind::kNormalActive;
  s.begin_schedule(clock.cycle_start, clock.rate, 0);
  s.start_cycle();
  s.due = s.next_event();
}

void FlexRayController::start_cold(Microticks now) {
  State& s = *state_;
  s.apply({poc::PocEventKind::kPowerOn}, now);
  s.apply({poc::PocEventKind::kConfig}, now);
  s.apply({poc::PocEventKind::kConfigComplete}, now);
  if (s.p.pKeySlotUsedForStartup) s.apply({poc::PocEventKind::kAllowColdstart}, now);
  s.apply({poc::PocEventKind::kRun}, now);
  s.due = s.next_event();
}

void FlexRayController::command(poc::PocEventKind command, Microticks now) {
  TTF_CHECK(command >= poc::PocEventKind::kConfig && command <= poc::PocEventKind::kFreeze, "{} is no command",
            to_text(command));
  state_->apply({command}, now);
  state_->due = state_->next_event();
}

Microticks FlexRayController::next_event() const { return state_->due; }

// Within the schedule only the minislot counters react: activity there moves the node's own dynamic slots.
bool FlexRayController::answers_at_once() const {
  const State& s = *state_;
  if (!synchronised()) return true;
  return s.segment == State::Segment::kDynamic &&
         std::any_of(schedules::model::kBothChannels.begin(), schedules::model::kBothChannels.end(),
                     [&s](schedules::model::Channel channel) { return !s.slots.own_dynamic(channel).empty(); });
}

void FlexRayController::advance(Microticks now) {
  for (State& s = *state_; s.due <= now; s.due = s.next_event()) s.handle(s.due);
}

void FlexRayController::receive(const ports::Reception& reception) { state_->receive(reception); }
bool FlexRayController::receive_on_both(const ports::Reception& reception) {
  return state_->receive_on_both(reception);
}
bool FlexRayController::is_known(const ports::Reception& reception) { return state_->is_known(reception); }
void FlexRayController::receive_known(const ports::Reception& reception) { state_->receive_known(reception); }

SlotSeen FlexRayController::slot_status(int slot, schedules::model::Channel channel) const {
  const State& s = *state_;
  TTF_CHECK(slot >= 1 && slot <= s.g.gNumberOfStaticSlots, "static slot {} of {}", slot, s.g.gNumberOfStaticSlots);
  const SlotBoard::Seen& seen = s.board.kept(slot);
  const SlotStatus errors = seen.errors[index_of(channel)];
  return {seen.valid[index_of(channel)],   has(errors, kSyntaxError),          has(errors, kContentError),
          has(errors, kBoundaryViolation), has(errors, kTransmissionConflict), has(errors, kUnexpectedFrame)};
}

SyncStatus FlexRayController::sync_status() const {
  SyncStatus status = state_->sync_status;
  status.vClockCorrectionFailed = state_->poc.vClockCorrectionFailed;
  return status;
}

bool FlexRayController::send_media_test_symbol(schedules::model::Channels channels) {
  return state_->request_media_test_symbol(channels);
}

SymbolWindowSeen FlexRayController::symbol_window_status(schedules::model::Channel channel) const {
  return state_->window_last[index_of(channel)];
}

void FlexRayController::set_network_management_vector(std::span<const std::byte> vector) {
  state_->network_management.set_own(vector);
}

std::span<const std::byte> FlexRayController::network_management_vector() const {
  return state_->network_management.combined();
}

void FlexRayController::set_external_correction(int offset, int rate) {
  const schedules::model::NodeParameters& p = state_->p;
  state_->extern_offset = std::clamp(offset, -p.pExternOffsetCorrection, p.pExternOffsetCorrection);
  state_->extern_rate = std::clamp(rate, -p.pExternRateCorrection, p.pExternRateCorrection);
}

cni::OutgoingList& FlexRayController::outgoing(PduId pdu) { return state_->cni.outgoing(pdu); }
cni::IncomingList& FlexRayController::incoming(PduId pdu) { return state_->cni.incoming(pdu); }

}  // namespace ttf::bus::controller
