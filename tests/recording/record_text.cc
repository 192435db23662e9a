#include "tests/recording/record_text.h"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <optional>
#include <type_traits>

#include "core/check.h"
#include "core/random.h"
#include "recording/records/lateness_bins.h"

namespace ttf::recording {
namespace {

// Writes fields one after the other; doubles by their bits.
class Line {
 public:
  explicit Line(std::string name) : text_(std::move(name)) {}

  template <class T> Line& add(const T& value) {
    if constexpr (std::is_same_v<T, double>)
      text_ += fmt::format(" {:016x}", std::bit_cast<std::uint64_t>(value));
    else if constexpr (std::is_same_v<T, std::string_view>)
      text_ += fmt::format(" \"{}\"", value);
    else if constexpr (std::is_enum_v<T>)
      text_ += fmt::format(" {}", static_cast<std::int64_t>(value));
    else if constexpr (std::is_arithmetic_v<T>)
      text_ += fmt::format(" {}", +value);
    else if constexpr (std::is_same_v<T, std::byte>)
      text_ += fmt::format(" {:02x}", static_cast<unsigned>(value));
    else if constexpr (std::is_same_v<T, MeasurementId>)
      add(value.sensor).add(value.sequence);
    else if constexpr (std::is_same_v<T, records::Stamp>)
      add(value.true_time).add(value.local).add(value.global).add(value.node);
    else if constexpr (std::is_same_v<T, records::ImageObject>)
      all(value.track, value.x, value.y, value.heading, value.speed, value.acceleration, value.length, value.width,
          value.sigma_x, value.sigma_y, value.correlation_xy, value.sigma_heading, value.sigma_speed,
          value.sigma_acceleration, value.sigma_length, value.sigma_width, value.status);
    else if constexpr (std::is_same_v<T, records::FeatureObject>)
      all(value.image, value.time_gap_s, value.time_to_collision_s, value.warning);
    else if constexpr (std::is_same_v<T, records::Believed>)
      all(value.value, value.sigma);
    else if constexpr (std::is_same_v<T, std::optional<records::BelievedBox>>) {
      if (value) all(value->heading, value->speed, value->acceleration, value->length, value->width);
    } else if constexpr (requires { value.ns; })
      text_ += fmt::format(" {}", value.ns);
    else
      list(value);
    return *this;
  }
  template <class... T> Line& all(const T&... values) {
    (add(values), ...);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  template <class List> void list(const List& items) {
    text_ += fmt::format(" [{}", items.size());
    for (const auto& item : items) add(item);
    text_ += "]";
  }
  std::string text_;
};

template <class... T> std::string line(std::string name, const T&... fields) {
  return Line(std::move(name)).all(fields...).text();
}

// Draws field values.
class Draw {
 public:
  Draw(int kind, Values values, std::uint32_t index, std::int64_t at)
      : values_(values), at_(at),
        stream_({.seed = 7, .purpose = Purpose::kTest, .entity = static_cast<std::uint16_t>(kind), .index = index}) {}

