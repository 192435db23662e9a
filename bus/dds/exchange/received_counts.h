// Counts of samples received, by member. Samples that all members have received need not be kept for repetition.
//
// On the wire (Kind::kReceived) nine octets per node: its number, and the count of its samples received, least octet first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ttf::bus::dds::exchange {

using ReceivedCounts = std::map<NodeId, std::uint64_t>;  // samples received, by their sender

std::vector<std::byte> encode(const ReceivedCounts& received);
// Throws std::runtime_error on bytes that encode() does not make.
ReceivedCounts decode(std::span<const std::byte> bytes);

// The others' counts, as one member has them.
class ReceivedTable {
 public:
  // `others`: all members except this one.
  explicit ReceivedTable(const std::vector<NodeId>& others);

  void note(NodeId by, ReceivedCounts received);  // counts never fall; a sender that `by` does not mention has count 0
  void without(NodeId gone);                      // drops a member that needs no repetition any more
  // Returns the number of samples of `sender` that all other remaining members have received.
  std::uint64_t by_all(NodeId sender) const;

 private:
  std::map<NodeId, ReceivedCounts> received_by_;
};

}  // namespace ttf::bus::dds::exchange
