// How the survivors of a member come to have heard the same of it: the supervisor's part of bus/dds/exchange/stream.h.
// Pure: reports in, orders to everybody out.
//
// A round is kFence, a report from every survivor, kClose at the best report. Whoever holds the most says again
// what others lack. Should that one go before all have got it, another round begins; its end may be earlier, but
// never before what a survivor has heard, because fenced streams do not go on and survivors report all that they
// heard.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "bus/dds/common/said.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class Departure {
 public:
  struct Order {
    common::Kind kind{};  // kFence or kClose
    std::uint32_t round = 0;
    NodeId holder = kNoNode;  // of kClose: who says again samples [first, end); kNoNode: nobody lacks any
    std::uint64_t first = 0;
    std::uint64_t end = 0;
  };

  explicit Departure(std::set<NodeId> survivors) : survivors_(std::move(survivors)) {}

  // Each returns what is to be said to everybody now, if anything. What belongs to a round that is over changes
  // nothing.
  Order begin();
  std::optional<Order> report(NodeId survivor, std::uint32_t round, std::uint64_t end);
  void closed(NodeId survivor, std::uint32_t round);
  std::optional<Order> without(NodeId survivor);  // it has gone, too, or left

  // Every survivor has heard all of it.
  bool done() const { return closing_ && closed_.size() == survivors_.size(); }
  // The number of samples that survivors have heard of it. Precondition: done().
  std::uint64_t end() const { return end_; }

 private:
  std::optional<Order> decide();

  std::set<NodeId> survivors_;
  std::uint32_t round_ = 0;
  bool closing_ = false;
  std::map<NodeId, std::uint64_t> reports_;  // of this round
  std::set<NodeId> closed_;                  // in this round
  NodeId holder_ = kNoNode;
  std::uint64_t end_ = 0;
};

}  // namespace ttf::bus::dds::exchange
