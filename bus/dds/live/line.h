// One line of a medium in real time over DDS, as one node has it: the topic, a writer, a reader, and what has arrived.
//
// Arrivals are taken and stamped by DDS' own threads as they come in, and wait in a queue. Where the sender runs on the
// same host (bus/dds/common/host_identity.h), a sample has arrived when it was handed to DDS there: the clock is the
// same, and how long the kernel takes to wake up who reads it says nothing about the sender's clock. From another host
// it has arrived when it was handed to DDS there, by that host's clock, and the least delay of late that is known from
// there (bus/dds/live/arrival_instant.h). Where a host cannot be told from another, it arrives when it is taken.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/live/arrival_instant.h"
#include "bus/dds/live/numbering.h"
#include "bus/dds/live/queue.h"
#include "bus/ports/live_medium.h"
#include "core/ids.h"

namespace ttf::bus::dds::live {

enum class Delivery {
  kBestEffort,  // what is lost is lost, and counted
  kReliable,    // sent again where it is missing, from the last kHistory that its writer keeps, which waits for nobody
};

// A line and who is on it.
struct LiveLinePlan {
  ports::Line line = 0;
  std::string topic;          // live_topic()
  std::vector<NodeId> nodes;  // all of them, whoever reads this
};

class LiveLine {
 public:
  static constexpr std::int32_t kHistory = 256;

  // Throws std::runtime_error where DDS cannot do it.
  LiveLine(const common::Participant& participant, const std::string& session, NodeId self, const LiveLinePlan& plan,
           Delivery delivery);
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  ports::Line line() const { return line_; }

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::HostTime due);
  ports::LiveStatus send(const ports::CanFrame& frame);
  LiveQueue& queue() { return queue_; }
  const LiveQueue& queue() const { return queue_; }

  // `sent`, `not_sent` and `received` are whoever's who sends and receives.
  std::uint64_t lost() const { return lost_.load(); }
  std::uint64_t foreign() const { return foreign_.load(); }
  std::uint64_t malformed() const { return malformed_.load(); }
  // Why it is of no use any more; empty while all is well. May allocate.
  std::string failure() const;

  // Nodes on this line that are not heard, or do not hear this one, yet.
  std::vector<NodeId> unheard() const;
  std::vector<NodeId> deaf() const;

 private:
  struct Boxes;  // DDS' own form of a sample

  static void on_data(common::Handle reader, void* self);
  void take(common::Handle reader);
  void accept(std::size_t box, ports::HostTime now);
  ports::LiveStatus write(std::span<const std::byte> bytes, ports::HostTime due);
  std::vector<NodeId> all_but(const std::vector<NodeId>& found) const;

  const ports::Line line_;
  const std::string topic_;
  const NodeId self_;
  const std::uint64_t host_;
  std::vector<NodeId> nodes_;
  std::array<bool, 256> is_on_{};  // by node
  const std::unique_ptr<Boxes> boxes_;
  LiveQueue queue_;
  LiveNumbering numbering_;  // of DDS' threads, and so is the next
  ArrivalInstant from_afar_;
  std::atomic<std::uint64_t> lost_{0}, foreign_{0}, malformed_{0};
  std::int32_t write_error_ = 0;  // DDS' return codes
  std::atomic<std::int32_t> take_error_{0};
  std::uint64_t next_number_ = 0;
  common::Handle writer_ = 0, reader_ = 0;
};

// "ttf/flexray/A", "ttf/flexray/B", "ttf/can/NAME": DDS allows letters, digits, '_' and '/', so anything else in a
// name, and what would be mistaken for it, is '_' and two hexadecimal digits.
std::string live_topic(schedules::model::Channel channel);
std::string live_can_topic(const std::string& name);

}  // namespace ttf::bus::dds::live
