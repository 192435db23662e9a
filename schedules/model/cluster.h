// The cluster: the whole schedule as data. One YAML file describes one cluster. schedules/file/loader.h reads
// it, schedules/check/checker.h proves it consistent; then it is frozen and shared by all nodes.
//
// Instants on the bus' own grid are macroticks within a cycle plus cycle multiplexing (base cycle, repetition):
// an event happens in every cycle c with c mod repetition == base_cycle.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "core/ids.h"
#include "core/text_place.h"
#include "core/time.h"
#include "schedules/model/flexray_parameters.h"
#include "schedules/model/medium_id.h"
#include "schedules/model/pdu.h"
#include "schedules/model/round.h"
#include "schedules/model/sensor_kind.h"
#include "schedules/model/task_modes.h"

namespace ttf::schedules::model {

std::string_view channels_text(Channels channels);  // "A", "B", "AB"

// A periodic instant in global time: macrotick `offset` of every cycle c with c mod repetition == base_cycle.
struct CycleInstant {
  int base_cycle = 0;
  int repetition = 1;
  Macroticks offset{0};
};

// One fragment of a PDU in one slot, or a status frame without PDU (pdu == kNoPdu). Static slots are
// 1..gNumberOfStaticSlots, higher ones are dynamic. A dynamic frame carries a PDU, unless the cluster describes no
// tasks. It is sent once per list, as long as its fragment, and not at all without a list
// (schedules/analysis/minislots.h).
struct FrameSlot {
  int slot = 0;  // frame id
  Channels channels = Channels::kAB;
  int base_cycle = 0;
  int repetition = 1;
  NodeId sender{};
  PduId pdu = kNoPdu;
  int fragment = 0;
  int line = 0;
  // Static frames only: the network management vector (gNetworkManagementVectorLength bytes) precedes the
  // fragment, and the payload preamble indicator is set.
  bool network_management = false;
  // Dynamic frames only: this message id (two bytes) precedes the fragment, and the payload preamble indicator
  // is set. Receivers accept the frame only with this id.
  std::optional<std::uint16_t> message_id = std::nullopt;
  // Dynamic frames without a PDU only, which a bus description may have: the length of the whole payload.
  int payload_bytes = 0;
  // The entry of the cluster file's list `frames` that has this slot, counted from 0. None in other files.
  std::optional<int> entry = std::nullopt;
};

// Puts frames in the order of Cluster::frames. Equal ones keep theirs.
void order(std::vector<FrameSlot>& frames);

inline constexpr int kMessageIdBytes = 2;

// Returns whether the instant or frame takes place in a cycle. `cycle` is the cycle counter or a running number,
// not negative.
template <class Multiplexed>
requires requires(const Multiplexed& one) { one.base_cycle, one.repetition; }
constexpr bool in_cycle(const Multiplexed& one, std::int64_t cycle) {
  const std::int64_t repetition = one.repetition;  // mostly a power of two, which needs no division
  const std::int64_t turn = (repetition & (repetition - 1)) == 0 ? cycle & (repetition - 1) : cycle % repetition;
  return turn == one.base_cycle;
}

constexpr bool is_dynamic(const GlobalParameters& flexray, const FrameSlot& frame) {
  return frame.slot > flexray.gNumberOfStaticSlots;
}
// Returns the bytes before the fragment: network management vector or message id.
constexpr int preamble_bytes(const GlobalParameters& flexray, const FrameSlot& frame) {
  return frame.message_id ? kMessageIdBytes : frame.network_management ? flexray.gNetworkManagementVectorLength : 0;
}
// Returns whether the frames share some cycle, or the sets some channel.
bool share_a_cycle(const FrameSlot& a, const FrameSlot& b);
constexpr bool share_a_channel(Channels a, Channels b) {
  return (static_cast<unsigned>(a) & static_cast<unsigned>(b)) != 0;
}

// Returns whether `frame` carries the next fragment of the same list in the next slot and is otherwise like
// `before`. With `step` 2 it carries the next fragment but one.
bool continues(const FrameSlot& before, const FrameSlot& frame, int step = 1);

// A PDU on a CAN. All fragments have the same identifier; the fragment number is in the data.
struct CanMessage {
  PduId pdu{};
  std::uint32_t identifier = 0;  // 11 bits
  NodeId sender{};
  Duration shortest_period{};  // in true time, between the queueing of two lists; proved by schedules/check/checker.h
  int line = 0;
};

struct CanBus {
  std::string name;
  bool flexible_data_rate = false;    // CAN FD with bit-rate switching
  std::int64_t nominal_bit_rate = 0;  // bit/s
  std::int64_t data_bit_rate = 0;     // bit/s, equal to nominal for classic CAN
  double other_load = 0.0;            // share of the bus that other traffic occupies (sim/medium/can_medium.h)
  std::vector<CanMessage> messages;
  int line = 0;
};

// Binds a port of a task to a PDU on a medium.
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
  kModes,       // at the instants of the task's modes (schedules/model/task_modes.h)
};

