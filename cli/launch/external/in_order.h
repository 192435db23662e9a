// Brings frames into the order of their instants: a listener receives a line to its end before it receives the next one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "bus/ports/listener.h"

namespace ttf::cli::launch::external {

class InOrder {
 public:
  // Keeps the frame with a copy of its bytes.
  void add(const bus::ports::ReceivedFrame& received);

  // Hands over all frames, the earliest first, and forgets them. The frames of a line keep their order, even if the
  // machine's clock does not.
  template <class To> void hand_over(To&& to) {
    std::ranges::stable_sort(kept_, {}, &Kept::key);
    for (Kept& kept : kept_) {
      const auto bytes = std::span<const std::byte>(bytes_).subspan(kept.from, kept.size);
      (kept.received.form == bus::ports::ReceivedFrame::Form::kCan ? kept.received.can.data : kept.received.bytes) =
          bytes;
      to(kept.received);
    }
    clear();
  }

 private:
  struct Kept {
    bus::ports::MachineTime key{};  // no earlier than that of the frame before on its line
    bus::ports::ReceivedFrame received;
    std::size_t from = 0, size = 0;  // in bytes_
  };
  void clear();

  std::vector<Kept> kept_;
  std::vector<std::byte> bytes_;
  std::vector<bus::ports::MachineTime> newest_;  // key by line
};

}  // namespace ttf::cli::launch::external
