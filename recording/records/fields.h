// The one description of each record's fields. The log's encoding and decoding, the times by which a log is ordered and
// merged, and the tests' texts and drawn records follow from it.
//
// A description names the record's message in the published schema (recording/log/log.proto), its instant, and each
// field with its number and name there. Numbers are part of the format: fields are appended, never renumbered, and stand
// in the order of their numbers, in which they are written. A test compares all descriptions with the schema; a member
// without a field does not compile (recording/log/decode.cc).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "recording/records/lateness_bins.h"
#include "recording/records/records.h"

namespace ttf::recording::records {

// Any value of the member's type.
struct AnyValue {};
// A number or choice from `low` to `high`; a list of `low` to `high` items.
template <class Value> struct Within { Value low, high; };

// A field that is a member: a number, a text, a message, or a list of one of them.
template <class Record, class Member, class Range> struct Field {
  std::uint32_t number;
  std::string_view name;
  Member Record::*member;
  Range range;
};
template <class Record, class Member>
constexpr Field<Record, Member, AnyValue> field(std::uint32_t number, std::string_view name, Member Record::*member) {
  return {number, name, member, {}};
}
template <class Record, class Member, class Value>
constexpr Field<Record, Member, Within<Value>> field(std::uint32_t number, std::string_view name,
                                                     Member Record::*member, Value low, Value high) {
  return {number, name, member, {low, high}};
}

// A number that old logs lack: then it is not a number. It is written even if it is 0.
template <class Record> struct Optional {
  std::uint32_t number;
  std::string_view name;
  double Record::*member;
};
template <class Record>
constexpr Optional<Record> optional(std::uint32_t number, std::string_view name, double Record::*member) {
  return {number, name, member};
}

// A member with several numbers, each a field. Their numbers follow one another.
template <class Record, std::size_t count> struct Elements {
  std::uint32_t first;
  std::array<std::string_view, count> names;
  std::array<double, count> Record::*member;
};
template <class Record, std::size_t count>
constexpr Elements<Record, count> elements(std::uint32_t first, const std::array<std::string_view, count>& names,
                                           std::array<double, count> Record::*member) {
  return {first, names, member};
}

// Entries of any types, each in a base of its own: a std::tuple of so many is dear to compile.
template <std::size_t place, class Entry> struct Placed { Entry entry; };
template <class Places, class... Listed> struct EntriesAt;
template <std::size_t... place, class... Listed>
struct EntriesAt<std::index_sequence<place...>, Listed...> : Placed<place, Listed>... {
  static constexpr std::size_t kCount = sizeof...(Listed);

