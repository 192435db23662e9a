// A node's place on a private CAN in real time. Frames leave one after the other, each when the receivers on a CAN of
// the cluster's bit rates would have accepted it. Media such as vcan carry a hundred frames in no time, so a task
// that a list activates would run milliseconds too early. Frames of other nodes do not delay them here; a real
// bus delays them by itself.
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
  // `now`: true time, with the node's clocks. `most`: the largest number of waiting frames.
  PacedCan(const schedules::model::Cluster& cluster, std::size_t can_bus, std::size_t most,
           std::function<recording::records::Stamp()> now);

  // Queues a frame; drops and counts it if there is no room.
  void send(const bus::ports::CanFrame& frame) override;

  // Returns the acceptance of the first waiting frame; far in the future if no frame waits.
  TrueTime next() const;
  struct Departure {
    bus::ports::CanFrame frame;
    recording::records::CanFrameSent sent;  // as Executive::can_frame_sent() takes it
  };
  // Takes the first frame out; it must go to the medium now. Precondition: a frame waits. Views are valid until
  // the next call of any function here.
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
  recording::records::Stamp began_;   // start of the first waiting frame
  TrueTime through_{}, idle_from_{};  // the first waiting frame is accepted; the bus is idle behind it
  std::uint64_t dropped_ = 0;
};

}  // namespace ttf::nodes::runner
