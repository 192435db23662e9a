// The cluster: everything about what happens and when, as data. One YAML file describes one cluster
// (schedules/file/loader.h reads it, schedules/check/checker.h proves it consistent); after that it is frozen and
// shared by every node.
//
// Instants on the bus' own grid are macroticks within a cycle plus cycle multiplexing (base cycle, repetition): an
// event happens in every cycle c with c mod repetition == base_cycle.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/flexray_parameters.h"
#include "schedules/model/medium_id.h"
#include "schedules/model/pdu.h"
#include "schedules/model/round.h"

namespace ttf::schedules::model {

std::string_view channels_text(Channels channels);  // "A", "B", "AB"

// A periodic instant in global time: macrotick `offset` of every cycle c with c mod repetition == base_cycle.
struct CycleInstant {
  int base_cycle = 0;
  int repetition = 1;
  Macroticks offset{0};
};

// Fragment `fragment` of a PDU in one slot, or a status frame without PDU (pdu == kNoPdu). Static slots are
// 1..gNumberOfStaticSlots, those above are dynamic. A dynamic frame always carries a PDU: it is sent when there is a
// list to send, once per list, as long as its fragment (schedules/analysis/minislots.h).
struct FrameSlot {
  int slot = 0;  // frame id
  Channels channels = Channels::kAB;
  int base_cycle = 0;
  int repetition = 1;
  NodeId sender{};
  PduId pdu = kNoPdu;
  int fragment = 0;
  int line = 0;
  // Static frames only: the payload begins with the network management vector, gNetworkManagementVectorLength bytes,
  // and says so (payload preamble indicator); the fragment follows it.
  bool network_management = false;
  // Dynamic frames only: the payload begins with this message id, two bytes, and says so (payload preamble indicator);
  // the fragment follows it. Receivers take the frame for this one only if it has this id.
  std::optional<std::uint16_t> message_id = std::nullopt;
};

inline constexpr int kMessageIdBytes = 2;

// Whether the instant, or the frame, has its turn in a cycle: its counter, or its number since some cycle 0. Not
// negative.
template <class Multiplexed>
requires requires(const Multiplexed& one) { one.base_cycle, one.repetition; }
constexpr bool in_cycle(const Multiplexed& one, std::int64_t cycle) {
  const std::int64_t repetition = one.repetition;  // nearly always a power of two, which needs no division
  const std::int64_t turn = (repetition & (repetition - 1)) == 0 ? cycle & (repetition - 1) : cycle % repetition;
  return turn == one.base_cycle;
}

constexpr bool is_dynamic(const GlobalParameters& flexray, const FrameSlot& frame) {
  return frame.slot > flexray.gNumberOfStaticSlots;
}
// In front of the fragment: network management vector or message id.
constexpr int preamble_bytes(const GlobalParameters& flexray, const FrameSlot& frame) {
  return frame.message_id ? kMessageIdBytes : frame.network_management ? flexray.gNetworkManagementVectorLength : 0;
}
// Whether both have their turn in some of the same cycles; whether some channel is in both sets.
bool share_a_cycle(const FrameSlot& a, const FrameSlot& b);
constexpr bool share_a_channel(Channels a, Channels b) {
  return (static_cast<unsigned>(a) & static_cast<unsigned>(b)) != 0;
}

// Whether `frame` is the next fragment of the same list in the next slot, or the next but one where `step` is 2,
// otherwise like `before`.
bool continues(const FrameSlot& before, const FrameSlot& frame, int step = 1);

// A PDU on a CAN: all fragments have the same identifier; the fragment number is in the data.
struct CanMessage {
  PduId pdu{};
  std::uint32_t identifier = 0;  // 11 bits
  NodeId sender{};
  Duration shortest_period{};  // in true time, between two lists' queueing; proved by schedules/check/checker.h
  int line = 0;
};

struct CanBus {
  std::string name;
  bool flexible_data_rate = false;    // CAN FD with bit-rate switching
  std::int64_t nominal_bit_rate = 0;  // bit/s
  std::int64_t data_bit_rate = 0;     // bit/s, equal to nominal for classic CAN
  double other_load = 0.0;            // share of the bus that other traffic takes (sim/medium/can_medium.h)
  std::vector<CanMessage> messages;
  int line = 0;
};

// Where a port of a task leads: a PDU on a medium.
struct PortBinding {
  std::string port;  // the code's name for it
  PduId pdu{};
  MediumId medium;
  int line = 0;
};

enum class ActivationKind : std::uint8_t {
  kTime,        // at CycleInstants of the node's global time
  kMessage,     // when a list of `port` has arrived completely
  kSensor,      // at the sensor's measurement instants
  kCompletion,  // when task `after` of the same node ends
};

struct Activation {
  ActivationKind kind = ActivationKind::kTime;
  CycleInstant at{};
  std::string port;
  SensorId sensor = kNoSensor;
  std::string after;
};

enum class ExecutionDraw : std::uint8_t {
  kUniform,  // between best and worst case, drawn per run: the unsynchronised paradigm
  kWorst,    // always the worst case: the synchronised paradigm
};

struct Task {
  std::string name;
  std::string step;  // which code runs
  Activation activation;
  Duration best_case{};  // execution time
  Duration worst_case{};
  ExecutionDraw draw = ExecutionDraw::kUniform;
  Duration deadline{};  // after activation
  std::vector<PortBinding> reads;
  std::vector<PortBinding> writes;
  int line = 0;
};

// Whether a list at this port, which the task reads, sets it off.
bool activates(const Task& task, const PortBinding& read);

struct Node {
  std::string name;
  std::optional<NodeParameters> flexray;  // nothing: not on FlexRay (a sensor device)
  std::int64_t microtick_ps = 25'000;     // nominal, also for nodes off FlexRay
  std::optional<std::int64_t> drift_ppb;  // fixed; else drawn within +-max_drift_ppb
  std::int64_t max_drift_ppb = 1'500'000;
  std::vector<Task> tasks;
  int line = 0;
};

enum class SensorKind : std::uint8_t { kLaser, kCamera, kRadar };

// When a sensor measures. Free: period on the device's own clock, first instant at `phase` (drawn if absent).
// Scheduled: at an instant of the host's global time, over a trigger line. Following: over the same line, whenever a
// task of the host has ended (its preprocessing), so as often as that can follow; first like a free one. What is lost
// on the way would end that: a device which is not triggered measures by itself after `longest`. In all of them the
// host latches its global time at the device's strobe, which is the measurement's time stamp.
struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::kLaser;
  NodeId device{};  // the node that emulates it
  NodeId host{};    // the preprocessing node that triggers it and takes its strobe
  bool scheduled = false;
  Duration period{};  // free-running; following: the shortest from one measurement to the next that the device can
  std::optional<Duration> phase;
  CycleInstant at{};   // scheduled
  std::string after;   // following: the task of the host (schedules/analysis/sensor_loop.h); else empty
  Duration longest{};  // following: from one measurement to the next, on the device's own clock
  int line = 0;

