// The harms that a fault on a CAN may do to fault-free nodes, and the checks that may notice it.
//
// A fault-free node is one that the fault does not name. Each of its frames is owed to every other fault-free node on
// the CAN. From the beginning of the fault on, there is harm when
//   C1  a fault-free node does not receive such a frame: a later one of the same message comes instead, or none within
//       the bound (frame_lost)
//   C2  it receives it behind the bound (frame_late)
//   C3  it receives a frame under a fault-free node's identifier that this node did not queue (frame_wrong)
//   C4  it receives such a frame twice (frame_twice)
//   C5  a frame of the faulty node fails more than 32 times in a row, each time with an error other than a missing
//       acknowledgement, and the node is not bus off (uncontained)
//
// The bound is the message's worst-case response time (schedules/analysis/can_load.h), and for each error frame that
// began while the frame waited the longest frame and 31 bits more: Bosch CAN Specification 2.0, part B, chapter 2, has 31
// bits as the longest time from an error to the next frame. At most 32 error frames count: with 8 transmit errors each
// a transmitter is bus off then (ISO 11898-1:2015, 12.1.4).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ttf::evaluation::faults {

enum class CanCheck : std::uint8_t {
  kBit,
  kStuff,
  kForm,
  kCrc,
  kAcknowledgement,  // error frames, by their first cause
  kForeign,          // a frame with an identifier of no message, or of another length
  kTorn,             // a list without some of its frames
  kPassive,
  kBusOff,  // states
};
inline constexpr std::array kAllCanChecks = {CanCheck::kBit,  CanCheck::kStuff,           CanCheck::kForm,
                                             CanCheck::kCrc,  CanCheck::kAcknowledgement, CanCheck::kForeign,
                                             CanCheck::kTorn, CanCheck::kPassive,         CanCheck::kBusOff};
std::string_view name_of(CanCheck check);

enum class CanHarm : std::uint8_t { kFrameLost, kFrameLate, kFrameWrong, kFrameTwice, kUncontained };
inline constexpr std::array kAllCanHarms = {CanHarm::kFrameLost, CanHarm::kFrameLate, CanHarm::kFrameWrong,
                                            CanHarm::kFrameTwice, CanHarm::kUncontained};
std::string_view name_of(CanHarm harm);

}  // namespace ttf::evaluation::faults
