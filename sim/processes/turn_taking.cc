#include "sim/processes/turn_taking.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "core/check.h"

namespace ttf::sim::processes {

TurnTaking::TurnTaking(const schedules::model::Cluster& cluster, NodeId self, bus::ports::Exchange& exchange)
    : cluster_(cluster), self_(self), exchange_(exchange), members_(cluster.nodes.size()) {}

void TurnTaking::speak(Microticks now, const nodes::host::Promise& promise) {
  Member& own = members_[index_of(self_)];
  exchange_.send(own_.finish({self_, own.turns, now, promise}));
  own_.clear();
  ++own.turns;
  own.outlook.promises(promise);
}

std::optional<std::span<const Act>> TurnTaking::listen(NodeId node, Microticks now) {
  TTF_CHECK(node != self_, "{} listens to itself", cluster_.node(node).name);
  Member& member = members_[index_of(node)];
  while (member.unread.empty() && !member.gone) receive();
  if (member.unread.empty()) return std::nullopt;
  std::swap(received_, member.unread.front());
  spare_.push_back(std::move(member.unread.front()));
  member.unread.pop_front();
  const TurnHeader turn = read_turn(cluster_, received_, acts_);
  if (turn.node != node || turn.number != member.turns || turn.at != now)
    throw std::runtime_error(fmt::format("turn {} of {} at {} uT, where turn {} of {} at {} uT was due", turn.number,
                                         cluster_.node(turn.node).name, turn.at.value, member.turns,
                                         cluster_.node(node).name, now.value));
  ++member.turns;
  member.outlook.promises(turn.promise);
  return acts_;
}

void TurnTaking::receive() {
  const bus::ports::Exchange::Received received = exchange_.receive();
  if (index_of(received.from) >= members_.size() || received.from == self_)
    throw std::runtime_error(
        fmt::format("a message from node {}, which is no other node of the cluster", index_of(received.from)));
  Member& member = members_[index_of(received.from)];
  if (received.gone) {
    member.gone = true;
    return;
  }
  std::vector<std::byte> room;
  if (!spare_.empty()) {
    room = std::move(spare_.back());
    spare_.pop_back();
  }
  room.assign(received.bytes.begin(), received.bytes.end());
  member.unread.push_back(std::move(room));
}

}  // namespace ttf::sim::processes
