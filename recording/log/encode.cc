#include <utility>

#include "recording/log/codec.h"
#include "recording/records/every.h"

namespace ttf::recording::log {
namespace {

template <class Enum> constexpr std::uint32_t number(Enum value) { return static_cast<std::uint32_t>(value); }

void fill(ttfusion::Stamp& out, const records::Stamp& in) {
  out.set_true_time(in.true_time.ns);
  out.set_local(in.local.ns);
  out.set_global(in.global.ns);
  out.set_node(number(in.node));
}

void fill(ttfusion::MeasurementId& out, const MeasurementId& in) {
  out.set_sensor(number(in.sensor));
  out.set_sequence(in.sequence);
}

void fill(ttfusion::ImageObject& out, const records::ImageObject& in) {
  out.set_track(number(in.track));
  out.set_x(in.x);
  out.set_y(in.y);
  out.set_heading(in.heading);
  out.set_speed(in.speed);
  out.set_acceleration(in.acceleration);
  out.set_length(in.length);
  out.set_width(in.width);
  out.set_sigma_x(in.sigma_x);
  out.set_sigma_y(in.sigma_y);
  out.set_correlation_xy(in.correlation_xy);
  out.set_sigma_heading(in.sigma_heading);
  out.set_sigma_speed(in.sigma_speed);
  out.set_sigma_acceleration(in.sigma_acceleration);
  out.set_sigma_length(in.sigma_length);
  out.set_sigma_width(in.sigma_width);
  out.set_status(in.status);
}

LogTimes times_of(const records::Stamp& stamp) { return {stamp.true_time.ns, stamp.global.ns}; }

// Assigns in place: the string grows to the longest text, then no more.
void fill_text(std::string& out, std::string_view in) { out.assign(in); }

void fill_bytes(std::string& out, std::span<const std::byte> in) {
  out.assign(reinterpret_cast<const char*>(in.data()), in.size());
}

LogTimes encode(const records::Measured& in, ttfusion::Measured& out) {
  fill(*out.mutable_stamp(), in.stamp);
  fill(*out.mutable_id(), in.id);
  out.clear_truth_ids();
  for (const ObjectId id : in.truth_ids) out.add_truth_ids(number(id));
  return times_of(in.stamp);
}

LogTimes encode(const records::CanFrameSent& in, ttfusion::CanFrame& out) {
  out.set_bus(in.bus);
  fill(*out.mutable_start(), in.start);
  fill(*out.mutable_end(), in.end);
  out.set_identifier(in.identifier);
  out.set_flexible_data_rate(in.flexible_data_rate);
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_fragment(in.fragment);
  out.set_sensor(number(in.sensor));
  fill_bytes(*out.mutable_data(), in.data);
  return times_of(in.end);
}

LogTimes encode(const records::SlotFrameSent& in, ttfusion::SlotFrame& out) {
  fill(*out.mutable_stamp(), in.stamp);
  fill(*out.mutable_end(), in.end);
  out.set_cycle(in.cycle);
  out.set_slot(in.slot);
  out.set_channel(in.channel);
  out.set_null_frame(in.null_frame);
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_fragment(in.fragment);
  out.set_sensor(number(in.sensor));
  fill_bytes(*out.mutable_bytes(), in.bytes);
  return times_of(in.stamp);
}

LogTimes encode(const records::SlotProblem& in, ttfusion::SlotProblem& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_cycle(in.cycle);
  out.set_slot(in.slot);
  out.set_channel(in.channel);
  out.set_status(in.status);
  return times_of(in.stamp);
}

LogTimes encode(const records::ListHop& in, ttfusion::ListHop& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_hop(number(in.hop));
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_can_bus(in.can_bus);
  out.set_sensor(number(in.sensor));
  return times_of(in.stamp);
}

LogTimes encode(const records::TaskRun& in, ttfusion::TaskRun& out) {
  fill(*out.mutable_start(), in.start);
  out.set_task(in.task);
  fill(*out.mutable_activated(), in.activated);
  fill(*out.mutable_end(), in.end);
  out.set_deadline_met(in.deadline_met);
  return times_of(in.start);
}

LogTimes encode(const records::ClockCorrected& in, ttfusion::ClockCorrected& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_cycle(in.cycle);
  out.set_offset_microticks(in.offset_microticks);
  out.set_rate_microticks(in.rate_microticks);
  out.set_offset_missing(in.offset_missing);
  out.set_rate_missing(in.rate_missing);
  out.set_offset_limited(in.offset_limited);
  out.set_rate_limited(in.rate_limited);
  return times_of(in.stamp);
}

LogTimes encode(const records::PrecisionSample& in, ttfusion::Precision& out) {
  out.set_at(in.at.ns);
  out.set_cycle(in.cycle);
  out.set_precision(in.precision.ns);
  return {in.at.ns, in.at.ns};
}

LogTimes encode(const records::FusionInput& in, ttfusion::FusionInput& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_step(in.step);
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_measured(in.measured.ns);
  out.set_count(in.count);
  out.set_sensor(number(in.sensor));
  fill_bytes(*out.mutable_fragments(), in.fragments);
  return times_of(in.stamp);
}

LogTimes encode(const records::ListFused& in, ttfusion::ListFused& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_step(in.step);
  fill(*out.mutable_id(), in.id);
  out.set_measured(in.measured.ns);
  out.set_disposition(number(in.disposition));
  out.set_innovation_squares(in.innovation_squares);
  out.set_innovation_degrees(in.innovation_degrees);
  return times_of(in.stamp);
}

LogTimes encode(const records::OdometryTaken& in, ttfusion::Odometry& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_step(in.step);
  fill(*out.mutable_id(), in.id);
  out.set_measured(in.measured.ns);
  out.set_speed(in.speed);
  out.set_yaw_rate(in.yaw_rate);
  out.set_sigma_speed(in.sigma_speed);
  out.set_sigma_yaw_rate(in.sigma_yaw_rate);
  out.set_stopped(in.stopped);
  return times_of(in.stamp);
}

LogTimes encode(const records::FusionStep& in, ttfusion::FusionStep& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_step(in.step);
  out.set_confirmed(in.confirmed);
  out.set_tentative(in.tentative);
  return times_of(in.stamp);
}

LogTimes encode(const records::TrackState& in, ttfusion::Track& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_step(in.step);
  out.set_track(number(in.track));
  out.set_valid_at(in.valid_at.ns);
  out.clear_state();
  out.clear_covariance();
  for (const double value : in.state) out.add_state(value);
  for (const double value : in.covariance) out.add_covariance(value);
  out.set_predicted_for_image(in.predicted_for_image);
  out.clear_box();
  if (in.box) {
    const records::BelievedBox& box = *in.box;
    for (const records::Believed* one : {&box.heading, &box.speed, &box.acceleration, &box.length, &box.width}) {
      out.add_box(one->value);
      out.add_box(one->sigma);
    }
  }
  return times_of(in.stamp);
}

LogTimes encode(const records::ObservationSeen& in, ttfusion::Observation& out) {
  fill(*out.mutable_stamp(), in.stamp);
  fill(*out.mutable_id(), in.id);
  out.set_measured(in.measured.ns);
  out.set_index(in.index);
  out.set_x(in.x);
  out.set_y(in.y);
  out.set_sxx(in.sxx);
  out.set_sxy(in.sxy);
  out.set_syy(in.syy);
  return times_of(in.stamp);
}

LogTimes encode(const records::ImageWritten& in, ttfusion::Image& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_sequence(in.sequence);
  out.set_valid_at(in.valid_at.ns);
  out.set_newest_measurement(in.newest_measurement.ns);
  out.clear_objects();
  out.clear_newest();
  for (const auto& object : in.objects) fill(*out.add_objects(), object);
  for (const auto& id : in.newest) fill(*out.add_newest(), id);
  return times_of(in.stamp);
}

LogTimes encode(const records::FeatureUsed& in, ttfusion::Feature& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_image_sequence(in.image_sequence);
  out.set_image_valid_at(in.image_valid_at.ns);
  out.set_fresh(in.fresh);
  out.set_stale(in.stale);
  out.clear_objects();
  out.clear_time_gap_s();
  out.clear_time_to_collision_s();
  out.clear_warning();
  for (const auto& object : in.objects) {
    fill(*out.add_objects(), object.image);
    out.add_time_gap_s(object.time_gap_s);
    out.add_time_to_collision_s(object.time_to_collision_s);
    out.add_warning(object.warning);
  }
  return times_of(in.stamp);
}

LogTimes encode(const records::ReferenceFix& in, ttfusion::Reference& out) {
  out.set_measured_true(in.measured_true.ns);
  out.set_measured(in.measured.ns);
  out.set_available(in.available.ns);
  out.set_object(number(in.object));
  out.set_x(in.x);
  out.set_y(in.y);
  out.set_sigma(in.sigma);
  out.set_vx(in.vx);
  out.set_vy(in.vy);
  out.set_sigma_velocity(in.sigma_velocity);
  out.set_measured_local(in.measured_local.ns);
  return {in.measured_true.ns, in.measured.ns};
}

LogTimes encode(const records::TruthState& in, ttfusion::Truth& out) {
  out.set_at(in.at.ns);
  out.set_object(number(in.object));
  out.set_x(in.x);
  out.set_y(in.y);
  out.set_heading(in.heading);
  out.set_speed(in.speed);
  out.set_acceleration(in.acceleration);
  out.set_yaw_rate(in.yaw_rate);
  out.set_length(in.length);
  out.set_width(in.width);
  out.set_local(in.local.ns);
  out.set_global(in.global.ns);
  out.set_node(number(in.node));
  return {in.at.ns, in.global.ns};
}

LogTimes encode(const records::Warning& in, ttfusion::Warning& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_service(in.service);
  out.set_on(in.on);
  out.set_track(number(in.track));
  out.set_time_to_collision(in.time_to_collision_s);
  return times_of(in.stamp);
}

LogTimes encode(const records::CommandIssued& in, ttfusion::Command& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_valid(in.valid);
  out.set_reason(in.reason);
  out.set_acceleration(in.acceleration);
  out.set_steering(in.steering);
  out.set_own_speed(in.own_speed);
  out.set_gap(in.gap);
  out.set_speed_ahead(in.speed_ahead);
  out.set_track(number(in.track));
  return times_of(in.stamp);
}

LogTimes encode(const records::CommandTaken& in, ttfusion::Actuator& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_verdict(in.verdict);
  out.set_acceleration(in.acceleration);
  out.set_steering(in.steering);
  out.set_from(in.from.ns);
  return times_of(in.stamp);
}

LogTimes encode(const records::DetectionMade& in, ttfusion::Detection& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_begin(in.begin.ns);
  fill(*out.mutable_id(), in.id);
  out.set_frame(in.frame);
  out.set_place(in.place);
  out.set_secondary(in.secondary);
  out.set_area(in.area);
  out.set_took(in.took.ns);
  out.set_found(in.found);
  return times_of(in.stamp);
}

LogTimes encode(const records::SequencePlanned& in, ttfusion::Sequence& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_frame(in.frame);
  out.set_text(in.text.data(), in.text.size());
  out.set_bound(in.bound.ns);
  out.set_length(in.length.ns);
  return times_of(in.stamp);
}

LogTimes encode(const records::PlanMade& in, ttfusion::Plan& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_pdu(number(in.pdu));
  out.set_sequence(in.sequence);
  out.set_valid(in.valid);
  out.set_state(in.state);
  out.set_speed(in.speed);
  out.set_track(number(in.track));
  out.set_gap(in.gap);
  out.set_speed_ahead(in.speed_ahead);
  out.set_own_speed(in.own_speed);
  out.set_along(in.along);
  out.set_offset(in.offset);
  out.set_heading(in.heading);
  out.set_camera(number(in.camera));
  out.set_region_x(in.region[0]);
  out.set_region_y(in.region[1]);
  out.set_region_width(in.region[2]);
  out.set_region_height(in.region[3]);
  return times_of(in.stamp);
}

LogTimes encode(const records::EgoTruth& in, ttfusion::Ego& out) {
  out.set_at(in.at.ns);
  out.set_x(in.x);
  out.set_y(in.y);
  out.set_heading(in.heading);
  out.set_vx(in.vx);
  out.set_vy(in.vy);
  out.set_yaw_rate(in.yaw_rate);
  out.set_acceleration(in.acceleration);
  out.set_local(in.local.ns);
  out.set_global(in.global.ns);
  out.set_node(number(in.node));
  return {in.at.ns, in.global.ns};
}

LogTimes encode(const records::StateChanged& in, ttfusion::StateChange& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_from(in.from);
  out.set_to(in.to);
  fill_text(*out.mutable_from_name(), in.from_name);
  fill_text(*out.mutable_to_name(), in.to_name);
  fill_text(*out.mutable_why(), in.why);
  fill_text(*out.mutable_consequence(), in.consequence);
  return times_of(in.stamp);
}

LogTimes encode(const records::SymbolSent& in, ttfusion::Symbol& out) {
  fill(*out.mutable_stamp(), in.stamp);
  fill(*out.mutable_end(), in.end);
  out.set_channel(in.channel);
  out.set_kind(in.kind);
  return times_of(in.stamp);
}

LogTimes encode(const records::PowerChanged& in, ttfusion::Power& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_on(in.on);
  return times_of(in.stamp);
}

LogTimes encode(const records::FaultActivity& in, ttfusion::Fault& out) {
  out.set_at(in.at.ns);
  out.set_fault(in.fault);
  out.set_what(in.what);
  out.set_node(number(in.node));
  fill_text(*out.mutable_kind(), in.kind);
  fill_text(*out.mutable_text(), in.text);
  return {in.at.ns, in.at.ns};
}

LogTimes encode(const records::GuardianIntervention& in, ttfusion::Guardian& out) {
  out.set_at(in.at.ns);
  out.set_branch(number(in.branch));
  out.set_channel(in.channel);
  out.set_signal(in.signal);
  out.set_reason(in.reason);
  out.set_cut(in.cut);
  out.set_until(in.until.ns);
  fill_text(*out.mutable_why(), in.why);
  return {in.at.ns, in.at.ns};
}

LogTimes encode(const records::ChannelFrame& in, ttfusion::ChannelFrame& out) {
  out.set_start(in.start.ns);
  out.set_end(in.end.ns);
  out.set_sender(number(in.sender));
  out.set_channel(in.channel);
  out.set_state(in.state);
  out.set_slot(in.slot);
  out.set_cycle_counter(in.cycle_counter);
  out.set_sent(in.sent.ns);
  out.set_sent_channel(in.sent_channel);
  fill_bytes(*out.mutable_bytes(), in.bytes);
  return {in.start.ns, in.start.ns};
}

LogTimes encode(const records::TimingProblem& in, ttfusion::TimingProblem& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_what(in.what);
  out.set_late(in.late.ns);
  out.set_cycle(in.cycle);
  out.set_slot(in.slot);
  out.set_channel(in.channel);
  out.set_count(in.count);
  return times_of(in.stamp);
}

LogTimes encode(const records::LatenessHistogram& in, ttfusion::Lateness& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_of(in.of);
  out.set_longest(in.longest.ns);
  out.clear_counts();
  for (const std::uint64_t count : in.counts) out.add_counts(count);
  return times_of(in.stamp);
}

LogTimes encode(const records::CanErrorFrame& in, ttfusion::CanError& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_bus(in.bus);
  out.set_error(in.error);
  out.set_as_transmitter(in.as_transmitter);
  out.set_transmit_errors(in.transmit_errors);
  out.set_receive_errors(in.receive_errors);
  return times_of(in.stamp);
}

LogTimes encode(const records::CanStateChanged& in, ttfusion::CanState& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_bus(in.bus);
  out.set_from(in.from);
  out.set_to(in.to);
  out.set_transmit_errors(in.transmit_errors);
  out.set_receive_errors(in.receive_errors);
  return times_of(in.stamp);
}

LogTimes encode(const records::MediumCounts& in, ttfusion::Medium& out) {
  fill(*out.mutable_stamp(), in.stamp);
  out.set_sent(in.sent);
  out.set_received(in.received);
  out.set_not_sent(in.not_sent);
  out.set_lost(in.lost);
  out.set_foreign(in.foreign);
  out.set_malformed(in.malformed);
  out.set_dropped(in.dropped);
  return times_of(in.stamp);
}

class Encoder final : public records::Every<Encoder> {
 public:
  Encoder(Payloads& payloads, std::function<void(const Encoded&)> out) : payloads_(payloads), out_(std::move(out)) {}

  template <class Record> void each(const Record& record) {
    Payload<Record>& payload = payloads_.of<Record>();
    static_assert(
        requires { encode(record, payload); }, "a kind of record that the log does not encode");
    const LogTimes times = encode(record, payload);
    out_({records::kKindOf<Record>, payload, times});
  }

 private:
  Payloads& payloads_;
  std::function<void(const Encoded&)> out_;
};

}  // namespace

std::unique_ptr<records::Sink> encoder(Payloads& payloads, std::function<void(const Encoded&)> out) {
  return std::make_unique<Encoder>(payloads, std::move(out));
}

}  // namespace ttf::recording::log
