// The load of each bus in a drive, from the senders' records, so that drives on real media have it, too.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::cluster {

class BusUse final : public recording::records::Sink {
 public:
  explicit BusUse(const schedules::model::Cluster& cluster) : cluster_(cluster), cans_(cluster.can_buses.size()) {}

  using recording::records::Sink::on;
  void on(const recording::records::SlotFrameSent& frame) override;
  void on(const recording::records::CanFrameSent& frame) override;

  std::uint64_t frames_sent() const { return frames_sent_; }  // on FlexRay, summed over the channels
  // Loads of the busier channel, and of each CAN.
  double flexray_load(Duration elapsed) const;
  std::vector<double> can_load(Duration elapsed) const;

 private:
  const schedules::model::Cluster& cluster_;
  std::array<Duration, 2> channels_{};
  std::vector<Duration> cans_;
  std::uint64_t frames_sent_ = 0;
};

}  // namespace ttf::evaluation::cluster