  template <class F> constexpr void each(F&& f) const {
    (f(static_cast<const Placed<place, Listed>&>(*this).entry), ...);
  }
  // The same, with the others that stand in the same places.
  template <class... Others, class F>
  constexpr void each_with(EntriesAt<std::index_sequence<place...>, Others...>& others, F&& f) const {
    (f(static_cast<const Placed<place, Listed>&>(*this).entry, static_cast<Placed<place, Others>&>(others).entry), ...);
  }
};
template <class... Listed> using Entries = EntriesAt<std::index_sequence_for<Listed...>, Listed...>;

// A list whose items' members are lists of their own, of one length.
template <class Record, class Item, class... Fields> struct Columns {
  std::span<const Item> Record::*member;
  Entries<Fields...> columns;
};
template <class Record, class Item, class... Fields>
constexpr Columns<Record, Item, Fields...> columns(std::span<const Item> Record::*member, Fields... fields) {
  return {member, {{fields}...}};
}

// The instant of a record without a stamp: the true time, and the global time and node if it has them.
template <class Record> struct At {
  TrueTime Record::*true_time;
  GlobalTime Record::*global = nullptr;
  NodeId Record::*node = nullptr;
};
template <class Record> At(TrueTime Record::*) -> At<Record>;
template <class Record> At(TrueTime Record::*, GlobalTime Record::*) -> At<Record>;
template <class Record> At(TrueTime Record::*, GlobalTime Record::*, NodeId Record::*) -> At<Record>;
struct NoInstant {};  // a part of records has none

template <class Instant, class... Fields> struct Description {
  std::string_view message;  // its name in the schema
  Instant instant;           // the record's Stamp, At or NoInstant
  Entries<Fields...> fields;
};
template <class Instant, class... Fields>
constexpr Description<Instant, Fields...> message(std::string_view name, Instant instant, Fields... fields) {
  return {name, instant, {{fields}...}};
}

template <class Described> struct Is {};

constexpr auto describe(Is<Stamp>) {
  using R = Stamp;
  return message("Stamp", NoInstant{}, field(1, "true_time", &R::true_time), field(2, "local", &R::local),
                 field(3, "global", &R::global), field(4, "node", &R::node));
}
constexpr auto describe(Is<MeasurementId>) {
  using R = MeasurementId;
  return message("MeasurementId", NoInstant{}, field(1, "sensor", &R::sensor), field(2, "sequence", &R::sequence));
}
constexpr auto describe(Is<ImageObject>) {
  using R = ImageObject;
  return message("ImageObject", NoInstant{}, field(1, "track", &R::track), field(2, "x", &R::x), field(3, "y", &R::y),
                 field(4, "heading", &R::heading), field(5, "speed", &R::speed),
                 field(6, "acceleration", &R::acceleration), field(7, "length", &R::length),
                 field(8, "width", &R::width), field(9, "sigma_x", &R::sigma_x), field(10, "sigma_y", &R::sigma_y),
                 field(11, "correlation_xy", &R::correlation_xy), field(12, "sigma_heading", &R::sigma_heading),
                 field(13, "sigma_speed", &R::sigma_speed), field(14, "sigma_acceleration", &R::sigma_acceleration),
                 field(15, "sigma_length", &R::sigma_length), field(16, "sigma_width", &R::sigma_width),
                 field(17, "status", &R::status, ImageStatus{0}, ImageStatus{15}));
}

constexpr auto describe(Is<Measured>) {
  using R = Measured;
  return message("Measured", &R::stamp, field(1, "stamp", &R::stamp), field(2, "id", &R::id),
                 field(3, "truth_ids", &R::truth_ids));
}
constexpr auto describe(Is<CanFrameSent>) {
  using R = CanFrameSent;
  return message("CanFrame", &R::end, field(1, "bus", &R::bus), field(5, "identifier", &R::identifier),
                 field(6, "flexible_data_rate", &R::flexible_data_rate), field(7, "pdu", &R::pdu),
                 field(8, "sequence", &R::sequence), field(9, "fragment", &R::fragment), field(10, "data", &R::data),
                 field(11, "sensor", &R::sensor), field(12, "start", &R::start), field(13, "end", &R::end));
}
constexpr auto describe(Is<SlotFrameSent>) {
  using R = SlotFrameSent;
  return message("SlotFrame", &R::stamp, field(1, "stamp", &R::stamp), field(3, "cycle", &R::cycle),
                 field(4, "slot", &R::slot), field(5, "channel", &R::channel), field(6, "null_frame", &R::null_frame),
                 field(7, "pdu", &R::pdu), field(8, "sequence", &R::sequence), field(9, "fragment", &R::fragment),
                 field(10, "bytes", &R::bytes), field(11, "sensor", &R::sensor), field(12, "end", &R::end));
}
constexpr auto describe(Is<SlotProblem>) {
  using R = SlotProblem;
  return message("SlotProblem", &R::stamp, field(1, "stamp", &R::stamp), field(2, "cycle", &R::cycle),
                 field(3, "slot", &R::slot), field(4, "channel", &R::channel), field(5, "status", &R::status));
}
constexpr auto describe(Is<ListHop>) {
  using R = ListHop;
  return message("ListHop", &R::stamp, field(1, "stamp", &R::stamp),
                 field(2, "hop", &R::hop, Hop::kWritten, Hop::kDiscarded), field(3, "pdu", &R::pdu),
                 field(4, "sequence", &R::sequence), field(5, "can_bus", &R::can_bus), field(6, "sensor", &R::sensor));
}
constexpr auto describe(Is<TaskRun>) {
  using R = TaskRun;
  return message("TaskRun", &R::start, field(1, "start", &R::start), field(2, "task", &R::task),
                 field(5, "deadline_met", &R::deadline_met), field(6, "activated", &R::activated),
                 field(7, "end", &R::end));
}
constexpr auto describe(Is<ClockCorrected>) {
  using R = ClockCorrected;
  return message("ClockCorrected", &R::stamp, field(1, "stamp", &R::stamp), field(2, "cycle", &R::cycle),
                 field(3, "offset_microticks", &R::offset_microticks), field(4, "rate_microticks", &R::rate_microticks),
                 field(5, "offset_missing", &R::offset_missing), field(6, "rate_missing", &R::rate_missing),
                 field(7, "offset_limited", &R::offset_limited), field(8, "rate_limited", &R::rate_limited));
}
constexpr auto describe(Is<PrecisionSample>) {
  using R = PrecisionSample;
  return message("Precision", At{&R::at}, field(1, "at", &R::at), field(2, "cycle", &R::cycle),
                 field(3, "precision", &R::precision));
}
constexpr auto describe(Is<FusionInput>) {
  using R = FusionInput;
  return message("FusionInput", &R::stamp, field(1, "stamp", &R::stamp), field(2, "step", &R::step),
                 field(3, "pdu", &R::pdu), field(4, "sequence", &R::sequence), field(5, "measured", &R::measured),
                 field(6, "count", &R::count), field(7, "fragments", &R::fragments), field(8, "sensor", &R::sensor));
}
constexpr auto describe(Is<ListFused>) {
  using R = ListFused;
  return message("ListFused", &R::stamp, field(1, "stamp", &R::stamp), field(2, "step", &R::step),
                 field(3, "id", &R::id), field(4, "measured", &R::measured),
                 field(5, "disposition", &R::disposition, Disposition::kFused, Disposition::kDuplicate),
                 field(6, "innovation_squares", &R::innovation_squares),
                 field(7, "innovation_degrees", &R::innovation_degrees));
}
constexpr auto describe(Is<FusionStep>) {
  using R = FusionStep;
  return message("FusionStep", &R::stamp, field(1, "stamp", &R::stamp), field(2, "step", &R::step),
                 field(3, "confirmed", &R::confirmed), field(4, "tentative", &R::tentative));
}
constexpr auto describe(Is<TrackState>) {
  using R = TrackState;
  return message("Track", &R::stamp, field(1, "stamp", &R::stamp), field(2, "step", &R::step),
                 field(3, "track", &R::track), field(4, "valid_at", &R::valid_at), field(5, "state", &R::state),
                 field(6, "covariance", &R::covariance), field(7, "predicted_for_image", &R::predicted_for_image),
                 field(8, "box", &R::box));
}
constexpr auto describe(Is<ObservationSeen>) {
  using R = ObservationSeen;
  return message("Observation", &R::stamp, field(1, "stamp", &R::stamp), field(2, "id", &R::id),
                 field(3, "measured", &R::measured), field(4, "index", &R::index), field(5, "x", &R::x),
                 field(6, "y", &R::y), field(7, "sxx", &R::sxx), field(8, "sxy", &R::sxy), field(9, "syy", &R::syy));
}
constexpr auto describe(Is<ImageWritten>) {
  using R = ImageWritten;
  return message("Image", &R::stamp, field(1, "stamp", &R::stamp), field(2, "sequence", &R::sequence),
                 field(3, "valid_at", &R::valid_at), field(4, "newest_measurement", &R::newest_measurement),
                 field(5, "objects", &R::objects), field(6, "newest", &R::newest));
}
constexpr auto describe(Is<FeatureUsed>) {
  using R = FeatureUsed;
  using Object = FeatureObject;
  return message(
      "Feature", &R::stamp, field(1, "stamp", &R::stamp), field(2, "image_sequence", &R::image_sequence),
      field(3, "image_valid_at", &R::image_valid_at), field(4, "fresh", &R::fresh),
      columns(&R::objects, field(5, "objects", &Object::image), field(6, "time_gap_s", &Object::time_gap_s),
              field(7, "time_to_collision_s", &Object::time_to_collision_s), field(8, "warning", &Object::warning)),
      field(9, "stale", &R::stale));
}
constexpr auto describe(Is<ReferenceFix>) {
  using R = ReferenceFix;
  return message("Reference", At{&R::measured_true, &R::measured}, field(1, "measured_true", &R::measured_true),
                 field(2, "measured", &R::measured), field(3, "available", &R::available),
                 field(4, "object", &R::object), field(5, "x", &R::x), field(6, "y", &R::y),
                 field(7, "sigma", &R::sigma), optional(8, "vx", &R::vx), optional(9, "vy", &R::vy),
                 optional(10, "sigma_velocity", &R::sigma_velocity), field(11, "measured_local", &R::measured_local));
}
constexpr auto describe(Is<TruthState>) {
  using R = TruthState;
  return message("Truth", At{&R::at, &R::global, &R::node}, field(1, "at", &R::at), field(2, "object", &R::object),
                 field(3, "x", &R::x), field(4, "y", &R::y), field(5, "heading", &R::heading),
                 field(6, "speed", &R::speed), field(7, "acceleration", &R::acceleration),
                 field(8, "yaw_rate", &R::yaw_rate), field(9, "length", &R::length), field(10, "width", &R::width),
                 field(11, "local", &R::local), field(12, "global", &R::global), field(13, "node", &R::node),
                 field(14, "out_of_view", &R::out_of_view));
}
constexpr auto describe(Is<StateChanged>) {
  using R = StateChanged;
  return message("StateChange", &R::stamp, field(1, "stamp", &R::stamp), field(2, "from", &R::from),
                 field(3, "to", &R::to), field(4, "from_name", &R::from_name), field(5, "to_name", &R::to_name),
                 field(6, "why", &R::why), field(7, "consequence", &R::consequence));
}
constexpr auto describe(Is<SymbolSent>) {
  using R = SymbolSent;
  return message("Symbol", &R::stamp, field(1, "stamp", &R::stamp), field(2, "end", &R::end),
                 field(3, "channel", &R::channel), field(4, "kind", &R::kind, Symbol::kCas, Symbol::kMediaTest));
}
constexpr auto describe(Is<PowerChanged>) {
  using R = PowerChanged;
  return message("Power", &R::stamp, field(1, "stamp", &R::stamp), field(2, "on", &R::on));
}
constexpr auto describe(Is<FaultActivity>) {
  using R = FaultActivity;
  return message("Fault", At{&R::at}, field(1, "at", &R::at), field(2, "fault", &R::fault),
                 field(3, "what", &R::what, FaultAct::kBegins, FaultAct::kEnds), field(4, "node", &R::node),
                 field(5, "kind", &R::kind), field(6, "text", &R::text));
}
constexpr auto describe(Is<GuardianIntervention>) {
  using R = GuardianIntervention;
  return message("Guardian", At{&R::at}, field(1, "at", &R::at), field(2, "branch", &R::branch),
                 field(3, "channel", &R::channel, std::uint8_t{0}, std::uint8_t{1}),
                 field(4, "signal", &R::signal, GuardedSignal::kFrame, GuardedSignal::kUndecodable),
                 field(5, "reason", &R::reason), field(6, "cut", &R::cut), field(7, "until", &R::until),
                 field(8, "why", &R::why));
}
constexpr auto describe(Is<ChannelFrame>) {
  using R = ChannelFrame;
  return message("ChannelFrame", At{&R::start}, field(1, "start", &R::start), field(2, "end", &R::end),
                 field(3, "sender", &R::sender), field(4, "channel", &R::channel),
                 field(5, "state", &R::state, ChannelState{0}, ChannelState{31}), field(6, "slot", &R::slot),
                 field(7, "cycle_counter", &R::cycle_counter), field(8, "sent", &R::sent),
                 field(9, "sent_channel", &R::sent_channel), field(10, "bytes", &R::bytes));
}
constexpr auto describe(Is<TimingProblem>) {
  using R = TimingProblem;
  return message("TimingProblem", &R::stamp, field(1, "stamp", &R::stamp),
                 field(2, "what", &R::what, TimingFault::kLateWakeUp, TimingFault::kFramesLost),
                 field(3, "late", &R::late), field(4, "cycle", &R::cycle), field(5, "slot", &R::slot),
                 field(6, "channel", &R::channel, std::uint8_t{0}, std::uint8_t{1}), field(7, "count", &R::count));
}
constexpr auto describe(Is<LatenessHistogram>) {
  using R = LatenessHistogram;
  return message("Lateness", &R::stamp, field(1, "stamp", &R::stamp),
                 field(2, "of", &R::of, LatenessOf::kWakeUps, LatenessOf::kTransits), field(3, "longest", &R::longest),
                 field(4, "counts", &R::counts, std::size_t{0}, kLatenessBins));
}
constexpr auto describe(Is<MediumCounts>) {
  using R = MediumCounts;
  return message("Medium", &R::stamp, field(1, "stamp", &R::stamp), field(2, "sent", &R::sent),
                 field(3, "received", &R::received), field(4, "not_sent", &R::not_sent), field(5, "lost", &R::lost),
                 field(6, "foreign", &R::foreign), field(7, "malformed", &R::malformed),
                 field(8, "dropped", &R::dropped));
}
constexpr auto describe(Is<CanErrorFrame>) {
  using R = CanErrorFrame;
  return message("CanError", &R::stamp, field(1, "stamp", &R::stamp), field(2, "bus", &R::bus),
                 field(3, "error", &R::error, CanError::kBit, CanError::kAcknowledgement),
                 field(4, "as_transmitter", &R::as_transmitter), field(5, "transmit_errors", &R::transmit_errors),
                 field(6, "receive_errors", &R::receive_errors));
}
constexpr auto describe(Is<CanStateChanged>) {
  using R = CanStateChanged;
  return message("CanState", &R::stamp, field(1, "stamp", &R::stamp), field(2, "bus", &R::bus),
                 field(3, "from", &R::from, CanState::kActive, CanState::kBusOff),
                 field(4, "to", &R::to, CanState::kActive, CanState::kBusOff),
                 field(5, "transmit_errors", &R::transmit_errors), field(6, "receive_errors", &R::receive_errors));
}
constexpr auto describe(Is<OdometryTaken>) {
  using R = OdometryTaken;
  return message("Odometry", &R::stamp, field(1, "stamp", &R::stamp), field(2, "step", &R::step),
                 field(3, "id", &R::id), field(4, "measured", &R::measured), field(5, "speed", &R::speed),
                 field(6, "yaw_rate", &R::yaw_rate), field(7, "sigma_speed", &R::sigma_speed),
                 field(8, "sigma_yaw_rate", &R::sigma_yaw_rate), field(9, "stopped", &R::stopped));
}
constexpr auto describe(Is<EgoTruth>) {
  using R = EgoTruth;
  return message("Ego", At{&R::at, &R::global, &R::node}, field(1, "at", &R::at), field(2, "x", &R::x),
                 field(3, "y", &R::y), field(4, "heading", &R::heading), field(5, "vx", &R::vx), field(6, "vy", &R::vy),
                 field(7, "yaw_rate", &R::yaw_rate), field(8, "acceleration", &R::acceleration),
                 field(9, "local", &R::local), field(10, "global", &R::global), field(11, "node", &R::node));
}
constexpr auto describe(Is<Warning>) {
  using R = Warning;
  return message("Warning", &R::stamp, field(1, "stamp", &R::stamp), field(2, "service", &R::service),
                 field(3, "on", &R::on), field(4, "track", &R::track),
                 field(5, "time_to_collision", &R::time_to_collision_s));
}
constexpr auto describe(Is<CommandIssued>) {
  using R = CommandIssued;
  return message("Command", &R::stamp, field(1, "stamp", &R::stamp), field(2, "pdu", &R::pdu),
                 field(3, "sequence", &R::sequence), field(4, "valid", &R::valid), field(5, "reason", &R::reason),
                 field(6, "acceleration", &R::acceleration), field(7, "steering", &R::steering),
                 field(8, "own_speed", &R::own_speed), field(9, "gap", &R::gap),
                 field(10, "speed_ahead", &R::speed_ahead), field(11, "track", &R::track));
}
constexpr auto describe(Is<CommandTaken>) {
  using R = CommandTaken;
  return message("Actuator", &R::stamp, field(1, "stamp", &R::stamp), field(2, "pdu", &R::pdu),
                 field(3, "sequence", &R::sequence), field(4, "verdict", &R::verdict),
                 field(5, "acceleration", &R::acceleration), field(6, "steering", &R::steering),
                 field(7, "from", &R::from));
}
constexpr auto describe(Is<DetectionMade>) {
  using R = DetectionMade;
  return message("Detection", &R::stamp, field(1, "stamp", &R::stamp), field(2, "begin", &R::begin),
                 field(3, "id", &R::id), field(4, "frame", &R::frame), field(5, "place", &R::place),
                 field(6, "secondary", &R::secondary), field(7, "area", &R::area), field(8, "took", &R::took),
                 field(9, "found", &R::found));
}
constexpr auto describe(Is<SequencePlanned>) {
  using R = SequencePlanned;
  return message("Sequence", &R::stamp, field(1, "stamp", &R::stamp), field(2, "frame", &R::frame),
                 field(3, "text", &R::text), field(4, "bound", &R::bound), field(5, "length", &R::length));
}
constexpr auto describe(Is<PlanMade>) {
  using R = PlanMade;
  return message("Plan", &R::stamp, field(1, "stamp", &R::stamp), field(2, "pdu", &R::pdu),
                 field(3, "sequence", &R::sequence), field(4, "valid", &R::valid), field(5, "state", &R::state),
                 field(6, "speed", &R::speed), field(7, "track", &R::track), field(8, "gap", &R::gap),
                 field(9, "speed_ahead", &R::speed_ahead), field(10, "own_speed", &R::own_speed),
                 field(11, "along", &R::along), field(12, "offset", &R::offset), field(13, "heading", &R::heading),
                 field(14, "camera", &R::camera),
                 elements(15, std::array<std::string_view, 4>{"region_x", "region_y", "region_width", "region_height"},
                          &R::region));
}

template <class Described>
concept IsDescribed = requires {
  describe(Is<Described>{});
};
template <class Described> constexpr auto description() {
  static_assert(IsDescribed<Described>, "a kind of record whose fields are not described");
  if constexpr (IsDescribed<Described>) return describe(Is<Described>{});
}
template <class Described> inline constexpr auto kDescription = description<Described>();

// Calls `f` with each entry of a description, in the order of the numbers.
template <class Described, class F> constexpr void for_each_field(F&& f) { kDescription<Described>.fields.each(f); }

}  // namespace ttf::recording::records
