#include <algorithm>
#include <limits>
#include <type_traits>

#include "recording/log/codec.h"
#include "recording/records/lateness_bins.h"

namespace ttf::recording::log {
namespace {

// Narrows numbers to what a record holds, remembering whether all of them fitted.
class Narrow {
 public:
  template <class Out, class In>
  Out to(In value, Out low = std::numeric_limits<Out>::min(), Out high = std::numeric_limits<Out>::max()) {
    if (value < static_cast<In>(low) || value > static_cast<In>(high)) ok_ = false;
    return static_cast<Out>(value);
  }
  template <class Enum> Enum id(std::uint32_t value) {
    return static_cast<Enum>(to<std::underlying_type_t<Enum>>(value));
  }
  template <class Enum> Enum choice(std::uint32_t value, Enum low, Enum high) {
    using Number = std::underlying_type_t<Enum>;
    return static_cast<Enum>(to<Number>(value, static_cast<Number>(low), static_cast<Number>(high)));
  }
  bool ok() const { return ok_; }

 private:
  bool ok_ = true;
};

records::Stamp stamp_of(const ttfusion::Stamp& in, Narrow& narrow) {
  return {TrueTime{in.true_time()}, LocalTime{in.local()}, GlobalTime{in.global()}, narrow.id<NodeId>(in.node())};
}

MeasurementId id_of(const ttfusion::MeasurementId& in, Narrow& narrow) {
  return {narrow.id<SensorId>(in.sensor()), in.sequence()};
}

records::ImageObject object_of(const ttfusion::ImageObject& in, Narrow& narrow) {
  return {narrow.id<TrackId>(in.track()),
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
          narrow.to<std::uint8_t>(in.status(), std::uint8_t{0}, std::uint8_t{15})};
}

std::span<const std::byte> bytes_of(const std::string& in) {
  return {reinterpret_cast<const std::byte*>(in.data()), in.size()};
}

}  // namespace

google::protobuf::Message* Payloads::of(RecordKind kind) {
  switch (kind) {
    case RecordKind::kMeasured: return &measured;
    case RecordKind::kCanFrame: return &can_frame;
    case RecordKind::kSlotFrame: return &slot_frame;
    case RecordKind::kSlotProblem: return &slot_problem;
    case RecordKind::kListHop: return &list_hop;
    case RecordKind::kTaskRun: return &task_run;
    case RecordKind::kClockCorrected: return &clock_corrected;
    case RecordKind::kPrecision: return &precision;
    case RecordKind::kFusionInput: return &fusion_input;
    case RecordKind::kListFused: return &list_fused;
    case RecordKind::kFusionStep: return &fusion_step;
    case RecordKind::kTrack: return &track;
    case RecordKind::kObservation: return &observation;
    case RecordKind::kImage: return &image;
    case RecordKind::kFeature: return &feature;
    case RecordKind::kReference: return &reference;
    case RecordKind::kTruth: return &truth;
    case RecordKind::kStateChange: return &state_change;
    case RecordKind::kSymbol: return &symbol;
    case RecordKind::kPower: return &power;
    case RecordKind::kFault: return &fault;
    case RecordKind::kGuardian: return &guardian;
    case RecordKind::kChannelFrame: return &channel_frame;
    case RecordKind::kTimingProblem: return &timing_problem;
    case RecordKind::kLateness: return &lateness;
    case RecordKind::kMedium: return &medium;
  }
  return nullptr;
}

bool Decoder::decode(RecordKind kind, std::string_view bytes, records::Sink& sink) {
  google::protobuf::Message* payload = payloads_.of(kind);
  if (payload == nullptr || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) ||
      !payload->ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return false;
  Narrow narrow;
  const auto hand_on = [&](const auto& record) {
    if (narrow.ok()) sink.on(record);
    return narrow.ok();
  };
  switch (kind) {
    case RecordKind::kMeasured: {
      const auto& in = payloads_.measured;
      truth_ids_.clear();
      for (const std::uint32_t id : in.truth_ids()) truth_ids_.push_back(narrow.id<ObjectId>(id));
      return hand_on(records::Measured{stamp_of(in.stamp(), narrow), id_of(in.id(), narrow), truth_ids_});
    }
    case RecordKind::kCanFrame: {
      const auto& in = payloads_.can_frame;
      return hand_on(records::CanFrameSent{narrow.to<std::uint8_t>(in.bus()), stamp_of(in.start(), narrow),
                                           stamp_of(in.end(), narrow), in.identifier(), in.flexible_data_rate(),
                                           narrow.id<PduId>(in.pdu()), narrow.id<SensorId>(in.sensor()), in.sequence(),
                                           narrow.to<std::uint8_t>(in.fragment()), bytes_of(in.data())});
    }
    case RecordKind::kSlotFrame: {
      const auto& in = payloads_.slot_frame;
      return hand_on(records::SlotFrameSent{stamp_of(in.stamp(), narrow), stamp_of(in.end(), narrow), in.cycle(),
                                            narrow.to<std::uint16_t>(in.slot()), narrow.to<std::uint8_t>(in.channel()),
                                            in.null_frame(), narrow.id<PduId>(in.pdu()),
                                            narrow.id<SensorId>(in.sensor()), in.sequence(),
                                            narrow.to<std::uint8_t>(in.fragment()), bytes_of(in.bytes())});
    }
    case RecordKind::kSlotProblem: {
      const auto& in = payloads_.slot_problem;
      return hand_on(records::SlotProblem{stamp_of(in.stamp(), narrow), in.cycle(), narrow.to<std::uint16_t>(in.slot()),
                                          narrow.to<std::uint8_t>(in.channel()), narrow.to<std::uint8_t>(in.status())});
    }
    case RecordKind::kListHop: {
      const auto& in = payloads_.list_hop;
      return hand_on(records::ListHop{stamp_of(in.stamp(), narrow),
                                      narrow.choice(in.hop(), records::Hop::kWritten, records::Hop::kDiscarded),
                                      narrow.id<PduId>(in.pdu()), narrow.id<SensorId>(in.sensor()), in.sequence(),
                                      narrow.to<std::int8_t>(in.can_bus())});
    }
    case RecordKind::kTaskRun: {
      const auto& in = payloads_.task_run;
      return hand_on(records::TaskRun{stamp_of(in.start(), narrow), narrow.to<std::uint8_t>(in.task()),
                                      stamp_of(in.activated(), narrow), stamp_of(in.end(), narrow), in.deadline_met()});
    }
    case RecordKind::kClockCorrected: {
      const auto& in = payloads_.clock_corrected;
      return hand_on(records::ClockCorrected{stamp_of(in.stamp(), narrow), in.cycle(), in.offset_microticks(),
                                             in.rate_microticks(), in.offset_missing(), in.rate_missing(),
                                             in.offset_limited(), in.rate_limited()});
    }
    case RecordKind::kPrecision: {
      const auto& in = payloads_.precision;
      return hand_on(records::PrecisionSample{TrueTime{in.at()}, in.cycle(), Duration{in.precision()}});
    }
    case RecordKind::kFusionInput: {
      const auto& in = payloads_.fusion_input;
      return hand_on(records::FusionInput{stamp_of(in.stamp(), narrow), in.step(), narrow.id<PduId>(in.pdu()),
                                          narrow.id<SensorId>(in.sensor()), in.sequence(), GlobalTime{in.measured()},
                                          narrow.to<std::uint16_t>(in.count()), bytes_of(in.fragments())});
    }
    case RecordKind::kListFused: {
      const auto& in = payloads_.list_fused;
      return hand_on(records::ListFused{
          stamp_of(in.stamp(), narrow), in.step(), id_of(in.id(), narrow), GlobalTime{in.measured()},
          narrow.choice(in.disposition(), records::Disposition::kFused, records::Disposition::kDuplicate)});
    }
    case RecordKind::kFusionStep: {
      const auto& in = payloads_.fusion_step;
      return hand_on(records::FusionStep{stamp_of(in.stamp(), narrow), in.step(),
                                         narrow.to<std::uint16_t>(in.confirmed()),
                                         narrow.to<std::uint16_t>(in.tentative())});
    }
    case RecordKind::kTrack: {
      const auto& in = payloads_.track;
      if (in.state_size() != 6 || in.covariance_size() != 36) return false;
      return hand_on(records::TrackState{stamp_of(in.stamp(), narrow), in.step(), narrow.id<TrackId>(in.track()),
                                         GlobalTime{in.valid_at()}, std::span<const double, 6>(in.state().data(), 6),
                                         std::span<const double, 36>(in.covariance().data(), 36),
                                         in.predicted_for_image()});
    }
    case RecordKind::kObservation: {
      const auto& in = payloads_.observation;
      return hand_on(records::ObservationSeen{stamp_of(in.stamp(), narrow), id_of(in.id(), narrow),
                                              GlobalTime{in.measured()}, narrow.to<std::uint16_t>(in.index()), in.x(),
                                              in.y(), in.sxx(), in.sxy(), in.syy()});
    }
    case RecordKind::kImage: {
      const auto& in = payloads_.image;
      image_objects_.clear();
      newest_.clear();
      for (const auto& object : in.objects()) image_objects_.push_back(object_of(object, narrow));
      for (const auto& id : in.newest()) newest_.push_back(id_of(id, narrow));
      return hand_on(records::ImageWritten{stamp_of(in.stamp(), narrow), in.sequence(), GlobalTime{in.valid_at()},
                                           GlobalTime{in.newest_measurement()}, image_objects_, newest_});
    }
    case RecordKind::kFeature: {
      const auto& in = payloads_.feature;
      feature_objects_.clear();
      if (in.time_gap_s_size() != in.objects_size() || in.time_to_collision_s_size() != in.objects_size() ||
          in.warning_size() != in.objects_size())
        return false;
      for (int i = 0; i < in.objects_size(); ++i)
        feature_objects_.push_back(
            {object_of(in.objects(i), narrow), in.time_gap_s(i), in.time_to_collision_s(i), in.warning(i)});
      return hand_on(records::FeatureUsed{stamp_of(in.stamp(), narrow), in.image_sequence(),
                                          GlobalTime{in.image_valid_at()}, in.fresh(), feature_objects_, in.stale()});
    }
    case RecordKind::kReference: {
      const auto& in = payloads_.reference;
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      return hand_on(records::ReferenceFix{TrueTime{in.measured_true()}, GlobalTime{in.measured()},
                                           GlobalTime{in.available()}, narrow.id<ObjectId>(in.object()), in.x(), in.y(),
                                           in.sigma(), in.has_vx() ? in.vx() : kNone, in.has_vy() ? in.vy() : kNone,
                                           in.has_sigma_velocity() ? in.sigma_velocity() : kNone,
                                           LocalTime{in.measured_local()}});
    }
    case RecordKind::kTruth: {
      const auto& in = payloads_.truth;
      return hand_on(records::TruthState{TrueTime{in.at()}, narrow.id<ObjectId>(in.object()), in.x(), in.y(),
                                         in.heading(), in.speed(), in.acceleration(), in.yaw_rate(), in.length(),
                                         in.width(), LocalTime{in.local()}, GlobalTime{in.global()},
                                         narrow.id<NodeId>(in.node())});
    }
    case RecordKind::kStateChange: {
      const auto& in = payloads_.state_change;
      return hand_on(records::StateChanged{stamp_of(in.stamp(), narrow), narrow.to<std::uint8_t>(in.from()),
                                           narrow.to<std::uint8_t>(in.to()), in.from_name(), in.to_name(), in.why(),
                                           in.consequence()});
    }
    case RecordKind::kSymbol: {
      const auto& in = payloads_.symbol;
      return hand_on(records::SymbolSent{
          stamp_of(in.stamp(), narrow), stamp_of(in.end(), narrow), narrow.to<std::uint8_t>(in.channel()),
          narrow.to<std::uint8_t>(in.kind(), records::kSymbolCas, records::kSymbolMediaTest)});
    }
    case RecordKind::kPower: {
      const auto& in = payloads_.power;
      return hand_on(records::PowerChanged{stamp_of(in.stamp(), narrow), in.on()});
    }
    case RecordKind::kFault: {
      const auto& in = payloads_.fault;
      return hand_on(records::FaultActivity{
          TrueTime{in.at()}, in.fault(), narrow.to<std::uint8_t>(in.what(), records::kFaultBegins, records::kFaultEnds),
          narrow.id<NodeId>(in.node()), in.kind(), in.text()});
    }
    case RecordKind::kGuardian: {
      const auto& in = payloads_.guardian;
      return hand_on(records::GuardianIntervention{
          TrueTime{in.at()}, narrow.id<NodeId>(in.branch()),
          narrow.to<std::uint8_t>(in.channel(), std::uint8_t{0}, std::uint8_t{1}),
          narrow.to<std::uint8_t>(in.signal(), records::kSignalFrame, records::kSignalUndecodable),
          narrow.to<std::uint8_t>(in.reason()), in.cut(), TrueTime{in.until()}, in.why()});
    }
    case RecordKind::kChannelFrame: {
      const auto& in = payloads_.channel_frame;
      constexpr std::uint8_t kAllStates = 31;
      return hand_on(records::ChannelFrame{
          TrueTime{in.start()}, TrueTime{in.end()}, narrow.id<NodeId>(in.sender()),
          narrow.to<std::uint8_t>(in.channel()), narrow.to<std::uint8_t>(in.state(), std::uint8_t{0}, kAllStates),
          narrow.to<std::uint16_t>(in.slot()), narrow.to<std::uint8_t>(in.cycle_counter()), TrueTime{in.sent()},
          narrow.to<std::uint8_t>(in.sent_channel()), bytes_of(in.bytes())});
    }
    case RecordKind::kTimingProblem: {
      const auto& in = payloads_.timing_problem;
      return hand_on(records::TimingProblem{
          stamp_of(in.stamp(), narrow), narrow.to<std::uint8_t>(in.what(), records::kLateWakeUp, records::kFramesLost),
          Duration{in.late()}, in.cycle(), narrow.to<std::uint16_t>(in.slot()),
          narrow.to<std::uint8_t>(in.channel(), std::uint8_t{0}, std::uint8_t{1}), in.count()});
    }
    case RecordKind::kLateness: {
      const auto& in = payloads_.lateness;
      if (static_cast<std::size_t>(in.counts_size()) > records::kLatenessBins) return false;
      counts_.assign(in.counts().begin(), in.counts().end());
      return hand_on(records::LatenessHistogram{
          stamp_of(in.stamp(), narrow),
          narrow.to<std::uint8_t>(in.of(), records::kLatenessOfWakeUps, records::kLatenessOfTransits),
          Duration{in.longest()}, counts_});
    }
    case RecordKind::kMedium: {
      const auto& in = payloads_.medium;
      return hand_on(records::MediumCounts{stamp_of(in.stamp(), narrow), in.sent(), in.received(), in.not_sent(),
                                           in.lost(), in.foreign(), in.malformed(), in.dropped()});
    }
  }
  return false;
}

}  // namespace ttf::recording::log
