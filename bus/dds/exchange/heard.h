// Who has heard how much of whom: what everybody has heard need not be kept to be said again.
//
// On the wire (Kind::kHeard) nine octets per node: its number, and how many of its samples were heard, least octet
// first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ttf::bus::dds::exchange {

using HeardCounts = std::map<NodeId, std::uint64_t>;  // samples heard, by their sender

std::vector<std::byte> encode(const HeardCounts& heard);
// Throws std::runtime_error on what encode() does not make.
HeardCounts decode(std::span<const std::byte> bytes);

// As one member knows it of the others.
class HeardTable {
 public:
  // `others`: all members but oneself.
  explicit HeardTable(const std::vector<NodeId>& others);

  void note(NodeId by, HeardCounts heard);  // it never grows less; what `by` does not mention it has not heard
  void without(NodeId gone);                // it will not need to be told anything again
  // How many samples of `sender` every other that is still there has heard.
  std::uint64_t by_all(NodeId sender) const;

 private:
  std::map<NodeId, HeardCounts> heard_by_;
};

}  // namespace ttf::bus::dds::exchange