struct Activation {
  ActivationKind kind = ActivationKind::kTime;
  CycleInstant at{};  // with kModes, the grid of the frames' beginnings
  std::string port;
  SensorId sensor = kNoSensor;
  std::string after;
};

enum class ExecutionDraw : std::uint8_t {
  kUniform,  // between best and worst case, drawn per execution: the unsynchronised paradigm
  kWorst,    // always the worst case: the synchronised paradigm
};

struct Task {
  std::string name;
  std::string step;  // the name of its code
  Activation activation;
  Duration best_case{};  // execution time
  Duration worst_case{};
  ExecutionDraw draw = ExecutionDraw::kUniform;
  Duration deadline{};  // after activation
  // A list that an execution begins to work at is written by a later execution, which starts at most this long after.
  // Zero: by the same one.
  Duration holds{};
  std::vector<PortBinding> reads;
  std::vector<PortBinding> writes;
  std::vector<TaskMode> modes;  // with kModes, at least one; a drive begins with the first
  int line = 0;
};

// Returns whether time activates the task, on the grid of Activation::at.
constexpr bool is_by_time(const Activation& activation) {
  return activation.kind == ActivationKind::kTime || activation.kind == ActivationKind::kModes;
}

// Returns whether a list at this port, which the task reads, activates the task.
bool activates(const Task& task, const PortBinding& read);

struct Node {
  std::string name;
  std::optional<NodeParameters> flexray;  // absent for a node off FlexRay (a sensor device)
  std::int64_t microtick_ps = 25'000;     // nominal, also for nodes off FlexRay
  std::optional<std::int64_t> drift_ppb;  // fixed; else drawn within +-max_drift_ppb
  std::int64_t max_drift_ppb = 1'500'000;
  std::vector<Task> tasks;
  int line = 0;
};

// A sensor measures in one of three ways. Free: with a period on the device's own clock, first at `phase` (drawn
// if absent). Scheduled: at an instant of the host's global time, by a trigger line. Following: by the same
// line, at each end of a task of the host (its preprocessing), so as often as that task allows. Its first
// measurement is like a free one. A lost message would stop a following sensor: without a trigger the device
// measures by itself after `longest`. In all three the host latches its global time at the device's strobe, as
// the measurement's time stamp.
struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::kLaser;
  NodeId device{};  // the node that emulates it
  NodeId host{};    // the preprocessing node that triggers it and takes its strobe
  bool scheduled = false;
  Duration period{};  // free: the period; following: the device's shortest time between two measurements
  std::optional<Duration> phase;
  CycleInstant at{};   // scheduled
  std::string after;   // following: the task of the host (schedules/analysis/sensor_loop.h); else empty
  Duration longest{};  // following: longest time between two measurements, on the device's own clock
  int line = 0;
  // Free, in a drive that plays a recording: the instants of all measurements in place of phase and period, on the device's
  // clock from the start of the first cycle; never nearer to each other than the period. A device that restarts goes on
  // with the next one. No file has them.
  std::vector<Duration> instants;

  bool follows() const { return !after.empty(); }
  Duration longest_period() const { return follows() ? longest : period; }
};

// The wiring of the nodes, the same on both channels.
enum class Topology : std::uint8_t {
  kBus,   // one line with all nodes on it
  kStar,  // every node on its own branch, with an active star in the middle
};

