#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "recording/log/codec.h"
#include "recording/records/lateness_bins.h"

namespace ttf::recording::log {
namespace {

// Narrows a payload's values to a record's types, and remembers whether all of them fitted.
class Reading {
 public:
  explicit Reading(Decoder::Lists& kept) : lists(kept) {}

  template <class Out, class In>
  Out to(In value, Out low = std::numeric_limits<Out>::min(), Out high = std::numeric_limits<Out>::max()) {
    must(value >= static_cast<In>(low) && value <= static_cast<In>(high));
    return static_cast<Out>(value);
  }
  template <class Enum> Enum id(std::uint32_t value) {
    return static_cast<Enum>(to<std::underlying_type_t<Enum>>(value));
  }
  template <class Enum> Enum choice(std::uint32_t value, Enum low, Enum high) {
    using Number = std::underlying_type_t<Enum>;
    return static_cast<Enum>(to<Number>(value, static_cast<Number>(low), static_cast<Number>(high)));
  }
  records::Stamp stamp(const ttfusion::Stamp& in) {
    return {TrueTime{in.true_time()}, LocalTime{in.local()}, GlobalTime{in.global()}, id<NodeId>(in.node())};
  }
  MeasurementId measurement(const ttfusion::MeasurementId& in) { return {id<SensorId>(in.sensor()), in.sequence()}; }
  records::ImageObject object(const ttfusion::ImageObject& in) {
    return {id<TrackId>(in.track()),
            in.x(),
            in.y(),
            in.heading(),
            in.speed(),
            in.acceleration(),
            in.length(),
            in.width(),
            in.sigma_x(),
            in.sigma_y(),
            in.correlation_xy(),
            in.sigma_heading(),
            in.sigma_speed(),
            in.sigma_acceleration(),
            in.sigma_length(),
            in.sigma_width(),
            to<std::uint8_t>(in.status(), std::uint8_t{0}, std::uint8_t{15})};
  }
  template <int n> std::span<const double, n> exactly(const google::protobuf::RepeatedField<double>& in) {
    static constexpr std::array<double, n> kNone{};
    must(in.size() == n);
    return std::span<const double, n>(in.size() == n ? in.data() : kNone.data(), n);
  }
  std::optional<records::BelievedBox> box(const google::protobuf::RepeatedField<double>& in) {
    if (in.empty()) return std::nullopt;
    const std::span<const double, 10> all = exactly<10>(in);
    return records::BelievedBox{
        {all[0], all[1]}, {all[2], all[3]}, {all[4], all[5]}, {all[6], all[7]}, {all[8], all[9]}};
  }
  void must(bool holds) { ok_ = ok_ && holds; }
  bool ok() const { return ok_; }

  Decoder::Lists& lists;

 private:
  bool ok_ = true;
};

std::span<const std::byte> bytes_of(const std::string& in) {
  return {reinterpret_cast<const std::byte*>(in.data()), in.size()};
}

records::Measured record_of(const ttfusion::Measured& in, Reading& read) {
  read.lists.truth_ids.clear();
  for (const std::uint32_t id : in.truth_ids()) read.lists.truth_ids.push_back(read.id<ObjectId>(id));
  return {read.stamp(in.stamp()), read.measurement(in.id()), read.lists.truth_ids};
}

records::CanFrameSent record_of(const ttfusion::CanFrame& in, Reading& read) {
  return {read.to<std::uint8_t>(in.bus()),
          read.stamp(in.start()),
          read.stamp(in.end()),
          in.identifier(),
          in.flexible_data_rate(),
          read.id<PduId>(in.pdu()),
          read.id<SensorId>(in.sensor()),
          in.sequence(),
          read.to<std::uint8_t>(in.fragment()),
          bytes_of(in.data())};
}

records::SlotFrameSent record_of(const ttfusion::SlotFrame& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.stamp(in.end()),
          in.cycle(),
          read.to<std::uint16_t>(in.slot()),
          read.to<std::uint8_t>(in.channel()),
          in.null_frame(),
          read.id<PduId>(in.pdu()),
          read.id<SensorId>(in.sensor()),
          in.sequence(),
          read.to<std::uint8_t>(in.fragment()),
          bytes_of(in.bytes())};
}

records::SlotProblem record_of(const ttfusion::SlotProblem& in, Reading& read) {
  return {read.stamp(in.stamp()), in.cycle(), read.to<std::uint16_t>(in.slot()), read.to<std::uint8_t>(in.channel()),
          read.to<std::uint8_t>(in.status())};
}

records::ListHop record_of(const ttfusion::ListHop& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.choice(in.hop(), records::Hop::kWritten, records::Hop::kDiscarded),
          read.id<PduId>(in.pdu()),
          read.id<SensorId>(in.sensor()),
          in.sequence(),
          read.to<std::int8_t>(in.can_bus())};
}

