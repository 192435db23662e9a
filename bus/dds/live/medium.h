// The DDS live medium: one topic per line, one sample per signal or CAN frame (bus/dds/live/live_sample.idl),
// in the session's partition. Only the readers of a line get its samples.
//
// No node waits for another: a stopped or dead one does not hold up a sender, with either delivery
// (docs/media/dds.md has their costs). Each sender numbers its samples on a line, so that missing ones are counted
// once a later one is received. A restarted process begins its count anew.
//
// A sender stamps each sample right before it hands it to DDS. On the same machine that stamp is
// LiveArrival::at. On another, `at` is the stamp by the receiver's clock plus the least delay from there
// (bus/dds/live/arrival_instant.h). So L4 holds between machines as well as their clocks are known. The sample
// itself states its lateness; there are no follow-ups.
//
// This code allocates nothing after construction. DDS itself allocates for every sample, from its own pools.
// One thread sends and receives at a time; DDS' own threads take the incoming samples.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/session.h"
#include "bus/dds/live/line.h"
#include "bus/ports/live_medium.h"

namespace ttf::bus::dds::live {

class DdsMedium final : public ports::LiveMedium {
 public:
  // Uses the session's domain, name and lease. `lines`: those that `self` is on, in any order. Throws
  // InputError on an invalid session, std::runtime_error if DDS cannot.
  DdsMedium(const common::Session& session, NodeId self, const std::vector<LiveLinePlan>& lines,
            Delivery delivery = Delivery::kBestEffort);
  ~DdsMedium() override;

  // Returns once this node and all others on its lines receive each other. Throws NotReady after `patience`.
  void wait_ready(std::chrono::milliseconds patience) const;

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::MachineTime due) override;
  ports::LiveStatus send_can(std::size_t can_bus, const ports::CanFrame& frame) override;
  std::optional<ports::LiveArrival> receive() override;
  int descriptor(ports::Line line) const override;
  void watch(ports::Line line, bool on) override;
  ports::LiveCounts counts() const override;
  const std::string& failure() const override;

 private:
  LiveLine* find(ports::Line line) const;
  ports::LiveStatus counted(ports::LiveStatus status);

  common::Session session_;
  common::Participant participant_;
  std::vector<std::unique_ptr<LiveLine>> lines_;  // by line; nullptr: this node is not on it
  LiveItem last_;                                 // the last result of receive()
  std::uint64_t sent_ = 0, received_ = 0, not_sent_ = 0;
  mutable std::string failure_;
};

}  // namespace ttf::bus::dds::live
