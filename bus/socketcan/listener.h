// Receives frames on CAN interfaces (bus/ports/listener.h). On a channel a frame is malformed if it has the
// identifier of a received slot and is not made as flexray_on_can.h says: classic CAN, a wrong header CRC, a length
// that the header contradicts, a displaced fragment. On a private CAN it is malformed if CAN FD has no such
// length, or if it is a remote frame.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "bus/ports/listener.h"
#include "bus/socketcan/flexray_on_can.h"
#include "bus/socketcan/socket.h"

namespace ttf::bus::socketcan {

class SocketCanListener final : public ports::Listener {
 public:
  // Interfaces of A and B, empty: not received; of private CANs by Cluster::can_buses, each with CAN FD or not. Throws
  // InputError if the kernel or an interface is unsuitable.
  struct Can {
    std::string interface;
    bool flexible_data_rate = false;
  };
  SocketCanListener(const std::array<std::string, 2>& channels, const std::vector<Can>& cans,
                    const ports::ReceivedIdentifiers& identifiers);

  std::optional<ports::ReceivedFrame> receive() override;
  std::uint64_t lost() const override;
  const std::string& failure() const override { return failure_; }

 private:
  struct OnLine {
    ports::Line line = 0;
    Socket socket;
    std::optional<Reassembly> reassembly;  // of a channel
  };
  std::optional<ports::ReceivedFrame> on_channel(OnLine& line);
  std::optional<ports::ReceivedFrame> on_can() const;

  std::vector<OnLine> lines_;
  std::size_t turn_ = 0;  // the line being received from
  Received received_;     // has the last frame's bytes
  std::string failure_;
};

}  // namespace ttf::bus::socketcan
