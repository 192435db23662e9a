// One line of the DDS live medium, as one node has it: the topic, a writer, a reader, and the arrivals.
//
// DDS' own threads take and stamp arrivals, which wait in a queue. A sample from the same machine
// (bus/dds/common/host_identity.h) arrives when its sender hands it to DDS. The clock is the same, and the
// reader's late wake-up says nothing about the sender's clock. A sample from another machine arrives at that
// instant by its sender's clock plus the recent least delay from there (bus/dds/live/arrival_instant.h). If
// the machines cannot be told apart, it arrives when it is taken.
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
  kBestEffort,  // lost samples are counted, not repeated
  kReliable,    // missing samples are repeated from the writer's last kHistory; the writer never waits
};

// A line and its nodes.
struct LiveLinePlan {
  ports::Line line = 0;
  std::string topic;          // live_topic()
  std::vector<NodeId> nodes;  // all nodes on the line, this one included
};

class LiveLine {
 public:
  static constexpr std::int32_t kHistory = 256;

  // Throws std::runtime_error if DDS cannot.
  LiveLine(const common::Participant& participant, const std::string& session, NodeId self, const LiveLinePlan& plan,
           Delivery delivery);
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  ports::Line line() const { return line_; }

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::MachineTime due);
  ports::LiveStatus send(const ports::CanFrame& frame);
  LiveQueue& queue() { return queue_; }
  const LiveQueue& queue() const { return queue_; }

  // The sender and receiver count `sent`, `not_sent` and `received`.
  std::uint64_t lost() const { return lost_.load(); }
  std::uint64_t foreign() const { return foreign_.load(); }
  std::uint64_t malformed() const { return malformed_.load(); }
  // Returns one sentence about the line's failure; empty without one. May allocate.
  std::string failure() const;

  // Nodes on this line that this node does not hear yet, or that do not hear it.
  std::vector<NodeId> unheard() const;
  std::vector<NodeId> deaf() const;

 private:
  struct Boxes;  // DDS' own form of a sample

  static void on_data(common::Handle reader, void* self);
  void take(common::Handle reader);
  void accept(std::size_t box, ports::MachineTime now);
  ports::LiveStatus write(std::span<const std::byte> bytes, ports::MachineTime due);
  std::vector<NodeId> all_but(const std::vector<NodeId>& found) const;

  const ports::Line line_;
  const std::string topic_;
  const NodeId self_;
  const std::uint64_t host_;
  std::vector<NodeId> nodes_;
  std::array<bool, 256> is_on_{};  // by node
  const std::unique_ptr<Boxes> boxes_;
  LiveQueue queue_;
  LiveNumbering numbering_;  // used by DDS' threads only, as the next
  ArrivalInstant from_afar_;
  std::atomic<std::uint64_t> lost_{0}, foreign_{0}, malformed_{0};
  std::int32_t write_error_ = 0;  // DDS' return codes
  std::atomic<std::int32_t> take_error_{0};
  std::uint64_t next_number_ = 0;
  common::Handle writer_ = 0, reader_ = 0;
};

// Returns "ttf/flexray/A", "ttf/flexray/B", "ttf/can/NAME". DDS allows letters, digits, '_' and '/'. In a name
// every other character, and an ambiguous '_', becomes '_' and two hexadecimal digits.
std::string live_topic(schedules::model::Channel channel);
std::string live_can_topic(const std::string& name);

}  // namespace ttf::bus::dds::live
