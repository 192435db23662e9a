#include "bus/controller.h"

#include <algorithm>

#include "bus/controller_state.h"
#include "core/check.h"

namespace ttf::bus {
namespace {

const schedules::NodeParameters& parameters(const schedules::Cluster& cluster, NodeId node) {
  TTF_CHECK(cluster.node(node).flexray.has_value(), "{} is not on FlexRay", cluster.node(node).name);
  return *cluster.node(node).flexray;
}

}  // namespace

FlexRayController::State::State(const schedules::Cluster& c, NodeId n, FlexRayPort& medium, ControllerEvents& host)
    : cluster(c),
      g(c.flexray),
      p(parameters(c, n)),
      node(n),
      port(medium),
      events(host),
      poc_parameters(bus::poc_parameters(c.flexray, parameters(c, n))),
      slots(c, n),
      minislots(c.flexray),
      geometry{g.gMacroPerCycle, g.gdMacrotick_ps, p.pMicroPerCycle, g.gOffsetCorrectionStart},
      nominal_slot(static_cast<std::int64_t>(g.gdStaticSlot) * p.pMicroPerCycle / g.gMacroPerCycle),
      poc(poc_power_on(poc_parameters)),
      cni(c, n),
      network_management(c.flexray.gNetworkManagementVectorLength),
      sync(c.flexray.gSyncNodeMax),
      initialisation(c.flexray, parameters(c, n)),
      seen(static_cast<std::size_t>(g.gNumberOfStaticSlots)),
      seen_last(seen.size()),
      dynamic{Dynamic{DynamicSlotCounter(c.flexray)}, Dynamic{DynamicSlotCounter(c.flexray)}} {}

Microticks FlexRayController::State::bits(int count) const {
  return {(count * g.gdBit_ps + p.pdMicrotick_ps - 1) / p.pdMicrotick_ps};
}

// ---- protocol operation control

void FlexRayController::State::tell(const PocEvent& event, Microticks at) {
  const PocKind from = poc.kind;
  const PocStep step = poc_step(poc_parameters, poc, event);
  poc = step.next;
  act(step.actions, at);
  if (poc.kind != PocKind::kWakeupSend) wakeup_sent = kNever;
  if (poc.kind != from) events.state_changed(from, step, at);
}

void FlexRayController::State::act(const PocActions& actions, Microticks at) {
  if (actions.empty()) return;
  if (actions.has(PocAction::kStopTimers)) listen_timer = noise_timer = kNever;
  if (actions.has(PocAction::kDropSchedule)) drop_schedule();
  if (actions.has(PocAction::kRestartListenTimer)) listen_timer = at + poc_parameters.listen_timeout();
  if (actions.has(PocAction::kStopListenTimer)) listen_timer = kNever;
  if (actions.has(PocAction::kRestartNoiseTimer)) noise_timer = at + poc_parameters.noise_timeout();
  if (actions.has(PocAction::kSendWakeupPattern)) send_wakeup_pattern(at);
  if (actions.has(PocAction::kSendCas)) send_cas(at);
  if (actions.has(PocAction::kDeriveSchedule)) initialisation.reset();   // hear() gives it the frame that set this off
}

void FlexRayController::State::drop_schedule() {
  clock.reset();
  initialisation.reset();
  partner_overdue = kNever;
  symbol_request.reset();
}

// A clock for `cycle`, which starts at `start`: in the future, or in the past for who joins in the middle of it.
void FlexRayController::State::begin_schedule(Microticks start, int rate, std::int64_t cycle) {
  clock.emplace(geometry, start, rate, cycle);
  next_rate = rate;
  slot_at = {0, clock->cycle_start(), clock->cycle_start(), 0, {}};
  sync.reset();
  sync_status = {};
  std::fill(seen_last.begin(), seen_last.end(), Seen{});
  window_last = {};
  network_management.reset();
}

// ---- the cycle

Microticks FlexRayController::State::next_event() const {
  Microticks next = std::min({listen_timer, noise_timer, wakeup_sent, partner_overdue});
  if (!clock) return next;
  switch (segment) {
    case Segment::kBefore: return std::min(next, clock->cycle_start());
    case Segment::kStatic:
      return std::min(next, clock->start_of(next_static < slots.own_static().size()
                                                ? action_point(slots.own_static()[next_static]->slot)
                                                : static_end()));
    case Segment::kDynamic:
      return std::min({next, dynamic[0].due, dynamic[1].due, symbol_point,
                       g.gdSymbolWindow > 0 ? window_to : clock->cycle_end()});
    case Segment::kRest:
      return std::min(next, clock->cycle_end());
  }
  return next;
}

// One thing that is due at `at`; what else is due then comes with the next call.
void FlexRayController::State::handle(Microticks at) {
  const auto busy = [this] { return port.carrier(schedules::Channel::kA) || port.carrier(schedules::Channel::kB); };
  if (noise_timer == at) {
    noise_timer = kNever;
    return tell({PocEventKind::kNoiseTimeout}, at);
  }
  if (listen_timer == at) {
    listen_timer = kNever;
    // What is arriving has stopped the timer; it starts anew when the channels are idle again.
    return busy() ? tell({PocEventKind::kChannelActive}, at) : tell({PocEventKind::kListenTimeout}, at);
  }
  if (wakeup_sent == at) {
    wakeup_sent = kNever;
    return tell({PocEventKind::kWakeupSent}, at);
  }
  if (partner_overdue == at) {
    initialisation.reset();
    partner_overdue = kNever;
    return tell({PocEventKind::kScheduleNotDerived}, at);
  }
  switch (segment) {
    case Segment::kBefore: return enter_cycle({}, at);
    case Segment::kStatic:
      if (next_static < slots.own_static().size()) return send_static(at);
      return close_static_segment(at);
    case Segment::kDynamic:
      for (const schedules::Channel channel : kChannels)
        if (dynamic[index_of(channel)].due == at) return send_dynamic(channel, at);
      if (symbol_point == at) return send_media_test_symbol(at);
      if (g.gdSymbolWindow > 0) return close_symbol_window();
      [[fallthrough]];
    case Segment::kRest: {
      const StartupFramesSeen ended = sync.startup_frames(poc.reference);
      network_management.end_cycle(!in_startup(poc.kind));
      clock->next_cycle(next_rate);
      return enter_cycle(ended, at);
    }
  }
}

void FlexRayController::State::start_cycle() {
  std::fill(seen.begin(), seen.end(), Seen{});
  slot_at = {0, clock->cycle_start(), clock->cycle_start(), 0, {}};
  sync.start_cycle(counter());
  segment = Segment::kStatic;
  next_static = 0;
  skip_to_own_static();
}

// `ended`: what was received in the cycle before.
void FlexRayController::State::enter_cycle(const StartupFramesSeen& ended, Microticks at) {
  tell(PocEvent::cycle_started(counter(), ended), at);
  if (!clock || clock->cycle_start() != at) return;   // dropped, or begun anew by a CAS
  start_cycle();
  events.cycle_started(clock->cycle(), at);
}

void FlexRayController::State::tell_slot_problems(Microticks at) {
  const int now = counter();
  for (int slot = 1; slot <= g.gNumberOfStaticSlots; ++slot) {
    const Seen& status = seen[static_cast<std::size_t>(slot - 1)];
    const bool both_valid = status.valid[0] && status.valid[1];
    if ((status.errors[0] | status.errors[1]) == 0 && (both_valid || !slots.others_send_in(slot))) continue;
    const auto expected = slots.expected(slot, now);
    for (const schedules::Channel channel : kChannels) {
      const auto c = index_of(channel);
      std::uint8_t errors = status.errors[c];
      if (errors == 0 && !status.valid[c] && includes(p.pChannels, channel) && expected[c] != nullptr)
        errors = kNoFrame;
      if (errors != 0) events.slot_problem(clock->cycle(), slot, channel, static_cast<SlotStatus>(errors), at);
    }
  }
}

// All static frames of the cycle have been heard: what is missing is reported, and in odd cycles the corrections are
// computed.
void FlexRayController::State::close_static_segment(Microticks at) {
  const std::int64_t cycle = clock->cycle();
  if (!in_startup(poc.kind)) tell_slot_problems(at);
  seen.swap(seen_last);
  const int valid_a = sync.valid(schedules::Channel::kA), valid_b = sync.valid(schedules::Channel::kB);
  (cycle % 2 == 0 ? sync_status.VSAE : sync_status.VSAO) = valid_a;
  (cycle % 2 == 0 ? sync_status.VSBE : sync_status.VSBO) = valid_b;
  events.static_segment_ended(cycle, at);
  segment = minislots.count() > 0 || g.gdSymbolWindow > 0 ? Segment::kDynamic : Segment::kRest;
  if (g.gdSymbolWindow > 0) plan_symbol_window();
  for (const schedules::Channel channel : kChannels) {
    dynamic[index_of(channel)].counter.start();
    dynamic[index_of(channel)].next = 0;
    plan_dynamic(channel, at);
  }
  if (cycle % 2 == 0) return;

  const timebase::Correction offset = timebase::offset_correction(sync.odd(), p.pOffsetCorrectionOut);
  const timebase::Correction rate = timebase::rate_correction(sync.measurements(), clock->rate_correction(),
                                                              p.pClusterDriftDamping, p.pRateCorrectionOut);
  if (cluster.synchronisation && corrects_clock(poc.kind)) {
    const bool external = !in_startup(poc.kind);
    clock->set_offset_correction(offset.value + (external ? extern_offset : 0));
    next_rate = rate.value + (external ? extern_rate : 0);
  }
  sync_status.MOCS = offset.missing;
  sync_status.MRCS = rate.missing;
  sync_status.OCLR = offset.limit_reached;
  sync_status.RCLR = rate.limit_reached;
  events.clock_corrected(cycle, offset, rate, at);
  tell(PocEvent::clock_corrected(offset.missing || rate.missing, offset.limit_reached || rate.limit_reached), at);
}

// ---- the public face

FlexRayController::FlexRayController(const schedules::Cluster& cluster, NodeId node, FlexRayPort& port,
                                     ControllerEvents& events)
    : state_(std::make_unique<State>(cluster, node, port, events)) {}

FlexRayController::~FlexRayController() = default;

void FlexRayController::start_integrated(const InitialClock& clock) {
  State& s = *state_;
  s.poc = poc_power_on(s.poc_parameters);
  s.poc.kind = PocKind::kNormalActive;
  s.begin_schedule(clock.cycle_start, clock.rate, 0);
  s.start_cycle();
  s.due = s.next_event();
}

void FlexRayController::start_cold(Microticks now) {
  State& s = *state_;
  s.tell({PocEventKind::kPowerOn}, now);
  s.tell({PocEventKind::kConfig}, now);
  s.tell({PocEventKind::kConfigComplete}, now);
  if (s.p.pKeySlotUsedForStartup) s.tell({PocEventKind::kAllowColdstart}, now);
  s.tell({PocEventKind::kRun}, now);
  s.due = s.next_event();
}

void FlexRayController::command(PocEventKind command, Microticks now) {
  TTF_CHECK(command >= PocEventKind::kConfig && command <= PocEventKind::kFreeze, "{} is no command",
            to_text(command));
  state_->tell({command}, now);
  state_->due = state_->next_event();
}

Microticks FlexRayController::next_event() const { return state_->due; }

// Within the schedule only the minislot counters listen: what is taken there moves the node's own dynamic slots.
bool FlexRayController::answers_at_once() const {
  const State& s = *state_;
  if (!synchronised()) return true;
  const bool has_dynamic = std::any_of(kChannels.begin(), kChannels.end(), [&s](schedules::Channel channel) {
    return !s.slots.own_dynamic(channel).empty();
  });
  return has_dynamic && s.segment == State::Segment::kDynamic;
}

void FlexRayController::advance(Microticks now) {
  for (State& s = *state_; s.due <= now; s.due = s.next_event()) s.handle(s.due);
}

void FlexRayController::receive(const Reception& reception) { state_->receive(reception); }

const std::optional<timebase::CycleClock>& FlexRayController::clock() const { return state_->clock; }
const PocState& FlexRayController::state() const { return state_->poc; }

bool FlexRayController::synchronised() const {
  return state_->poc.kind == PocKind::kNormalActive || state_->poc.kind == PocKind::kNormalPassive;
}

SlotSeen FlexRayController::slot_status(int slot, schedules::Channel channel) const {
  const State& s = *state_;
  TTF_CHECK(slot >= 1 && slot <= s.g.gNumberOfStaticSlots, "static slot {} of {}", slot, s.g.gNumberOfStaticSlots);
  const State::Seen& seen = s.seen_last[static_cast<std::size_t>(slot - 1)];
  const std::uint8_t errors = seen.errors[index_of(channel)];
  return {seen.valid[index_of(channel)], (errors & kSyntaxError) != 0, (errors & kContentError) != 0,
          (errors & kBoundaryViolation) != 0, (errors & kTransmissionConflict) != 0};
}

SyncStatus FlexRayController::sync_status() const {
  SyncStatus status = state_->sync_status;
  status.vClockCorrectionFailed = state_->poc.vClockCorrectionFailed;
  return status;
}

bool FlexRayController::send_media_test_symbol(schedules::Channels channels) {
  return state_->request_media_test_symbol(channels);
}

SymbolWindowSeen FlexRayController::symbol_window_status(schedules::Channel channel) const {
  return state_->window_last[index_of(channel)];
}

void FlexRayController::set_network_management_vector(std::span<const std::byte> vector) {
  state_->network_management.set_own(vector);
}

std::span<const std::byte> FlexRayController::network_management_vector() const {
  return state_->network_management.combined();
}

void FlexRayController::set_external_correction(int offset, int rate) {
  const schedules::NodeParameters& p = state_->p;
  state_->extern_offset = std::clamp(offset, -p.pExternOffsetCorrection, p.pExternOffsetCorrection);
  state_->extern_rate = std::clamp(rate, -p.pExternRateCorrection, p.pExternRateCorrection);
}

OutgoingList& FlexRayController::outgoing(PduId pdu) { return state_->cni.outgoing(pdu); }
IncomingList& FlexRayController::incoming(PduId pdu) { return state_->cni.incoming(pdu); }

}  // namespace ttf::bus
