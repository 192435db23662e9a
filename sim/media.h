// The simulated media: a FlexRay of two channels and any number of private CANs, in virtual time.
//
// FlexRay: a linear bus with the nodes equally spaced along it; the propagation delay between two nodes grows from
// gdMinPropagationDelay (neighbours at no distance) to gdMaxPropagationDelay (the two ends). Frames arrive unharmed at
// everybody on the channel, in the order the port's laws state (bus/flexray_port.h).
// CAN: arbitration by identifier whenever the bus falls idle, durations with the exact stuff bits of the data.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bus/can_port.h"
#include "bus/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/cluster.h"
#include "sim/event_queue.h"
#include "sim/frame_pool.h"

namespace ttf::sim {

// A pending arrival or arbitration.
struct MediumEvent {
  enum class Kind : std::uint8_t {
    kFlexRayArrival, kCanArrival, kCanSent, kCanArbitration, kStrobe, kTrigger, kObservation
  };
  Kind kind{};
  std::uint8_t node = 0;          // receiver, or sender of what was sent; the bus for an arbitration
  std::uint8_t channel_or_bus = 0;
  std::uint8_t sensor = 0;
  bool flexible_data_rate = false;
  std::uint32_t identifier = 0;   // CAN identifier, or a measurement's sequence
  std::uint32_t frame = 0;        // in the pool
  TrueTime start{};               // of the frame at the receiver
};
using MediumQueue = EventQueue<MediumEvent>;

class FlexRayMedium {
 public:
  FlexRayMedium(const schedules::Cluster& cluster, MediumQueue& queue, FramePool& pool);
  // `start`: true time of the first bit at the sender.
  void transmit(NodeId sender, schedules::Channel channel, TrueTime start, std::span<const std::byte> bytes);
  Duration delay(NodeId from, NodeId to) const;

 private:
  MediumQueue& queue_;
  FramePool& pool_;
  const schedules::GlobalParameters& flexray_;
  std::vector<NodeId> nodes_;     // on FlexRay, in bus order
  std::vector<int> position_;     // by NodeId, -1 off the bus
};

class CanMedium {
 public:
  // `sink` hears of each frame when it begins: what the wire carries, in true time. The rest its sender knows.
  CanMedium(const schedules::Cluster& cluster, std::size_t bus, std::span<const NodeId> nodes, MediumQueue& queue,
            FramePool& pool, records::Sink& sink);
  void send(NodeId sender, TrueTime now, const bus::CanFrame& frame);
  // The bus is idle: the pending frame that wins is sent.
  void arbitrate(TrueTime now);
  // How long the bus has carried frames, the one on it included to its end.
  Duration busy() const { return busy_; }

 private:
  struct Pending {
    NodeId sender{};
    std::uint64_t order = 0;
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::uint32_t frame = 0;
  };
  void report(const Pending& frame, TrueTime start, TrueTime end);

  const schedules::Cluster& cluster_;
  std::size_t bus_;
  std::vector<NodeId> nodes_;
  MediumQueue& queue_;
  FramePool& pool_;
  records::Sink& sink_;
  std::vector<Pending> pending_;
  std::uint64_t next_order_ = 0;
  TrueTime idle_from_{};
  bool arbitration_due_ = false;
  Duration busy_{};
};

}  // namespace ttf::sim
