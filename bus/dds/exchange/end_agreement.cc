#include "bus/dds/exchange/end_agreement.h"

#include <algorithm>

namespace ttf::bus::dds::exchange {

EndAgreement::Order EndAgreement::begin() {
  ++round_;
  reports_.clear();
  closed_.clear();
  holder_ = kNoNode;
  closing_ = survivors_.empty();  // without survivors there is nothing to agree on
  return {common::Kind::kFence, round_};
}

std::optional<EndAgreement::Order> EndAgreement::report(NodeId survivor, std::uint32_t round, std::uint64_t end) {
  if (closing_ || round != round_ || !survivors_.contains(survivor)) return {};
  reports_[survivor] = end;
  return decide();
}

void EndAgreement::closed(NodeId survivor, std::uint32_t round) {
  if (closing_ && round == round_ && survivors_.contains(survivor)) closed_.insert(survivor);
}

std::optional<EndAgreement::Order> EndAgreement::without(NodeId survivor) {
  if (survivors_.erase(survivor) == 0) return {};
  reports_.erase(survivor);
  closed_.erase(survivor);
  if (survivors_.empty()) {
    closing_ = true;
    return {};
  }
  if (!closing_) return decide();
  if (survivor == holder_ && !done()) return begin();
  return {};
}

std::optional<EndAgreement::Order> EndAgreement::decide() {
  if (reports_.size() < survivors_.size()) return {};
  const auto by_end = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [least, most] = std::minmax_element(reports_.begin(), reports_.end(), by_end);
  closing_ = true;
  end_ = most->second;
  if (least->second < end_) holder_ = most->first;
  return Order{common::Kind::kClose, round_, holder_, least->second, end_};
}

}  // namespace ttf::bus::dds::exchange
