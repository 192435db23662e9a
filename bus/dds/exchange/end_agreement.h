// The supervisor's part of bus/dds/exchange/stream.h: brings all survivors of a member to have received the same
// of it. Pure: reports in, orders to all members out.
//
// A round is kFence, a report from every survivor, and kClose at the best report. The survivor that holds the
// most repeats the samples that others lack. If it goes before all have them, another round begins. The end of
// that round may be earlier, but never before a sample that a survivor has received. Fenced streams do not go on,
// and survivors report all samples they received.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "bus/dds/common/said.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class EndAgreement {
 public:
  struct Order {
    common::Kind kind{};  // kFence or kClose
    std::uint32_t round = 0;
    NodeId holder = kNoNode;  // in kClose: repeats samples [first, end); kNoNode: no survivor lacks any
    std::uint64_t first = 0;
    std::uint64_t end = 0;
  };

  explicit EndAgreement(std::set<NodeId> survivors) : survivors_(std::move(survivors)) {}

  // Each returns the order to send to all members now, if any. Events of an earlier round have no effect.
  Order begin();
  std::optional<Order> report(NodeId survivor, std::uint32_t round, std::uint64_t end);
  void closed(NodeId survivor, std::uint32_t round);
  std::optional<Order> without(NodeId survivor);  // the survivor has gone, too, or left

  // Returns whether every survivor has received all of its samples.
  bool done() const { return closing_ && closed_.size() == survivors_.size(); }
  // Returns the number of its samples that survivors have received. Precondition: done().
  std::uint64_t end() const { return end_; }

 private:
  std::optional<Order> decide();

  std::set<NodeId> survivors_;
  std::uint32_t round_ = 0;
  bool closing_ = false;
  std::map<NodeId, std::uint64_t> reports_;  // this round's
  std::set<NodeId> closed_;                  // in this round
  NodeId holder_ = kNoNode;
  std::uint64_t end_ = 0;
};

}  // namespace ttf::bus::dds::exchange
