// The network management vector (FlexRay 2.1A, chapter 9.3; SPNU563A 26.2.7 and registers NMV1..3). By its
// bits the nodes of a cluster agree on their needs, for instance whether any node still needs the bus.
//
// A static frame scheduled for it begins with its sender's vector, gNetworkManagementVectorLength bytes, and
// sets the payload preamble indicator. A controller combines the vectors of all valid frames with that
// indicator, of both channels, by bitwise OR. The host reads the result of the previous cycle (MFR4200: "as
// presented in cycle x, of cycle x - 1").
//
// Interpretation: the indicator decides, not the receiver's schedule for the slot. The own vector counts in
// the cycles in which it is sent, so that all nodes read the same. Only cycles that end in normal operation
// are shown: in halt the vector stays as it was, and a new schedule begins with zeros. A null frame carries no
// vector; a status frame always does, and a list's frame with its list.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace ttf::bus::controller {

inline constexpr std::size_t kMaxNetworkManagementBytes = 12;

class NetworkManagement {
 public:
  explicit NetworkManagement(int length);  // gNetworkManagementVectorLength, 0..12 bytes

  void reset();  // forgets all received vectors; the own one stays
  // Sets the vector of this node's frames from the next one on; zeros before. Exactly as long as the vector.
  void set_own(std::span<const std::byte> vector);
  std::span<const std::byte> own() const { return std::span(own_).first(length_); }
  // Takes in a vector of the running cycle from the beginning of `payload`. Missing bytes count as zeros.
  void combine(std::span<const std::byte> payload);
  void end_cycle(bool in_normal_operation);
  // The result of the last cycle that ended in normal operation.
  std::span<const std::byte> combined() const { return std::span(shown_).first(length_); }

 private:
  using Vector = std::array<std::byte, kMaxNetworkManagementBytes>;

  std::size_t length_;
  Vector own_{}, running_{}, shown_{};
};

}  // namespace ttf::bus::controller
