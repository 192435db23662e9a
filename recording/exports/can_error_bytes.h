// Errors on private CANs as SocketCAN's drivers report them: frames with an error flag in the identifier and eight bytes
// (Linux, include/uapi/linux/can/error.h). So captures show them to candump and Wireshark.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "recording/records/records.h"

namespace ttf::recording::exports {

struct CanErrorBytes {
  std::uint32_t identifier = 0;  // capture::kErrorFrame and the classes
  std::array<std::byte, 8> data{};
};
CanErrorBytes error_bytes_of(const records::CanErrorFrame& error);
CanErrorBytes error_bytes_of(const records::CanStateChanged& change);

}  // namespace ttf::recording::exports
