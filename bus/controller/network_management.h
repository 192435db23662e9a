// The network management vector: bits by which the nodes of a cluster agree on what they need, for instance whether
// anybody still needs the bus (FlexRay 2.1A, chapter 9.3; SPNU563A 26.2.7 and registers NMV1..3).
//
// A static frame whose schedule says so begins with its sender's vector, gNetworkManagementVectorLength bytes, and sets
// the payload preamble indicator. A controller combines the vectors of all valid frames with that indicator, of both
// channels, by bitwise OR; the host reads the result of the cycle before (MFR4200: "as presented
// in cycle x, of cycle x - 1").
//
// Readings taken: What counts is the indicator, not what the receiver's schedule expects of the slot. The own vector
// counts in the cycles it leaves in, so that all nodes read the same. Only cycles that end in normal operation are
// shown: in halt the vector stays as it was, and with a new schedule it begins as zeros. A null frame carries none; a
// status frame always does, a list's frame with its list.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace ttf::bus::controller {

inline constexpr std::size_t kMaxNetworkManagementBytes = 12;

class NetworkManagement {
 public:
  explicit NetworkManagement(int length);  // gNetworkManagementVectorLength, 0..12 bytes

  void reset();  // nothing has been heard; the own vector stays
  // What this node says from its next frame on; zeros before. Exactly as long as the vector.
  void set_own(std::span<const std::byte> vector);
  std::span<const std::byte> own() const { return std::span(own_).first(length_); }
  // A vector of the running cycle, at the beginning of `payload`. One that is cut off counts as if zeros followed.
  void combine(std::span<const std::byte> payload);
  void end_cycle(bool in_normal_operation);
  // Of the last cycle that ended in normal operation.
  std::span<const std::byte> combined() const { return std::span(shown_).first(length_); }

 private:
  using Vector = std::array<std::byte, kMaxNetworkManagementBytes>;

  std::size_t length_;
  Vector own_{}, running_{}, shown_{};
};

}  // namespace ttf::bus::controller
