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
  while (member.unheard.empty() && !member.gone) receive();
  if (member.unheard.empty()) return std::nullopt;
  std::swap(heard_, member.unheard.front());
  spare_.push_back(std::move(member.unheard.front()));
  member.unheard.pop_front();
  const TurnHeader turn = read_turn(cluster_, heard_, acts_);
  if (turn.node != node || turn.number != member.turns || turn.at != now)
    throw std::runtime_error(fmt::format("turn {} of {} at {} uT, where turn {} of {} at {} uT was due", turn.number,
                                         cluster_.node(turn.node).name, turn.at.value, member.turns,
                                         cluster_.node(node).name, now.value));
  ++member.turns;
  member.outlook.promises(turn.promise);
  return acts_;
}

void TurnTaking::receive() {
  const bus::ports::Exchange::Heard heard = exchange_.receive();
  if (index_of(heard.from) >= members_.size() || heard.from == self_)
    throw std::runtime_error(
        fmt::format("a message from node {}, which is no other node of the cluster", index_of(heard.from)));
  Member& member = members_[index_of(heard.from)];
  if (heard.gone) {
    member.gone = true;
    return;
  }
  std::vector<std::byte> room;
  if (!spare_.empty()) {
    room = std::move(spare_.back());
    spare_.pop_back();
  }
  room.assign(heard.bytes.begin(), heard.bytes.end());
  member.unheard.push_back(std::move(room));
}

}  // namespace ttf::sim::processes
