// The medium in real time over DDS: one topic per line, one sample per signal or CAN frame
// (bus/dds/live/live_sample.idl), in the session's partition. Nobody but the readers of a line is sent what is said on
// it.
//
// Nobody waits for anybody: who is stopped or dead does not hold up a sender, whatever the delivery (docs/dds.md has
// what either costs). Each sender numbers what it says on a line, so that what is missing is counted once something
// later is heard; a process that was started anew counts anew.
//
// What was sent is stamped by its sender as it is handed to DDS, right before it is written: that is LiveArrival::at
// where both run on one host, and where they do not, that by this host's clock and the least delay from there
// (bus/dds/live/arrival_instant.h), so that L4 holds between hosts as well as their clocks are known. How late that was
// is said in the sample itself; there are no follow-ups.
//
// This code allocates nothing after construction. DDS itself does for every sample: malloc from its own pools.
// One thread sends and receives at a time; DDS' own threads take what comes in.
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
  // Of the session: its domain, name and lease. `lines`: those that `self` is on, in any order.
  // Throws InputError where the session is not valid, std::runtime_error where DDS cannot do it.
  DdsMedium(const common::Session& session, NodeId self, const std::vector<LiveLinePlan>& lines,
            Delivery delivery = Delivery::kBestEffort);
  ~DdsMedium() override;

  // Returns once this node hears everybody on its lines and they hear it. Throws NotReady when that takes longer.
  void wait_ready(std::chrono::milliseconds patience) const;

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::HostTime due) override;
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
  std::vector<std::unique_ptr<LiveLine>> lines_;  // by line; nullptr: not on it
  LiveItem last_;                                 // what receive() handed over
  std::uint64_t sent_ = 0, received_ = 0, not_sent_ = 0;
  mutable std::string failure_;
};

}  // namespace ttf::bus::dds::live
