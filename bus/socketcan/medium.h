// The SocketCAN live medium: one interface per FlexRay channel (docs/media/socketcan.md describes its frames), one
// per private CAN. It keeps the laws of bus/ports/live_medium.h. Particular here:
//
//   lost       CAN frames that the receive buffer had no room for, each fragment by itself, also echoes of this node's
//              own frames; and frames of which only the first fragments came
//   malformed  CAN frames in our form but wrong; fragments that continue no frame; on a private CAN, CAN FD frames of
//              an impossible length
//   foreign    on a channel everything except CAN FD frames with an 11-bit identifier; on a private CAN remote frames,
//              29-bit identifiers, and the interface's reports that are neither errors nor states (error_report.h).
//              Other frames there are left to the CAN controller's judgement
//   not_sent   also a follow-up without room; and a frame of which only some fragments had room
//
// A follow-up states a sync frame's lateness once the interface has confirmed the frame. The sender receives its
// own frames back, stamped by the kernel, and keeps them to itself. On vcan the echo is immediate: send()
// finds it and sends the follow-up, unless frames of others are to be received first. In that case receive()
// sends it, as on real hardware, where the confirmation comes when the frame has left.
//
// The schedule must let the fragments of one frame follow one another on the bus (flexray_on_can.h).
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
  std::array<std::string, 2> channels;  // interfaces of A and B; empty: this node is not on that channel
  std::vector<Can> cans;                // by Cluster::can_buses
  int receive_buffer_frames = 16'384;   // of each interface
};

class SocketCanMedium final : public ports::LiveMedium {
 public:
  // Throws InputError if the kernel or an interface is unsuitable, or if two lines share an interface.
  explicit SocketCanMedium(const LiveOptions& options);

  ports::LiveStatus send(const ports::LiveSignal& signal, ports::MachineTime due) override;
  ports::LiveStatus send_can(std::size_t can_bus, const ports::CanFrame& frame) override;
  std::optional<ports::LiveArrival> receive() override;
  int descriptor(ports::Line line) const override;
  void watch(ports::Line, bool) override {}  // a socket is always readable
  ports::LiveCounts counts() const override;
  const std::string& failure() const override { return failure_; }

  // Returns a sentence, with the command that helps, for each interface with too small a receive buffer.
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
    std::uint64_t foreign = 0, malformed = 0;  // on a private CAN
  };

  OnLine& on(ports::Line line);
  ports::LiveStatus send_all(OnLine& line, std::span<const canfd_frame> frames);
  ports::LiveStatus done(Status status, const OnLine& line);
  void confirm(OnLine& line);
  void confirmed(OnLine& line, const Received& own);
  std::optional<ports::LiveArrival> take(ports::Line line);
  bool take_signal(FlexRay& flexray, ports::LiveArrival& arrival) const;
  bool take_can(OnLine& line, ports::LiveArrival& arrival) const;

  std::vector<std::optional<OnLine>> lines_;  // by Line; empty if this node is not on the line
  ports::Line turn_ = 0;                      // the line being received from; in_turn_: its frames so far
  int in_turn_ = 0;
  Received received_;  // has the last arrival's bytes
  Received own_;
  std::uint64_t sent_ = 0, not_sent_ = 0, received_count_ = 0;
  std::string failure_;
};

}  // namespace ttf::bus::socketcan
