#include "cli/launch/external/in_order.h"

#include <cstdint>
#include <limits>

namespace ttf::cli::launch::external {

void InOrder::add(const bus::ports::ReceivedFrame& received) {
  if (received.line >= newest_.size())
    newest_.resize(received.line + 1, bus::ports::MachineTime{std::numeric_limits<std::int64_t>::min()});
  bus::ports::MachineTime& newest = newest_[received.line];
  newest = std::max(newest, received.at);
  const auto bytes = received.form == bus::ports::ReceivedFrame::Form::kCan ? received.can.data : received.bytes;
  Kept& kept = kept_.emplace_back(Kept{newest, received, bytes_.size(), bytes.size()});
  kept.received.bytes = kept.received.can.data = {};  // no longer valid then
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void InOrder::clear() {
  kept_.clear();
  bytes_.clear();
  newest_.clear();
}

}  // namespace ttf::cli::launch::external
