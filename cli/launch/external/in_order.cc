#include "cli/launch/external/in_order.h"

#include <cstdint>
#include <limits>

namespace ttf::cli::launch::external {

void InOrder::add(const bus::ports::Heard& heard) {
  if (heard.line >= newest_.size())
    newest_.resize(heard.line + 1, bus::ports::MachineTime{std::numeric_limits<std::int64_t>::min()});
  bus::ports::MachineTime& newest = newest_[heard.line];
  newest = std::max(newest, heard.at);
  const auto bytes = heard.form == bus::ports::Heard::Form::kCan ? heard.can.data : heard.bytes;
  Kept& kept = kept_.emplace_back(Kept{newest, heard, bytes_.size(), bytes.size()});
  kept.heard.bytes = kept.heard.can.data = {};  // no longer valid then
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void InOrder::clear() {
  kept_.clear();
  bytes_.clear();
  newest_.clear();
}

}  // namespace ttf::cli::launch::external
