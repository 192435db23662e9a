#include "bus/dds/exchange/heard.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace ttf::bus::dds::exchange {
namespace {

constexpr std::size_t kCountOctets = 8;

}  // namespace

std::vector<std::byte> encode(const HeardCounts& heard) {
  std::vector<std::byte> bytes;
  for (const auto& [node, count] : heard) {
    bytes.push_back(static_cast<std::byte>(node));
    for (std::size_t i = 0; i < kCountOctets; ++i) bytes.push_back(static_cast<std::byte>(count >> (8 * i)));
  }
  return bytes;
}

HeardCounts decode(std::span<const std::byte> bytes) {
  if (bytes.size() % (1 + kCountOctets) != 0)
    throw std::runtime_error("exchange: a report of heard samples is cut off");
  HeardCounts heard;
  for (; !bytes.empty(); bytes = bytes.subspan(1 + kCountOctets)) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < kCountOctets; ++i) count |= static_cast<std::uint64_t>(bytes[1 + i]) << (8 * i);
    if (!heard.try_emplace(static_cast<NodeId>(bytes[0]), count).second)
      throw std::runtime_error("exchange: a report of heard samples names a node twice");
  }
  return heard;
}

HeardTable::HeardTable(const std::vector<NodeId>& others) {
  for (const NodeId other : others) heard_by_[other];
}

void HeardTable::note(NodeId by, HeardCounts heard) {
  if (const auto entry = heard_by_.find(by); entry != heard_by_.end()) entry->second = std::move(heard);
}

void HeardTable::without(NodeId gone) { heard_by_.erase(gone); }

std::uint64_t HeardTable::by_all(NodeId sender) const {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [by, heard] : heard_by_) {
    if (by == sender) continue;
    const auto count = heard.find(sender);
    least = std::min(least, count == heard.end() ? 0 : count->second);
  }
  return least;
}

}  // namespace ttf::bus::dds::exchange