records::TaskRun record_of(const ttfusion::TaskRun& in, Reading& read) {
  return {read.stamp(in.start()), read.to<std::uint8_t>(in.task()), read.stamp(in.activated()), read.stamp(in.end()),
          in.deadline_met()};
}

records::ClockCorrected record_of(const ttfusion::ClockCorrected& in, Reading& read) {
  return {read.stamp(in.stamp()), in.cycle(),        in.offset_microticks(), in.rate_microticks(),
          in.offset_missing(),    in.rate_missing(), in.offset_limited(),    in.rate_limited()};
}

records::PrecisionSample record_of(const ttfusion::Precision& in, Reading&) {
  return {TrueTime{in.at()}, in.cycle(), Duration{in.precision()}};
}

records::FusionInput record_of(const ttfusion::FusionInput& in, Reading& read) {
  return {read.stamp(in.stamp()),
          in.step(),
          read.id<PduId>(in.pdu()),
          read.id<SensorId>(in.sensor()),
          in.sequence(),
          GlobalTime{in.measured()},
          read.to<std::uint16_t>(in.count()),
          bytes_of(in.fragments())};
}

records::ListFused record_of(const ttfusion::ListFused& in, Reading& read) {
  return {read.stamp(in.stamp()),
          in.step(),
          read.measurement(in.id()),
          GlobalTime{in.measured()},
          read.choice(in.disposition(), records::Disposition::kFused, records::Disposition::kDuplicate),
          in.innovation_squares(),
          in.innovation_degrees()};
}

records::OdometryTaken record_of(const ttfusion::Odometry& in, Reading& read) {
  return {read.stamp(in.stamp()),    in.step(),           read.measurement(in.id()),
          GlobalTime{in.measured()}, in.speed(),          in.yaw_rate(),
          in.sigma_speed(),          in.sigma_yaw_rate(), in.stopped()};
}

records::FusionStep record_of(const ttfusion::FusionStep& in, Reading& read) {
  return {read.stamp(in.stamp()), in.step(), read.to<std::uint16_t>(in.confirmed()),
          read.to<std::uint16_t>(in.tentative())};
}

records::TrackState record_of(const ttfusion::Track& in, Reading& read) {
  return {read.stamp(in.stamp()),       in.step(),
          read.id<TrackId>(in.track()), GlobalTime{in.valid_at()},
          read.exactly<6>(in.state()),  read.exactly<36>(in.covariance()),
          in.predicted_for_image(),     read.box(in.box())};
}

records::ObservationSeen record_of(const ttfusion::Observation& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.measurement(in.id()),
          GlobalTime{in.measured()},
          read.to<std::uint16_t>(in.index()),
          in.x(),
          in.y(),
          in.sxx(),
          in.sxy(),
          in.syy()};
}

records::ImageWritten record_of(const ttfusion::Image& in, Reading& read) {
  read.lists.image_objects.clear();
  read.lists.newest.clear();
  for (const auto& object : in.objects()) read.lists.image_objects.push_back(read.object(object));
  for (const auto& id : in.newest()) read.lists.newest.push_back(read.measurement(id));
  return {read.stamp(in.stamp()),   in.sequence(),    GlobalTime{in.valid_at()}, GlobalTime{in.newest_measurement()},
          read.lists.image_objects, read.lists.newest};
}

records::FeatureUsed record_of(const ttfusion::Feature& in, Reading& read) {
  read.lists.feature_objects.clear();
  const int objects = in.objects_size();
  const bool parallel =
      in.time_gap_s_size() == objects && in.time_to_collision_s_size() == objects && in.warning_size() == objects;
  read.must(parallel);
  for (int i = 0; parallel && i < objects; ++i)
    read.lists.feature_objects.push_back(
        {read.object(in.objects(i)), in.time_gap_s(i), in.time_to_collision_s(i), in.warning(i)});
  return {read.stamp(in.stamp()),     in.image_sequence(), GlobalTime{in.image_valid_at()}, in.fresh(),
          read.lists.feature_objects, in.stale()};
}

