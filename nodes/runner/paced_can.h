// A node's place on a private CAN in real time. Frames leave one after the other, each when a CAN of the cluster's bit
// rates would have brought it to the others: media such as vcan carry a hundred frames in no time, and a task that a
// list activates would run milliseconds before it could have the list. Other nodes' frames do not hold them up here; a
// real bus does that by itself.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "bus/ports/can_port.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::runner {

class PacedCan final : public bus::ports::CanPort {
 public:
  // `now`: true time, with the node's clocks. `most`: frames that wait, at most.
  PacedCan(const schedules::model::Cluster& cluster, std::size_t can_bus, std::size_t most,
           std::function<recording::records::Stamp()> now);

  // What there is no room for is dropped, and counted.
  void send(const bus::ports::CanFrame& frame) override;

  // When the first that waits has come through; far in the future where none waits.
  TrueTime next() const;
  struct Departure {
    bus::ports::CanFrame frame;
    recording::records::CanFrameSent sent;  // as Executive::can_frame_sent() takes it
  };
  // It leaves: to be put on the medium now. Precondition: one waits. Views are valid until the next call of anything
  // here.
  Departure leave();
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Waiting {
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::size_t size = 0;
    std::array<std::byte, 64> data{};
  };
  void begin_first(TrueTime at);

  const schedules::model::CanBus& bus_;
  const std::uint8_t can_bus_;
  const std::function<recording::records::Stamp()> now_;
  std::vector<Waiting> ring_;
  std::size_t first_ = 0, count_ = 0;
  recording::records::Stamp began_;  // the first of them
  TrueTime through_{}, idle_from_{};
  std::uint64_t dropped_ = 0;
};

}  // namespace ttf::nodes::runner