// The arrival window of real-time media: how long before and after the action point of its slot a frame may
// arrive, on the receiver's clock. It replaces FlexRay's own windows, which an ordinary kernel misses by its
// wake-ups alone. Its times are real time: a stretched schedule (--time-scale) does not widen it. The schedule
// has room for it if the static segment continues for that long behind the last static slot in use.
struct ArrivalWindow {
  Duration early{};
  Duration late{};
};

// A value that a cluster file leaves out, since others determine it (schedules/file/derive.h).
struct DerivedValue {
  std::string path;   // "flexray.gdNIT"
  std::string value;  // as a file would have it
};

// The value of a key that an entry has from another one (schedules/file/likeness).
struct Inherited {
  std::string from;  // "sensors.laser"
  int line = 0;      // `like`
};

struct Cluster {
  std::string name;
  std::string file;     // for messages
  std::string text;     // the YAML as read, with all that the file extends; attached to logs
  TextOrigins origins;  // where the text's lines are from, if the file extends another
  GlobalParameters flexray;
  bool synchronisation = true;  // clock correction; switched off only for demonstration
  Topology topology = Topology::kBus;
  bool guardian = false;  // the stars pass only the frames of their schedule; needs kStar
  std::vector<PduLayout> pdus;
  std::vector<Node> nodes;
  std::vector<FrameSlot> frames;  // ordered by slot, then base cycle
  std::vector<CanBus> can_buses;
  std::vector<Sensor> sensors;
  std::optional<ArrivalWindow> arrival_window;  // `real_time`; absent: the schedule is for virtual time only
  // Keyed by "nodes", "guardian", "flexray.gdNIT", "nodes.fusion.flexray.pKeySlotId".
  std::map<std::string, int, std::less<>> parameter_lines;

  std::vector<DerivedValue> derived;
  std::map<std::string, Inherited, std::less<>> inherited;  // keyed by "sensors.rear.host"

  // Returns a finding about a line of `text`. It names the file and line from which that came. An inherited value is said to be
  // the other entry's.
  Finding finding(int line, std::string key, std::string value, std::string expected) const;
  // Returns the other entry for an inherited key, or for a part of its value; null for all other keys.
  const Inherited* inherited_at(std::string_view key) const;
  // False for a bus description, which has no tasks, no sensors and no messages on CANs. It can be checked as far as the
  // bus goes, drawn and exported. No node can run it.
  bool describes_tasks() const;
  const Node& node(NodeId id) const { return nodes[index_of(id)]; }
  const PduLayout& pdu(PduId id) const { return pdus[index_of(id)]; }
  const Sensor& sensor(SensorId id) const { return sensors[index_of(id)]; }
  const CanBus& can(MediumId id) const { return can_buses[id.can_index()]; }
  std::optional<NodeId> find_node(std::string_view name) const;
  std::optional<PduId> find_pdu(std::string_view name) const;
  std::optional<SensorId> find_sensor(std::string_view name) const;
  Duration cycle() const { return {flexray.cycle_ps() / 1000}; }
  // The time after which the whole schedule repeats, to the nanosecond.
  Duration round() const { return {cycles_per_round(flexray) * flexray.cycle_ps() / 1000}; }
};

// Return whether a task has this step.
bool has_step(const Node& node, std::string_view step);
bool has_step(const Cluster& cluster, std::string_view step);

// Returns whether a task of the node reads or writes on this CAN.
bool is_on_can(const Node& node, std::size_t can_bus);
std::vector<NodeId> nodes_on_can(const Cluster& cluster, std::size_t can_bus);  // in the order of ids

// Returns the global time of an instant in the n-th cycle since the start (n counts on beyond gCycleCountMax).
GlobalTime time_of(const GlobalParameters& flexray, std::int64_t cycle, Macroticks offset);

// The first occurrence of a periodic instant at or after `from`, and its cycle.
struct Occurrence {
  std::int64_t cycle = 0;
  GlobalTime time{};
};
Occurrence next_occurrence(const GlobalParameters& flexray, const CycleInstant& at, GlobalTime from);

}  // namespace ttf::schedules::model
