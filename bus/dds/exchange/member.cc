#include "bus/dds/exchange/member.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/check.h"

namespace ttf::bus::dds::exchange {
namespace {

// The most that is kept of one member's samples if others do not confirm them. Two survivors are never further
// apart than a writer's unacknowledged bytes (kMaxUnacknowledgedBytes), and that many small samples take about
// twice as much.
constexpr std::size_t kRetainBytes = 32 << 20;
// The wait for acknowledgements while a member is dead, which will send none.
constexpr std::chrono::milliseconds kPatienceAfterDeath{500};

std::string node(NodeId id) {
  return id == common::kSupervisor ? "the supervisor" : fmt::format("node {}", index_of(id));
}

std::vector<NodeId> without(std::vector<NodeId> members, NodeId self) {
  members.erase(std::remove(members.begin(), members.end(), self), members.end());
  return members;
}

}  // namespace

Exchange::Member::Member(const common::Session& session, NodeId self)
    : session_(validate(session)), self_(self), participant_(session.domain, session.lease),
      data_(participant_, common::kDataTopic, session.name),
      control_(participant_, common::kControlTopic, session.name), waiter_(participant_, data_, &control_),
      received_table_(without(session.members, self)) {
  for (const NodeId id : session.members)
    if (id != self) others_.try_emplace(id, Stream(id, session.supervised ? kRetainBytes : 0));
  TTF_CHECK(others_.size() + 1 == session.members.size(), "node {} is not a member", index_of(self));
  say(data_, common::Kind::kHello);
  say(control_, common::Kind::kHello);
}

// Returns whether all others, except those gone meanwhile, are in `said`.
bool Exchange::Member::everybody(const std::set<NodeId>& said) const {
  return std::all_of(others_.begin(), others_.end(),
                     [&](const auto& entry) { return said.contains(entry.first) || gone_.contains(entry.first); });
}

void Exchange::Member::wait_ready(std::chrono::milliseconds patience) {
  const Clock::time_point deadline = Clock::now() + patience;
  bool said = false;
  while (!all_ready_) {
    if (take()) continue;
    if (cut_off_) throw std::runtime_error("exchange: " + node(self_) + " has been removed by the supervisor");
    const bool supervisor_received = !session_.supervised || control_hello_.contains(common::kSupervisor);
    if (!said && supervisor_received && everybody(data_hello_) && everybody(control_hello_)) {
      say(control_, common::Kind::kReady);
      said = true;
    }
    all_ready_ = said && everybody(ready_) && (!session_.supervised || ready_.contains(common::kSupervisor));
    if (all_ready_) return;
    if (Clock::now() >= deadline) give_up(patience);
    note_lost();  // a lost member does not matter yet
    wait(deadline);
  }
}

void Exchange::Member::give_up(std::chrono::milliseconds waited) const {
  std::vector<NodeId> expected;
  for (const auto& entry : others_)
    if (!gone_.contains(entry.first)) expected.push_back(entry.first);
  if (session_.supervised) expected.push_back(common::kSupervisor);
  std::vector<NodeId> absent, deaf;
  for (const NodeId id : expected) {
    if (!control_hello_.contains(id) || (id != common::kSupervisor && !data_hello_.contains(id)))
      absent.push_back(id);
    else if (!ready_.contains(id))
      deaf.push_back(id);
  }
  if (!absent.empty()) deaf.clear();  // deafness follows from absence
  throw common::NotReady(session_, waited, std::move(absent), std::move(deaf));
}

void Exchange::Member::send(std::span<const std::byte> message) {
  TTF_CHECK(all_ready_ && !left_, "node {} sends before wait_ready() or after leave()", index_of(self_));
  data_.say({.sender = self_, .kind = common::Kind::kMessage, .bytes = message});
}

ports::Exchange::Received Exchange::Member::receive() {
  for (;;) {
    if (cut_off_) throw std::runtime_error("exchange: " + node(self_) + " has been removed by the supervisor");
    if (!coming_.empty()) {
      const Coming next = std::move(coming_.front());
      coming_.pop_front();
      current_ = next.bytes;
      if (current_ == nullptr) return {next.from, true, {}};
      return {next.from, false, *current_};
    }
    if (take()) continue;
    const auto until = look_around();
    wait(until);
  }
}

std::optional<Exchange::Member::Clock::time_point> Exchange::Member::look_around() {
  if (nobody_left()) throw std::runtime_error("exchange: " + node(self_) + ": all other members are gone");
  if (supervisor_left_) throw std::runtime_error("exchange: the supervisor has left");
  note_lost();
  std::optional<Clock::time_point> until;
  for (const auto& [id, limit] : lost_) {
    if (gone_.contains(id)) continue;
    if (Clock::now() >= limit)
      throw std::runtime_error(fmt::format("exchange: DDS has lost contact with {}", node(id)));
    until = std::min(until.value_or(limit), limit);
  }
  return until;
}

void Exchange::Member::note_lost() {
  const bool data_changed = data_.connections_changed();
  if (!control_.connections_changed() && !data_changed) return;
  const auto note = [&](NodeId id) {
    if (control_.lost(id))
      lost_.try_emplace(id, Clock::now() + session_.lease);
    else
      lost_.erase(id);
  };
  if (session_.supervised) return note(common::kSupervisor);  // it alone has the list of others that are gone
  for (const auto& entry : others_) note(entry.first);
}

void Exchange::Member::wait(std::optional<Clock::time_point> until) {
  waiter_.wait(until ? std::optional<std::chrono::nanoseconds>(*until - Clock::now()) : std::nullopt);
}

void Exchange::Member::leave() {
  if (std::exchange(left_, true)) return;
  say(data_, common::Kind::kBye);
  say(control_, common::Kind::kBye);
  const bool somebody_died = last_death_ != Clock::time_point{} && Clock::now() - last_death_ < 2 * session_.lease;
  const std::chrono::milliseconds patience = somebody_died ? kPatienceAfterDeath : session_.lease;
  if (data_.acknowledged_within(patience)) control_.acknowledged_within(patience);
}

}  // namespace ttf::bus::dds::exchange