records::ReferenceFix record_of(const ttfusion::Reference& in, Reading& read) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {TrueTime{in.measured_true()},
          GlobalTime{in.measured()},
          GlobalTime{in.available()},
          read.id<ObjectId>(in.object()),
          in.x(),
          in.y(),
          in.sigma(),
          in.has_vx() ? in.vx() : kNone,
          in.has_vy() ? in.vy() : kNone,
          in.has_sigma_velocity() ? in.sigma_velocity() : kNone,
          LocalTime{in.measured_local()}};
}

records::TruthState record_of(const ttfusion::Truth& in, Reading& read) {
  return {TrueTime{in.at()},
          read.id<ObjectId>(in.object()),
          in.x(),
          in.y(),
          in.heading(),
          in.speed(),
          in.acceleration(),
          in.yaw_rate(),
          in.length(),
          in.width(),
          LocalTime{in.local()},
          GlobalTime{in.global()},
          read.id<NodeId>(in.node())};
}

records::Warning record_of(const ttfusion::Warning& in, Reading& read) {
  return {read.stamp(in.stamp()), read.to<std::uint8_t>(in.service()), in.on(), read.id<TrackId>(in.track()),
          in.time_to_collision()};
}

records::CommandIssued record_of(const ttfusion::Command& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.id<PduId>(in.pdu()),
          in.sequence(),
          in.valid(),
          read.to<std::uint8_t>(in.reason()),
          in.acceleration(),
          in.steering(),
          in.own_speed(),
          in.gap(),
          in.speed_ahead(),
          read.id<TrackId>(in.track())};
}

records::CommandTaken record_of(const ttfusion::Actuator& in, Reading& read) {
  return {read.stamp(in.stamp()), read.id<PduId>(in.pdu()),
          in.sequence(),          read.to<std::uint8_t>(in.verdict()),
          in.acceleration(),      in.steering(),
          TrueTime{in.from()}};
}

records::DetectionMade record_of(const ttfusion::Detection& in, Reading& read) {
  return {read.stamp(in.stamp()),
          TrueTime{in.begin()},
          read.measurement(in.id()),
          in.frame(),
          read.to<std::uint16_t>(in.place()),
          in.secondary(),
          in.area(),
          Duration{in.took()},
          read.to<std::uint16_t>(in.found())};
}

records::SequencePlanned record_of(const ttfusion::Sequence& in, Reading& read) {
  return {read.stamp(in.stamp()), in.frame(), in.text(), Duration{in.bound()}, Duration{in.length()}};
}

records::PlanMade record_of(const ttfusion::Plan& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.id<PduId>(in.pdu()),
          in.sequence(),
          in.valid(),
          read.to<std::uint8_t>(in.state()),
          in.speed(),
          read.id<TrackId>(in.track()),
          in.gap(),
          in.speed_ahead(),
          in.own_speed(),
          in.along(),
          in.offset(),
          in.heading(),
          read.id<SensorId>(in.camera()),
          {in.region_x(), in.region_y(), in.region_width(), in.region_height()}};
}

records::EgoTruth record_of(const ttfusion::Ego& in, Reading& read) {
  return {TrueTime{in.at()},
          in.x(),
          in.y(),
          in.heading(),
          in.vx(),
          in.vy(),
          in.yaw_rate(),
          in.acceleration(),
          LocalTime{in.local()},
          GlobalTime{in.global()},
          read.id<NodeId>(in.node())};
}

records::StateChanged record_of(const ttfusion::StateChange& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.to<std::uint8_t>(in.from()),
          read.to<std::uint8_t>(in.to()),
          in.from_name(),
          in.to_name(),
          in.why(),
          in.consequence()};
}

records::SymbolSent record_of(const ttfusion::Symbol& in, Reading& read) {
  return {read.stamp(in.stamp()), read.stamp(in.end()), read.to<std::uint8_t>(in.channel()),
          read.to<std::uint8_t>(in.kind(), records::kSymbolCas, records::kSymbolMediaTest)};
}

