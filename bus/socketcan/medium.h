// The real-time medium on SocketCAN: one interface per FlexRay channel (docs/socketcan.md says what is on it), one per
// private CAN. It keeps the laws of bus/ports/live_medium.h; what is particular here:
//
//   lost       CAN frames that the receive buffer had no room for, each fragment by itself, echoes of this node's own
//              frames among them; and frames whose first fragments came and whose others did not
//   malformed  CAN frames in our form but wrong; fragments that continue nothing; on a private CAN, CAN FD frames of a
//              length that none has
//   foreign    on a channel all that is no CAN FD frame with an 11-bit identifier; on a private CAN error frames,
//              remote frames and 29-bit identifiers. What else is there is handed over, for the CAN controller to judge
//   not_sent   also a follow-up without room; and a frame in fragments of which some were sent before there was no room
//
// A sync frame's lateness is told in a follow-up, once the interface has confirmed the frame: its sender hears its own
// frames come back, stamped by the kernel, and keeps them to itself. On vcan that is at once, so that send() finds the
// echo and sends the follow-up, unless what others sent is still to be received first; then, and on real hardware,
// where the confirmation comes when the frame has left, receive() does.
//
// Fragments of one frame must follow one another on the bus (flexray_on_can.h): that is the schedule's business.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/ports/live_medium.h"
#include "bus/socketcan/departures.h"
#include "bus/socketcan/flexray_on_can.h"
#include "bus/socketcan/socket.h"

namespace ttf::bus::socketcan {

struct LiveOptions {
  struct Can {
    std::string interface;  // empty: this node is not on it
    bool flexible_data_rate = false;
  };
  std::array<std::string, 2> channels;  // interfaces of A and B; empty: this node is not on it
  std::vector<Can> cans;                // by Cluster::can_buses
  int receive_buffer_frames = 16'384;   // of each interface
};

class SocketCanMedium final : public ports::LiveMedium {
 public:
  // Throws InputError where kernel or interfaces are not as they must be, or two lines are to share one.
  explicit SocketCanMedium(const LiveOptions& options);

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::HostTime due) override;
  ports::LiveStatus send_can(std::size_t can_bus, const ports::CanFrame& frame) override;
  std::optional<ports::LiveArrival> receive() override;
  int descriptor(ports::Line line) const override;
  void watch(ports::Line, bool) override {}  // a socket is always readable
  ports::LiveCounts counts() const override;
  const std::string& failure() const override { return failure_; }

  // A sentence, with the command that helps, for each interface whose receive buffer is smaller than it should be.
  std::vector<std::string> shortages() const;

 private:
  struct FlexRay {
    schedules::model::Channel channel{};
    Reassembly reassembly;
    Departures departures;
  };
  struct OnLine {
    Socket socket;
    std::optional<FlexRay> flexray;            // of a channel
    std::uint64_t foreign = 0, malformed = 0;  // of a private CAN
  };

  OnLine& on(ports::Line line);
  ports::LiveStatus send_all(OnLine& line, std::span<const canfd_frame> frames);
  ports::LiveStatus done(Status status, const OnLine& line);
  void confirm(OnLine& line);
  void confirmed(OnLine& line, const Received& own);
  std::optional<ports::LiveArrival> take(ports::Line line);
  bool take_signal(FlexRay& flexray, ports::LiveArrival& arrival) const;
  bool take_can(OnLine& line, ports::LiveArrival& arrival) const;

  std::vector<std::optional<OnLine>> lines_;  // by Line; what this node is not on is empty
  ports::Line turn_ = 0;                      // which is received from, and for how many frames already
  int in_turn_ = 0;
  Received received_;  // what the last arrival's bytes are of
  Received own_;
  std::uint64_t sent_ = 0, not_sent_ = 0, received_count_ = 0;
  std::string failure_;
};

}  // namespace ttf::bus::socketcan