  bool follows() const { return !after.empty(); }
  Duration longest_period() const { return follows() ? longest : period; }
};

// How the nodes are wired, on either channel alike.
enum class Topology : std::uint8_t {
  kBus,   // one line with all nodes on it
  kStar,  // every node on a branch of its own, an active star in the middle
};

// What real-time media keep instead of FlexRay's own windows, which an ordinary kernel misses by its wake-ups alone:
// how long before and after the action point of its slot, on the receiver's clock, a frame may come. In real time: a
// stretched schedule (--time-scale) has no wider windows. The schedule has room for it where the last static slot in
// use has that long until the static segment ends.
struct ArrivalWindow {
  Duration early{};
  Duration late{};
};

struct Cluster {
  std::string name;
  std::string file;  // for messages
  std::string text;  // the YAML as read, attached to logs
  GlobalParameters flexray;
  bool synchronisation = true;  // clock correction on (off only to show what it is for)
  Topology topology = Topology::kBus;
  bool guardian = false;  // the stars let through only what their schedule allows; needs kStar
  std::vector<PduLayout> pdus;
  std::vector<Node> nodes;
  std::vector<FrameSlot> frames;  // ordered by slot, then base cycle
  std::vector<CanBus> can_buses;
  std::vector<Sensor> sensors;
  std::optional<ArrivalWindow> arrival_window;  // `real_time`; none: this schedule is for virtual time only
  // By "nodes", "guardian", "flexray.gdNIT", "nodes.fusion.flexray.pKeySlotId".
  std::map<std::string, int, std::less<>> parameter_lines;

  const Node& node(NodeId id) const { return nodes[index_of(id)]; }
  const PduLayout& pdu(PduId id) const { return pdus[index_of(id)]; }
  const Sensor& sensor(SensorId id) const { return sensors[index_of(id)]; }
  const CanBus& can(MediumId id) const { return can_buses[id.can_index()]; }
  std::optional<NodeId> find_node(std::string_view name) const;
  std::optional<PduId> find_pdu(std::string_view name) const;
  std::optional<SensorId> find_sensor(std::string_view name) const;
  Duration cycle() const { return {flexray.cycle_ps() / 1000}; }
  // After which all that the schedule does repeats, to the nanosecond.
  Duration round() const { return {kCycles * flexray.cycle_ps() / 1000}; }
};

// Whether a task of the node reads or writes there.
bool is_on_can(const Node& node, std::size_t can_bus);

// Global time of an instant in the n-th cycle since the start (n counts on beyond gCycleCountMax).
GlobalTime time_of(const GlobalParameters& flexray, std::int64_t cycle, Macroticks offset);

// First occurrence of a periodic instant at or after `from`, and the cycle it falls in.
struct Occurrence {
  std::int64_t cycle = 0;
  GlobalTime time{};
};
Occurrence next_occurrence(const GlobalParameters& flexray, const CycleInstant& at, GlobalTime from);

}  // namespace ttf::schedules::model
