// What the running numbers of a line's senders tell: what has been heard before, and what never will be. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/ids.h"

namespace ttf::bus::dds::live {

class LiveNumbering {
 public:
  // The number of samples that are missing before this one; nothing where it has been heard before, or a later one has.
  // A sender that has started anew counts anew, and so does one that is heard for the first time: what it said before
  // is none of ours.
  std::optional<std::uint64_t> missing_before(NodeId sender, std::uint64_t incarnation, std::uint64_t number) {
    Next& next = next_[index_of(sender)];
    const bool known = next.heard && next.incarnation == incarnation;
    if (known && number < next.number) return {};
    const std::uint64_t missing = known ? number - next.number : 0;
    next = {true, incarnation, number + 1};
    return missing;
  }

 private:
  struct Next {
    bool heard = false;
    std::uint64_t incarnation = 0;
    std::uint64_t number = 0;
  };
  std::array<Next, 256> next_{};
};

}  // namespace ttf::bus::dds::live