  template <class T> T get() {
    if constexpr (std::is_same_v<T, bool>)
      return get<std::uint8_t>() % 2 == 1;
    else if constexpr (std::is_same_v<T, double>)
      return number();
    else if constexpr (std::is_same_v<T, std::byte>)
      return static_cast<std::byte>(stream_.bits());
    else if constexpr (std::is_same_v<T, std::string>)
      return words();
    else if constexpr (std::is_enum_v<T>)
      return static_cast<T>(get<std::underlying_type_t<T>>());
    else if constexpr (std::is_same_v<T, MeasurementId>)
      return {get<SensorId>(), get<std::uint32_t>()};
    else if constexpr (std::is_same_v<T, records::Stamp>)
      return {get<TrueTime>(), get<LocalTime>(), get<GlobalTime>(), get<NodeId>()};
    else if constexpr (std::is_same_v<T, records::ImageObject>) {
      records::ImageObject object{get<TrackId>()};
      for (double* field :
           {&object.x, &object.y, &object.heading, &object.speed, &object.acceleration, &object.length, &object.width,
            &object.sigma_x, &object.sigma_y, &object.correlation_xy, &object.sigma_heading, &object.sigma_speed,
            &object.sigma_acceleration, &object.sigma_length, &object.sigma_width})
        *field = number();
      object.status = get<std::uint8_t>() & 15;
      return object;
    } else if constexpr (std::is_same_v<T, records::FeatureObject>)
      return {get<records::ImageObject>(), number(), number(), get<bool>()};
    else if constexpr (std::is_same_v<T, records::Believed>)
      return {number(), number()};
    else if constexpr (std::is_same_v<T, std::optional<records::BelievedBox>>) {
      if (!get<bool>()) return std::nullopt;
      return records::BelievedBox{get<records::Believed>(), get<records::Believed>(), get<records::Believed>(),
                                  get<records::Believed>(), get<records::Believed>()};
    } else if constexpr (requires(T t) { t.ns; })
      return T{values_ == Values::kDrawn ? at_ + stream_.integer(0, 9'999) : get<std::int64_t>()};
    else {
      if (values_ == Values::kSmallest) return std::numeric_limits<T>::min();
      if (values_ == Values::kLargest) return std::numeric_limits<T>::max();
      return values_ == Values::kZero ? T{} : static_cast<T>(stream_.bits());
    }
  }
  template <class T> T choice(T low, T high) {
    if (values_ == Values::kLargest) return high;
    if (values_ != Values::kDrawn) return low;
    return static_cast<T>(stream_.integer(static_cast<int>(low), static_cast<int>(high)));
  }
  template <class T> std::vector<T> list(std::size_t largest) {
    std::size_t count = 0;
    if (values_ == Values::kLargest) count = largest;
    if (values_ == Values::kDrawn) count = static_cast<std::size_t>(stream_.integer(0, 30));
    return fixed<T>(count);
  }
  template <class T> std::vector<T> fixed(std::size_t count) {
    std::vector<T> items;
    for (std::size_t i = 0; i < count; ++i) items.push_back(get<T>());
    return items;
  }

 private:
  // Printable, for text in the log is UTF-8.
  std::string words() {
    std::string text;
    for (const std::uint8_t letter : list<std::uint8_t>(300)) text += static_cast<char>(' ' + letter % 95);
    return text;
  }
  double number() {
    using Limits = std::numeric_limits<double>;
    switch (values_) {
      case Values::kZero: return -0.0;
      case Values::kSmallest: return Limits::denorm_min();
      case Values::kLargest: return Limits::infinity();
      case Values::kDrawn: break;
    }
    return std::bit_cast<double>(stream_.bits());  // any pattern, not-a-numbers with their payloads too
  }

  Values values_;
  std::int64_t at_;
  RandomStream stream_;
};

std::string text_of(const records::Measured& r) { return line("measured", r.stamp, r.id, r.truth_ids); }
std::string text_of(const records::CanFrameSent& r) {
  return line("can", r.bus, r.start, r.end, r.identifier, r.flexible_data_rate, r.pdu, r.sensor, r.sequence, r.fragment,
              r.data);
}
std::string text_of(const records::SlotFrameSent& r) {
  return line("slot", r.stamp, r.end, r.cycle, r.slot, r.channel, r.null_frame, r.pdu, r.sensor, r.sequence, r.fragment,
              r.bytes);
}
std::string text_of(const records::SlotProblem& r) {
  return line("problem", r.stamp, r.cycle, r.slot, r.channel, r.status);
}
std::string text_of(const records::ListHop& r) {
  return line("hop", r.stamp, r.hop, r.pdu, r.sensor, r.sequence, r.can_bus);
}
std::string text_of(const records::TaskRun& r) {
  return line("task", r.start, r.task, r.activated, r.end, r.deadline_met);
}
std::string text_of(const records::ClockCorrected& r) {
  return line("clock", r.stamp, r.cycle, r.offset_microticks, r.rate_microticks, r.offset_missing, r.rate_missing,
              r.offset_limited, r.rate_limited);
}
std::string text_of(const records::PrecisionSample& r) { return line("precision", r.at, r.cycle, r.precision); }
std::string text_of(const records::FusionInput& r) {
  return line("input", r.stamp, r.step, r.pdu, r.sensor, r.sequence, r.measured, r.count, r.fragments);
}
std::string text_of(const records::ListFused& r) {
  return line("fused", r.stamp, r.step, r.id, r.measured, r.disposition, r.innovation_squares, r.innovation_degrees);
}
std::string text_of(const records::OdometryTaken& r) {
  return line("odometry", r.stamp, r.step, r.id, r.measured, r.speed, r.yaw_rate, r.sigma_speed, r.sigma_yaw_rate,
              r.stopped);
}
std::string text_of(const records::FusionStep& r) { return line("step", r.stamp, r.step, r.confirmed, r.tentative); }
std::string text_of(const records::TrackState& r) {
  return line("track", r.stamp, r.step, r.track, r.valid_at, r.state, r.covariance, r.predicted_for_image, r.box);
}
std::string text_of(const records::ObservationSeen& r) {
  return line("observation", r.stamp, r.id, r.measured, r.index, r.x, r.y, r.sxx, r.sxy, r.syy);
}
std::string text_of(const records::ImageWritten& r) {
  return line("image", r.stamp, r.sequence, r.valid_at, r.newest_measurement, r.objects, r.newest);
}
std::string text_of(const records::FeatureUsed& r) {
  return line("feature", r.stamp, r.image_sequence, r.image_valid_at, r.fresh, r.objects, r.stale);
}
std::string text_of(const records::ReferenceFix& r) {
  return line("reference", r.measured_true, r.measured, r.available, r.object, r.x, r.y, r.sigma, r.vx, r.vy,
              r.sigma_velocity, r.measured_local);
}
std::string text_of(const records::TruthState& r) {
  return line("truth", r.at, r.object, r.x, r.y, r.heading, r.speed, r.acceleration, r.yaw_rate, r.length, r.width,
              r.local, r.global, r.node);
}

std::string text_of(const records::EgoTruth& r) {
  return line("ego", r.at, r.x, r.y, r.heading, r.vx, r.vy, r.yaw_rate, r.acceleration, r.local, r.global, r.node);
}

std::string text_of(const records::Warning& r) {
  return line("warning", r.stamp, r.service, r.on, r.track, r.time_to_collision_s);
}
std::string text_of(const records::CommandIssued& r) {
  return line("command", r.stamp, r.pdu, r.sequence, r.valid, r.reason, r.acceleration, r.steering, r.own_speed, r.gap,
              r.speed_ahead, r.track);
}
std::string text_of(const records::CommandTaken& r) {
  return line("actuator", r.stamp, r.pdu, r.sequence, r.verdict, r.acceleration, r.steering, r.from);
}

std::string text_of(const records::DetectionMade& r) {
  return line("detection", r.stamp, r.begin, r.id, r.frame, r.place, r.secondary, r.area, r.took, r.found);
}
std::string text_of(const records::SequencePlanned& r) {
  return line("sequence", r.stamp, r.frame, r.text, r.bound, r.length);
}

std::string text_of(const records::PlanMade& r) {
  return line("plan", r.stamp, r.pdu, r.sequence, r.valid, r.state, r.speed, r.track, r.gap, r.speed_ahead, r.own_speed,
              r.along, r.offset, r.heading, r.camera, r.region[0], r.region[1], r.region[2], r.region[3]);
}

std::string text_of(const records::StateChanged& r) {
  return line("state", r.stamp, r.from, r.to, r.from_name, r.to_name, r.why, r.consequence);
}
std::string text_of(const records::SymbolSent& r) { return line("symbol", r.stamp, r.end, r.channel, r.kind); }
std::string text_of(const records::PowerChanged& r) { return line("power", r.stamp, r.on); }
std::string text_of(const records::FaultActivity& r) {
  return line("fault", r.at, r.fault, r.what, r.node, r.kind, r.text);
}
std::string text_of(const records::GuardianIntervention& r) {
  return line("guardian", r.at, r.branch, r.channel, r.signal, r.reason, r.cut, r.until, r.why);
}

std::string text_of(const records::ChannelFrame& r) {
  return line("channel", r.start, r.end, r.sender, r.channel, r.state, r.slot, r.cycle_counter, r.sent, r.sent_channel,
              r.bytes);
}
std::string text_of(const records::TimingProblem& r) {
  return line("timing", r.stamp, r.what, r.late, r.cycle, r.slot, r.channel, r.count);
}
std::string text_of(const records::LatenessHistogram& r) {
  return line("lateness", r.stamp, r.of, r.longest, r.counts);
}
std::string text_of(const records::CanErrorFrame& r) {
  return line("can_error", r.stamp, r.bus, r.error, r.as_transmitter, r.transmit_errors, r.receive_errors);
}
std::string text_of(const records::CanStateChanged& r) {
  return line("can_state", r.stamp, r.bus, r.from, r.to, r.transmit_errors, r.receive_errors);
}
std::string text_of(const records::MediumCounts& r) {
  return line("medium", r.stamp, r.sent, r.received, r.not_sent, r.lost, r.foreign, r.malformed, r.dropped);
}

class Text final : public records::Every<Text> {
 public:
  explicit Text(std::vector<std::string>& lines) : lines_(lines) {}
  template <class Record> void each(const Record& record) { lines_.push_back(text_of(record)); }

 private:
  std::vector<std::string>& lines_;
};

}  // namespace

std::unique_ptr<records::Sink> text_into(std::vector<std::string>& lines) { return std::make_unique<Text>(lines); }

void emit(records::Sink& sink, int kind, Values values, std::uint32_t index, std::int64_t at_ns) {
  Draw d(kind, values, index, at_ns);
  const auto stamp = d.get<records::Stamp>();
  using U8 = std::uint8_t;
  using U16 = std::uint16_t;
  using U32 = std::uint32_t;
  using U64 = std::uint64_t;
  using I32 = std::int32_t;
  using I64 = std::int64_t;
  // Braces evaluate from left to right, so the draws are in a defined order.
  switch (kind) {
    case 1: {
      const auto ids = d.list<ObjectId>(500);
      return sink.on(records::Measured{stamp, d.get<MeasurementId>(), ids});
    }
    case 2: {
      const auto data = d.list<std::byte>(64);
      return sink.on(records::CanFrameSent{d.get<U8>(), stamp, d.get<records::Stamp>(), d.get<U32>(), d.get<bool>(),
                                           d.get<PduId>(), d.get<SensorId>(), d.get<U32>(), d.get<U8>(), data});
    }
    case 3: {
      const auto bytes = d.list<std::byte>(262);
      return sink.on(records::SlotFrameSent{stamp, d.get<records::Stamp>(), d.get<I64>(), d.get<U16>(), d.get<U8>(),
                                            d.get<bool>(), d.get<PduId>(), d.get<SensorId>(), d.get<U32>(), d.get<U8>(),
                                            bytes});
    }
    case 4: return sink.on(records::SlotProblem{stamp, d.get<I64>(), d.get<U16>(), d.get<U8>(), d.get<U8>()});
    case 5:
      return sink.on(records::ListHop{stamp, d.choice(records::Hop::kWritten, records::Hop::kDiscarded), d.get<PduId>(),
                                      d.get<SensorId>(), d.get<U32>(), d.get<std::int8_t>()});
    case 6:
      return sink.on(
          records::TaskRun{stamp, d.get<U8>(), d.get<records::Stamp>(), d.get<records::Stamp>(), d.get<bool>()});
    case 7:
      return sink.on(records::ClockCorrected{stamp, d.get<I64>(), d.get<I32>(), d.get<I32>(), d.get<bool>(),
                                             d.get<bool>(), d.get<bool>(), d.get<bool>()});
    case 8: return sink.on(records::PrecisionSample{d.get<TrueTime>(), d.get<I64>(), d.get<Duration>()});
    case 9: {
      const auto fragments = d.list<std::byte>(5000);
      return sink.on(records::FusionInput{stamp, d.get<U32>(), d.get<PduId>(), d.get<SensorId>(), d.get<U32>(),
                                          d.get<GlobalTime>(), d.get<U16>(), fragments});
    }
    case 10:
      return sink.on(records::ListFused{stamp, d.get<U32>(), d.get<MeasurementId>(), d.get<GlobalTime>(),
                                        d.choice(records::Disposition::kFused, records::Disposition::kDuplicate),
                                        d.get<double>(), d.get<U32>()});
    case 11: return sink.on(records::FusionStep{stamp, d.get<U32>(), d.get<U16>(), d.get<U16>()});
    case 12: {
      const auto state = d.fixed<double>(6), covariance = d.fixed<double>(36);
      return sink.on(records::TrackState{stamp, d.get<U32>(), d.get<TrackId>(), d.get<GlobalTime>(),
                                         std::span<const double, 6>(state.data(), 6),
                                         std::span<const double, 36>(covariance.data(), 36), d.get<bool>(),
                                         d.get<std::optional<records::BelievedBox>>()});
    }
    case 13:
      return sink.on(records::ObservationSeen{stamp, d.get<MeasurementId>(), d.get<GlobalTime>(), d.get<U16>(),
                                              d.get<double>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                              d.get<double>()});
    case 14: {
      const auto objects = d.list<records::ImageObject>(25);
      const auto newest = d.list<MeasurementId>(255);
      return sink.on(
          records::ImageWritten{stamp, d.get<U32>(), d.get<GlobalTime>(), d.get<GlobalTime>(), objects, newest});
    }
    case 15: {
      const auto objects = d.list<records::FeatureObject>(25);
      return sink.on(
          records::FeatureUsed{stamp, d.get<U32>(), d.get<GlobalTime>(), d.get<bool>(), objects, d.get<bool>()});
    }
    case 16:
      return sink.on(records::ReferenceFix{d.get<TrueTime>(), d.get<GlobalTime>(), d.get<GlobalTime>(),
                                           d.get<ObjectId>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                           d.get<double>(), d.get<double>(), d.get<double>(), d.get<LocalTime>()});
    case 17:
      return sink.on(records::TruthState{d.get<TrueTime>(), d.get<ObjectId>(), d.get<double>(), d.get<double>(),
                                         d.get<double>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                         d.get<double>(), d.get<double>(), d.get<LocalTime>(), d.get<GlobalTime>(),
                                         d.get<NodeId>()});
    case 18: {
      const auto words = d.fixed<std::string>(4);
      return sink.on(records::StateChanged{stamp, d.get<U8>(), d.get<U8>(), words[0], words[1], words[2], words[3]});
    }
    case 19:
      return sink.on(records::SymbolSent{stamp, d.get<records::Stamp>(), d.get<U8>(),
                                         d.choice(records::kSymbolCas, records::kSymbolMediaTest)});
    case 20: return sink.on(records::PowerChanged{stamp, d.get<bool>()});
    case 21: {
      const auto words = d.fixed<std::string>(2);
      return sink.on(records::FaultActivity{d.get<TrueTime>(), d.get<U32>(),
                                            d.choice(records::kFaultBegins, records::kFaultEnds), d.get<NodeId>(),
                                            words[0], words[1]});
    }
    case 22: {
      const auto words = d.fixed<std::string>(1);
      return sink.on(records::GuardianIntervention{d.get<TrueTime>(), d.get<NodeId>(), d.choice(U8{0}, U8{1}),
                                                   d.choice(records::kSignalFrame, records::kSignalUndecodable),
                                                   d.get<U8>(), d.get<bool>(), d.get<TrueTime>(), words[0]});
    }
    case 23: {
      const auto bytes = d.list<std::byte>(262);
      return sink.on(records::ChannelFrame{d.get<TrueTime>(), d.get<TrueTime>(), d.get<NodeId>(), d.get<U8>(),
                                           d.choice(std::uint8_t{0}, records::kChannelNothing), d.get<U16>(),
                                           d.get<U8>(), d.get<TrueTime>(), d.get<U8>(), bytes});
    }
    case 24:
      return sink.on(records::TimingProblem{stamp, d.choice(records::kLateWakeUp, records::kFramesLost),
                                            d.get<Duration>(), d.get<I64>(), d.get<U16>(), d.choice(U8{0}, U8{1}),
                                            d.get<U32>()});
    case 25: {
      const auto counts = d.list<std::uint64_t>(records::kLatenessBins);
      return sink.on(records::LatenessHistogram{
          stamp, d.choice(records::kLatenessOfWakeUps, records::kLatenessOfTransits), d.get<Duration>(), counts});
    }
    case 26:
      return sink.on(records::MediumCounts{stamp, d.get<U64>(), d.get<U64>(), d.get<U64>(), d.get<U64>(), d.get<U64>(),
                                           d.get<U64>(), d.get<U64>()});
    case 27:
      return sink.on(records::CanErrorFrame{stamp, d.get<U8>(),
                                            d.choice(records::kCanBitError, records::kCanAcknowledgementError),
                                            d.get<bool>(), d.get<U16>(), d.get<U16>()});
    case 28:
      return sink.on(records::CanStateChanged{
          stamp, d.get<U8>(), d.choice(records::kCanErrorActive, records::kCanBusOff),
          d.choice(records::kCanErrorActive, records::kCanBusOff), d.get<U16>(), d.get<U16>()});
    case 29:
      return sink.on(records::OdometryTaken{stamp, d.get<U32>(), d.get<MeasurementId>(), d.get<GlobalTime>(),
                                            d.get<double>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                            d.get<bool>()});
    case 30:
      return sink.on(records::EgoTruth{d.get<TrueTime>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                       d.get<double>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                       d.get<LocalTime>(), d.get<GlobalTime>(), d.get<NodeId>()});
    case 31: return sink.on(records::Warning{stamp, d.get<U8>(), d.get<bool>(), d.get<TrackId>(), d.get<double>()});
    case 32:
      return sink.on(records::CommandIssued{stamp, d.get<PduId>(), d.get<U32>(), d.get<bool>(), d.get<U8>(),
                                            d.get<double>(), d.get<double>(), d.get<double>(), d.get<double>(),
                                            d.get<double>(), d.get<TrackId>()});
    case 33:
      return sink.on(records::CommandTaken{stamp, d.get<PduId>(), d.get<U32>(), d.get<U8>(), d.get<double>(),
                                           d.get<double>(), d.get<TrueTime>()});
    case 34:
      return sink.on(records::DetectionMade{stamp, d.get<TrueTime>(), d.get<MeasurementId>(), d.get<U32>(),
                                            d.get<U16>(), d.get<bool>(), d.get<double>(), d.get<Duration>(),
                                            d.get<U16>()});
    case 35: {
      const auto words = d.fixed<std::string>(1);
      return sink.on(records::SequencePlanned{stamp, d.get<U32>(), words[0], d.get<Duration>(), d.get<Duration>()});
    }
    case 36:
      return sink.on(records::PlanMade{stamp,
                                       d.get<PduId>(),
                                       d.get<U32>(),
                                       d.get<bool>(),
                                       d.get<U8>(),
                                       d.get<double>(),
                                       d.get<TrackId>(),
                                       d.get<double>(),
                                       d.get<double>(),
                                       d.get<double>(),
                                       d.get<double>(),
                                       d.get<double>(),
                                       d.get<double>(),
                                       d.get<SensorId>(),
                                       {d.get<double>(), d.get<double>(), d.get<double>(), d.get<double>()}});
  }
  TTF_CHECK(false, "nothing to draw of kind {}", kind);
}

}  // namespace ttf::recording
