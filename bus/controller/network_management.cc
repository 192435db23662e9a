#include "bus/controller/network_management.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::bus::controller {

NetworkManagement::NetworkManagement(int length) : length_(static_cast<std::size_t>(length)) {
  TTF_CHECK(length >= 0 && length_ <= kMaxNetworkManagementBytes, "a network management vector of {} bytes", length);
}

void NetworkManagement::reset() { running_ = shown_ = {}; }

void NetworkManagement::set_own(std::span<const std::byte> vector) {
  TTF_CHECK(vector.size() == length_, "{} bytes for a network management vector of {}", vector.size(), length_);
  std::copy(vector.begin(), vector.end(), own_.begin());
}

void NetworkManagement::combine(std::span<const std::byte> payload) {
  const std::size_t bytes = std::min(length_, payload.size());
  for (std::size_t i = 0; i < bytes; ++i) running_[i] |= payload[i];
}

void NetworkManagement::end_cycle(bool in_normal_operation) {
  if (in_normal_operation) shown_ = running_;
  running_ = {};
}

}  // namespace ttf::bus::controller
