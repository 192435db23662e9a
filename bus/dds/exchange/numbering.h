// A numbering tracks the running numbers of a topic on which all senders are received in order: it finds new,
// repeated and lost samples.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <stdexcept>

#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class Numbering {
 public:
  // Returns whether this is the sender's next sample; false if it has been received before. Throws
  // std::runtime_error if samples in between are lost.
  bool is_new(NodeId sender, std::uint64_t number) {
    std::uint64_t& next = next_[index_of(sender)];
    if (number > next)
      throw std::runtime_error(
          fmt::format("exchange: control samples {} to {} of {} are lost", next, number - 1, index_of(sender)));
    if (number < next) return false;
    ++next;
    return true;
  }

 private:
  std::array<std::uint64_t, 256> next_{};
};

}  // namespace ttf::bus::dds::exchange
