// One line of the DDS live medium, as one node has it: the topic, a writer, and a reader with its arrivals
// (bus/dds/live/reception.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/live/reception.h"
#include "bus/ports/live_medium.h"
#include "core/ids.h"

namespace ttf::bus::dds::live {

// A line and its nodes.
struct LiveLinePlan {
  ports::Line line = 0;
  std::string topic;                  // live_topic()
  std::vector<NodeId> nodes;          // all nodes on the line, this one included
  std::vector<NodeId> not_awaited{};  // those of them that may come later, or name no endpoint
};

// LiveSample::kind: a ports::Signal, or one of these.
inline constexpr std::uint8_t kClassicCan = 4, kFastCan = 5;

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
  LiveQueue& queue() { return reception_.queue(); }
  const LiveQueue& queue() const { return reception_.queue(); }

  // The sender and receiver count `sent`, `not_sent` and `received`.
  std::uint64_t lost() const { return reception_.lost(); }
  std::uint64_t foreign() const { return reception_.foreign(); }
  std::uint64_t malformed() const { return reception_.malformed(); }
  // Returns one sentence about the line's failure; empty without one. May allocate.
  std::string failure() const;

  // Nodes on this line that this node awaits: those that it does not receive yet, or that do not receive it.
  std::vector<NodeId> missing_senders() const;
  std::vector<NodeId> deaf() const;

 private:
  struct Sample;  // DDS' own form

  ports::LiveStatus write(std::span<const std::byte> bytes, ports::MachineTime due);
  std::vector<NodeId> all_but(const std::vector<NodeId>& found) const;

  const ports::Line line_;
  const std::string topic_;
  const NodeId self_;
  const std::vector<NodeId> nodes_, not_awaited_;
  const std::unique_ptr<Sample> out_;
  Reception reception_;
  std::int32_t write_error_ = 0;  // DDS' return code
  std::uint64_t next_number_ = 0;
  common::Handle writer_ = 0;
};

// Returns "ttf/flexray/A", "ttf/flexray/B", "ttf/can/NAME". DDS allows letters, digits, '_' and '/'. In a name
// every other character, and an ambiguous '_', becomes '_' and two hexadecimal digits.
std::string live_topic(schedules::model::Channel channel);
std::string live_can_topic(const std::string& name);

}  // namespace ttf::bus::dds::live
