#include "sim/processes/turn.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "bus/wire/flexray_frame.h"
#include "core/check.h"
#include "nodes/driving/actuator.h"
#include "schedules/model/limits.h"

namespace ttf::sim::processes {
namespace {

enum class ActKind : std::uint8_t { kSignal = 1, kCanFrame = 2, kTrigger = 3, kStrobe = 4, kActuation = 5 };

constexpr std::size_t kHeaderSize = 1 + 4 + 5 * 8 + 2;
constexpr std::size_t kUsualSize = 4096;
constexpr std::size_t kMostCanBytes = 64;
constexpr std::int64_t kMostAhead = std::int64_t{1} << 40;  // [uT] hours: the furthest instant in a turn
constexpr std::int64_t kLastTick = std::int64_t{1} << 60;

template <class Integer> void put(std::vector<std::byte>& bytes, Integer value) {
  auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
  for (std::size_t i = 0; i < sizeof(Integer);
       ++i, bits = static_cast<decltype(bits)>(static_cast<std::uint64_t>(bits) >> 8))
    bytes.push_back(static_cast<std::byte>(bits & 0xFF));
}
void put(std::vector<std::byte>& bytes, ActKind kind) { bytes.push_back(static_cast<std::byte>(kind)); }

class TurnBytes {
 public:
  explicit TurnBytes(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class Integer> Integer take(std::uint64_t most, const char* what) {
    const std::span<const std::byte> field = take_bytes(sizeof(Integer), what);
    std::uint64_t value = 0;
    for (std::size_t i = field.size(); i-- > 0;) value = value << 8 | static_cast<std::uint64_t>(field[i]);
    if (value > most)
      throw std::runtime_error(fmt::format("a turn with {} {}, which must be at most {}", what, value, most));
    return static_cast<Integer>(value);
  }
  // May be below zero: a node's first tick comes within a tick of the start of the drive.
  Microticks instant(Microticks from, std::int64_t most, const char* what) {
    const auto value = static_cast<std::int64_t>(take<std::uint64_t>(~std::uint64_t{0}, what));
    if (value < from.value || value > from.value + most)
      throw std::runtime_error(
          fmt::format("a turn with {} {}, which must be {}..{}", what, value, from.value, from.value + most));
    return {value};
  }
  // Reads an instant that may be never.
  Microticks instant_or_never(Microticks from, std::int64_t most, const char* what) {
    TurnBytes ahead = *this;
    if (ahead.take<std::uint64_t>(~std::uint64_t{0}, what) == static_cast<std::uint64_t>(kNever<Microticks>.value)) {
      *this = ahead;
      return kNever<Microticks>;
    }
    return instant(from, most, what);
  }
  Microticks delay(const char* what) { return instant_or_never({}, kMostAhead, what); }
  std::span<const std::byte> take_bytes(std::size_t size, const char* what) {
    if (size > left_.size()) throw std::runtime_error(fmt::format("a turn that ends in its {}", what));
    const std::span<const std::byte> taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  bool done() const { return left_.empty(); }

 private:
  std::span<const std::byte> left_;
};

bus::ports::Transmission read_signal(TurnBytes& in, const TurnHeader& turn) {
  bus::ports::Transmission sent;
  sent.channel = static_cast<schedules::model::Channel>(in.take<std::uint8_t>(1, "channel"));
  sent.signal = static_cast<bus::ports::Signal>(
      in.take<std::uint8_t>(static_cast<std::uint64_t>(bus::ports::Signal::kUndecodable), "signal"));
  sent.start = in.instant(turn.at, kMostAhead, "start of a signal");
  sent.end = in.instant(sent.start, kMostAhead, "end of a signal");
  sent.slot = in.take<std::uint16_t>(static_cast<std::uint64_t>(schedules::model::kLastSlot), "slot");
  const auto size = in.take<std::uint16_t>(bus::wire::kMaxFrameBytes, "size of a frame");
  sent.bytes = in.take_bytes(size, "frame");
  if (sent.signal != bus::ports::Signal::kFrame) return sent;
  sent.content = bus::wire::decode_frame(sent.channel, sent.bytes);
  if (sent.content.error != bus::wire::FrameError::kNone) throw std::runtime_error("a turn with an undecodable frame");
  return sent;
}

CanAct read_can(TurnBytes& in, const schedules::model::Cluster& cluster) {
  CanAct act;
  const std::size_t buses = cluster.can_buses.size();
  if (buses == 0) throw std::runtime_error("a turn with a CAN frame, in a cluster without a CAN");
  act.bus = in.take<std::uint8_t>(buses - 1, "CAN");
  act.frame.identifier = in.take<std::uint32_t>(0x7FF, "CAN identifier");
  act.frame.flexible_data_rate = in.take<std::uint8_t>(1, "flexible data rate") != 0;
  const auto size = in.take<std::uint8_t>(kMostCanBytes, "size of a CAN frame");
  act.frame.data = in.take_bytes(size, "CAN frame");
  return act;
}

// `end` is the end of the sensor's wires where the node must be.
SensorId read_sensor(TurnBytes& in, const TurnHeader& turn, const schedules::model::Cluster& cluster,
                     NodeId schedules::model::Sensor::*end) {
  const std::size_t sensors = cluster.sensors.size();
  if (sensors == 0) throw std::runtime_error("a turn with a sensor, in a cluster without sensors");
  const auto sensor = static_cast<SensorId>(in.take<std::uint8_t>(sensors - 1, "sensor"));
  if (cluster.sensor(sensor).*end != turn.node) throw std::runtime_error("a turn with another node's sensor");
  return sensor;
}

double read_number(TurnBytes& in, const char* what) {
  const double value = std::bit_cast<double>(in.take<std::uint64_t>(~std::uint64_t{0}, what));
  if (!std::isfinite(value)) throw std::runtime_error(fmt::format("a turn with a {} that is not finite", what));
  return value;
}

nodes::host::Actuation read_actuation(TurnBytes& in, const TurnHeader& turn, const schedules::model::Cluster& cluster) {
  if (!schedules::model::has_step(cluster.node(turn.node), nodes::driving::Actuator::kName))
    throw std::runtime_error("a turn with an actuation, of a node without an actuator");
  const auto from =
      static_cast<std::int64_t>(in.take<std::uint64_t>(static_cast<std::uint64_t>(kLastTick), "actuation"));
  const double acceleration = read_number(in, "acceleration");
  return {TrueTime{from}, acceleration, read_number(in, "steering")};
}

Act read_act(TurnBytes& in, const TurnHeader& turn, const schedules::model::Cluster& cluster) {
  switch (static_cast<ActKind>(in.take<std::uint8_t>(0xFF, "act"))) {
    case ActKind::kSignal: return read_signal(in, turn);
    case ActKind::kCanFrame: return read_can(in, cluster);
    case ActKind::kTrigger: return TriggerAct{read_sensor(in, turn, cluster, &schedules::model::Sensor::host)};
    case ActKind::kStrobe: {
      const SensorId sensor = read_sensor(in, turn, cluster, &schedules::model::Sensor::device);
      return StrobeAct{sensor, in.take<std::uint32_t>(~std::uint32_t{0}, "sequence")};
    }
    case ActKind::kActuation: return read_actuation(in, turn, cluster);
  }
  throw std::runtime_error("a turn with an act of unknown kind");
}

}  // namespace

TurnWriter::TurnWriter() {
  bytes_.reserve(kUsualSize);
  clear();
}

void TurnWriter::clear() {
  bytes_.assign(kHeaderSize, std::byte{});
  acts_ = 0;
}

void TurnWriter::add(const Act& act) {
  ++acts_;
  if (const auto* sent = std::get_if<bus::ports::Transmission>(&act)) {
    put(bytes_, ActKind::kSignal);
    put(bytes_, static_cast<std::uint8_t>(sent->channel));
    put(bytes_, static_cast<std::uint8_t>(sent->signal));
    put(bytes_, sent->start.value);
    put(bytes_, sent->end.value);
    put(bytes_, static_cast<std::uint16_t>(sent->slot));
    put(bytes_, static_cast<std::uint16_t>(sent->bytes.size()));
    bytes_.insert(bytes_.end(), sent->bytes.begin(), sent->bytes.end());
  } else if (const auto* can = std::get_if<CanAct>(&act)) {
    put(bytes_, ActKind::kCanFrame);
    put(bytes_, static_cast<std::uint8_t>(can->bus));
    put(bytes_, can->frame.identifier);
    put(bytes_, static_cast<std::uint8_t>(can->frame.flexible_data_rate));
    put(bytes_, static_cast<std::uint8_t>(can->frame.data.size()));
    bytes_.insert(bytes_.end(), can->frame.data.begin(), can->frame.data.end());
  } else if (const auto* trigger = std::get_if<TriggerAct>(&act)) {
    put(bytes_, ActKind::kTrigger);
    put(bytes_, static_cast<std::uint8_t>(trigger->sensor));
  } else if (const auto* strobe = std::get_if<StrobeAct>(&act)) {
    put(bytes_, ActKind::kStrobe);
    put(bytes_, static_cast<std::uint8_t>(strobe->sensor));
    put(bytes_, strobe->sequence);
  } else if (const auto* actuation = std::get_if<nodes::host::Actuation>(&act)) {
    put(bytes_, ActKind::kActuation);
    put(bytes_, actuation->from.ns);
    put(bytes_, std::bit_cast<std::uint64_t>(actuation->acceleration));
    put(bytes_, std::bit_cast<std::uint64_t>(actuation->steering));
  }
}

// The header always has the same length, so its place can be kept free.
std::span<const std::byte> TurnWriter::finish(const TurnHeader& header) {
  const std::size_t size = bytes_.size();
  put(bytes_, static_cast<std::uint8_t>(header.node));
  put(bytes_, header.number);
  for (const Microticks ticks : {header.at, header.promise.silent_until, header.promise.after_flexray,
                                 header.promise.after_can, header.promise.after_trigger})
    put(bytes_, ticks.value);
  put(bytes_, acts_);
  TTF_CHECK(bytes_.size() == size + kHeaderSize, "a header of {} bytes", bytes_.size() - size);
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(size), bytes_.end(), bytes_.begin());
  bytes_.resize(size);
  return bytes_;
}

TurnHeader read_turn(const schedules::model::Cluster& cluster, std::span<const std::byte> bytes,
                     std::vector<Act>& acts) {
  TurnBytes in(bytes);
  TurnHeader header;
  header.node = static_cast<NodeId>(in.take<std::uint8_t>(cluster.nodes.size() - 1, "node"));
  header.number = in.take<std::uint32_t>(~std::uint32_t{0}, "number");
  header.at = in.instant({-kLastTick}, 2 * kLastTick, "instant");
  header.promise.silent_until = in.instant_or_never(header.at + Microticks{1}, kMostAhead, "silence");
  header.promise.after_flexray = in.delay("delay after FlexRay");
  header.promise.after_can = in.delay("delay after CAN");
  header.promise.after_trigger = in.delay("delay after a trigger");
  acts.clear();
  for (auto left = in.take<std::uint16_t>(0xFFFF, "number of acts"); left > 0; --left)
    acts.push_back(read_act(in, header, cluster));
  if (!in.done()) throw std::runtime_error("a turn that continues after its last act");
  return header;
}

}  // namespace ttf::sim::processes
