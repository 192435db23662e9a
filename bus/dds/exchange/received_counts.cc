#include "bus/dds/exchange/received_counts.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace ttf::bus::dds::exchange {
namespace {

constexpr std::size_t kCountOctets = 8;

}  // namespace

std::vector<std::byte> encode(const ReceivedCounts& received) {
  std::vector<std::byte> bytes;
  for (const auto& [node, count] : received) {
    bytes.push_back(static_cast<std::byte>(node));
    for (std::size_t i = 0; i < kCountOctets; ++i) bytes.push_back(static_cast<std::byte>(count >> (8 * i)));
  }
  return bytes;
}

ReceivedCounts decode(std::span<const std::byte> bytes) {
  if (bytes.size() % (1 + kCountOctets) != 0)
    throw std::runtime_error("exchange: a report of heard samples is cut off");
  ReceivedCounts received;
  for (; !bytes.empty(); bytes = bytes.subspan(1 + kCountOctets)) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < kCountOctets; ++i) count |= static_cast<std::uint64_t>(bytes[1 + i]) << (8 * i);
    if (!received.try_emplace(static_cast<NodeId>(bytes[0]), count).second)
      throw std::runtime_error("exchange: a report of heard samples names a node twice");
  }
  return received;
}

ReceivedTable::ReceivedTable(const std::vector<NodeId>& others) {
  for (const NodeId other : others) received_by_[other];
}

void ReceivedTable::note(NodeId by, ReceivedCounts received) {
  if (const auto entry = received_by_.find(by); entry != received_by_.end()) entry->second = std::move(received);
}

void ReceivedTable::without(NodeId gone) { received_by_.erase(gone); }

std::uint64_t ReceivedTable::by_all(NodeId sender) const {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [by, received] : received_by_) {
    if (by == sender) continue;
    const auto count = received.find(sender);
    least = std::min(least, count == received.end() ? 0 : count->second);
  }
  return least;
}

}  // namespace ttf::bus::dds::exchange