records::PowerChanged record_of(const ttfusion::Power& in, Reading& read) { return {read.stamp(in.stamp()), in.on()}; }

records::FaultActivity record_of(const ttfusion::Fault& in, Reading& read) {
  return {TrueTime{in.at()},
          in.fault(),
          read.to<std::uint8_t>(in.what(), records::kFaultBegins, records::kFaultEnds),
          read.id<NodeId>(in.node()),
          in.kind(),
          in.text()};
}

records::GuardianIntervention record_of(const ttfusion::Guardian& in, Reading& read) {
  return {TrueTime{in.at()},
          read.id<NodeId>(in.branch()),
          read.to<std::uint8_t>(in.channel(), std::uint8_t{0}, std::uint8_t{1}),
          read.to<std::uint8_t>(in.signal(), records::kSignalFrame, records::kSignalUndecodable),
          read.to<std::uint8_t>(in.reason()),
          in.cut(),
          TrueTime{in.until()},
          in.why()};
}

records::ChannelFrame record_of(const ttfusion::ChannelFrame& in, Reading& read) {
  constexpr std::uint8_t kAllStates = 31;
  return {TrueTime{in.start()},
          TrueTime{in.end()},
          read.id<NodeId>(in.sender()),
          read.to<std::uint8_t>(in.channel()),
          read.to<std::uint8_t>(in.state(), std::uint8_t{0}, kAllStates),
          read.to<std::uint16_t>(in.slot()),
          read.to<std::uint8_t>(in.cycle_counter()),
          TrueTime{in.sent()},
          read.to<std::uint8_t>(in.sent_channel()),
          bytes_of(in.bytes())};
}

records::TimingProblem record_of(const ttfusion::TimingProblem& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.to<std::uint8_t>(in.what(), records::kLateWakeUp, records::kFramesLost),
          Duration{in.late()},
          in.cycle(),
          read.to<std::uint16_t>(in.slot()),
          read.to<std::uint8_t>(in.channel(), std::uint8_t{0}, std::uint8_t{1}),
          in.count()};
}

records::LatenessHistogram record_of(const ttfusion::Lateness& in, Reading& read) {
  read.must(static_cast<std::size_t>(in.counts_size()) <= records::kLatenessBins);
  read.lists.counts.assign(in.counts().begin(), in.counts().end());
  return {read.stamp(in.stamp()),
          read.to<std::uint8_t>(in.of(), records::kLatenessOfWakeUps, records::kLatenessOfTransits),
          Duration{in.longest()}, read.lists.counts};
}

records::CanErrorFrame record_of(const ttfusion::CanError& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.to<std::uint8_t>(in.bus()),
          read.to<std::uint8_t>(in.error(), records::kCanBitError, records::kCanAcknowledgementError),
          in.as_transmitter(),
          read.to<std::uint16_t>(in.transmit_errors()),
          read.to<std::uint16_t>(in.receive_errors())};
}

records::CanStateChanged record_of(const ttfusion::CanState& in, Reading& read) {
  return {read.stamp(in.stamp()),
          read.to<std::uint8_t>(in.bus()),
          read.to<std::uint8_t>(in.from(), records::kCanErrorActive, records::kCanBusOff),
          read.to<std::uint8_t>(in.to(), records::kCanErrorActive, records::kCanBusOff),
          read.to<std::uint16_t>(in.transmit_errors()),
          read.to<std::uint16_t>(in.receive_errors())};
}

records::MediumCounts record_of(const ttfusion::Medium& in, Reading& read) {
  return {read.stamp(in.stamp()), in.sent(),      in.received(), in.not_sent(), in.lost(),
          in.foreign(),           in.malformed(), in.dropped()};
}

}  // namespace

bool Decoder::decode(records::RecordKind kind, std::string_view bytes, records::Sink& sink) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return false;
  bool decoded = false;
  records::for_kind(kind, [&]<class Record>() {
    Payload<Record>& payload = payloads_.of<Record>();
    if (!payload.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
    Reading reading(lists_);
    static_assert(
        requires { Record{record_of(payload, reading)}; }, "a kind of record that the log does not decode");
    const Record record = record_of(payload, reading);
    decoded = reading.ok();
    if (decoded) sink.on(record);
  });
  return decoded;
}

}  // namespace ttf::recording::log
