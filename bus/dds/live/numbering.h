// A numbering tracks the running numbers of a line's senders: it finds repeated and lost samples. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/ids.h"

namespace ttf::bus::dds::live {

class LiveNumbering {
 public:
  // Returns the number of samples missing before this one; no value if this or a later one has been received before.
  // A restarted sender counts anew, and so does one received for the first time: its earlier samples do not count.
  std::optional<std::uint64_t> missing_before(NodeId sender, std::uint64_t incarnation, std::uint64_t number) {
    Next& next = next_[index_of(sender)];
    const bool known = next.received && next.incarnation == incarnation;
    if (known && number < next.number) return {};
    const std::uint64_t missing = known ? number - next.number : 0;
    next = {true, incarnation, number + 1};
    return missing;
  }

 private:
  struct Next {
    bool received = false;
    std::uint64_t incarnation = 0;
    std::uint64_t number = 0;
  };
  std::array<Next, 256> next_{};
};

}  // namespace ttf::bus::dds::live
