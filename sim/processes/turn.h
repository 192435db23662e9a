// A node's message to the others in its turn, when each runs in a process of its own
// (sim/processes/turn_taking.h): its acts, in their order, and its promise from then on.
//
// The message, everything little-endian:
//   turn   u8 node, u32 number (counted from 0), i64 instant [uT of the node], i64 silent_until [uT],
//          i64 after_flexray, i64 after_can, i64 after_trigger [uT], u16 number of acts, the acts
//   act    u8 kind, then
//     1 signal    u8 channel (0 A, 1 B), u8 bus::ports::Signal, i64 start [uT], i64 end [uT], u16 slot, u16 size, the
//                 frame's bytes
//     2 CAN frame u8 bus, u32 identifier, u8 flexible data rate (0, 1), u8 size, the data
//     3 trigger   u8 sensor
//     4 strobe    u8 sensor, u32 sequence
//     5 actuation i64 true instant [ns] from which on it holds, f64 acceleration [m/s^2], f64 steering [rad]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "bus/ports/can_port.h"
#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "nodes/host/promise.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::sim::processes {

struct CanAct {
  std::size_t bus = 0;
  bus::ports::CanFrame frame;
};
struct TriggerAct {
  SensorId sensor{};
};
struct StrobeAct {
  SensorId sensor{};
  std::uint32_t sequence = 0;
};
// A transmission's content is decoded from its bytes.
using Act = std::variant<bus::ports::Transmission, CanAct, TriggerAct, StrobeAct, nodes::host::Actuation>;

struct TurnHeader {
  NodeId node{};
  std::uint32_t number = 0;
  Microticks at{};
  nodes::host::Promise promise;
};

// A turn under construction. Its memory grows only to the size of its longest turn.
class TurnWriter {
 public:
  TurnWriter();
  void add(const Act& act);
  bool empty() const { return acts_ == 0; }
  // Returns the whole message, valid until the next add() or clear().
  std::span<const std::byte> finish(const TurnHeader& header);
  void clear();

 private:
  std::vector<std::byte> bytes_;
  std::uint16_t acts_ = 0;
};

// Reads one turn of a node of `cluster` and checks it: the acts are the node's own, none begins before the
// turn, the promise goes beyond it, and frames are sound. Otherwise throws std::runtime_error with a sentence.
// `acts` refer into `bytes`.
TurnHeader read_turn(const schedules::model::Cluster& cluster, std::span<const std::byte> bytes,
                     std::vector<Act>& acts);

}  // namespace ttf::sim::processes
