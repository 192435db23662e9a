#include "bus/dds/exchange/exchange_supervisor.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/said.h"
#include "bus/dds/exchange/channel.h"
#include "bus/dds/exchange/end_agreement.h"
#include "bus/dds/exchange/numbering.h"
#include "bus/dds/exchange/waiter.h"
#include "core/check.h"

namespace ttf::bus::dds::exchange {
namespace {

const common::Session& supervised(const common::Session& session) {
  validate(session);
  TTF_CHECK(session.supervised, "the session has no supervisor");
  return session;
}

}  // namespace

class ExchangeSupervisor::Watch {
 public:
  explicit Watch(const common::Session& session)
      : session_(supervised(session)), participant_(session.domain, session.lease),
        control_(participant_, common::kControlTopic, session.name), waiter_(participant_, control_, nullptr),
        members_(session.members.begin(), session.members.end()), thread_([this] { run(); }) {}
  ~Watch();

  void wait_ready(std::chrono::milliseconds patience);
  void announce_gone(NodeId node);
  std::optional<Event> next_event(std::chrono::milliseconds patience);

 private:
  // All below except the last three belong to the thread.
  void run();
  void work();
  bool everybody_has_come() const;
  void on_control(const common::Said& said);
  void begin_agreement(NodeId node);
  void give(NodeId about, const std::optional<EndAgreement::Order>& order);
  void without(NodeId node);
  void finish_agreements();
  void look_for_lost();
  void report(What what, NodeId node, std::uint64_t samples = 0);

  const common::Session session_;
  common::Participant participant_;
  Channel control_;
  Waiter waiter_;
  const std::set<NodeId> members_;

  // The thread's data.
  Numbering numbers_;
  std::set<NodeId> hello_, left_, dead_, lost_;
  std::map<NodeId, EndAgreement> agreements_;  // dead members that some survivors have not found to be gone

  std::mutex mutex_;
  std::condition_variable happened_;
  std::deque<Event> events_;  // guarded by mutex_, as all below
  std::deque<NodeId> announcements_;
  std::set<NodeId> joined_, ready_, gone_;  // for wait_ready()
  bool stop_ = false;
  std::exception_ptr failure_;

  std::thread thread_;  // last, because it uses all of the above
};

ExchangeSupervisor::Watch::~Watch() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  try {
    waiter_.call();
  } catch (const std::exception&) {
    // DDS is lost, which the thread has noticed, too.
  }
  thread_.join();
}

void ExchangeSupervisor::Watch::run() {
  try {
    work();
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failure_ = std::current_exception();
    happened_.notify_all();
  }
}

void ExchangeSupervisor::Watch::work() {
  control_.say({.sender = common::kSupervisor, .kind = common::Kind::kHello});
  bool ready = false;
  for (;;) {
    while (control_.take([this](const common::Said& said) { on_control(said); })) {
    }
    std::deque<NodeId> announcements;
    {
      const std::scoped_lock lock(mutex_);
      if (stop_) break;
      announcements.swap(announcements_);
    }
    for (const NodeId node : announcements) begin_agreement(node);
    finish_agreements();
    if (!ready && everybody_has_come()) {
      control_.say({.sender = common::kSupervisor, .kind = common::Kind::kReady});
      ready = true;
    }
    if (control_.connections_changed()) look_for_lost();
    waiter_.wait({});
  }
  control_.say({.sender = common::kSupervisor, .kind = common::Kind::kBye});
  control_.acknowledged_within(std::chrono::milliseconds(dead_.empty() ? 2000 : 500));
}

// A member that has gone meanwhile counts, too.
bool ExchangeSupervisor::Watch::everybody_has_come() const {
  return std::all_of(members_.begin(), members_.end(),
                     [this](NodeId member) { return hello_.contains(member) || dead_.contains(member); });
}

void ExchangeSupervisor::Watch::on_control(const common::Said& said) {
  const NodeId node = said.sender;
  if (!members_.contains(node))
    throw std::runtime_error(fmt::format("session {} on DDS domain {}: {}", session_.name, session_.domain,
                                         node == common::kSupervisor
                                             ? "there is a second supervisor"
                                             : fmt::format("node {} is not a member", index_of(node))));
  if (dead_.contains(node) || !numbers_.is_new(node, said.number)) return;
  switch (said.kind) {
    case common::Kind::kHello:
      hello_.insert(node);
      report(What::kJoined, node);
      return;
    case common::Kind::kReady: report(What::kReady, node); return;
    case common::Kind::kBye:
      left_.insert(node);
      without(node);
      report(What::kLeft, node);
      return;
    case common::Kind::kReport:
      if (const auto agreement = agreements_.find(said.about); agreement != agreements_.end())
        give(said.about, agreement->second.report(node, said.round, said.end));
      return;
    case common::Kind::kClosed:
      if (const auto agreement = agreements_.find(said.about); agreement != agreements_.end())
        agreement->second.closed(node, said.round);
      return;
    case common::Kind::kAgain:
    case common::Kind::kAllAgain:
    case common::Kind::kReceived: return;  // for the members
    case common::Kind::kFence:
    case common::Kind::kClose:
    case common::Kind::kMessage:
      throw std::runtime_error(
          fmt::format("exchange: node {} sent a sample that members may not send", index_of(node)));
  }
}

void ExchangeSupervisor::Watch::begin_agreement(NodeId node) {
  if (!dead_.insert(node).second) return;
  without(node);
  std::set<NodeId> survivors;
  for (const NodeId member : members_)
    if (!dead_.contains(member) && !left_.contains(member)) survivors.insert(member);
  auto& agreement = agreements_.try_emplace(node, std::move(survivors)).first->second;
  give(node, agreement.begin());
}

void ExchangeSupervisor::Watch::give(NodeId about, const std::optional<EndAgreement::Order>& order) {
  if (order)
    control_.say({.sender = common::kSupervisor,
                  .kind = order->kind,
                  .about = about,
                  .holder = order->holder,
                  .round = order->round,
                  .first = order->first,
                  .end = order->end});
}

void ExchangeSupervisor::Watch::without(NodeId node) {
  for (auto& [about, agreement] : agreements_) give(about, agreement.without(node));
}

void ExchangeSupervisor::Watch::finish_agreements() {
  for (auto entry = agreements_.begin(); entry != agreements_.end();) {
    if (!entry->second.done()) {
      ++entry;
      continue;
    }
    report(What::kGone, entry->first, entry->second.end());
    entry = agreements_.erase(entry);
  }
}

void ExchangeSupervisor::Watch::look_for_lost() {
  for (const NodeId node : hello_) {
    if (dead_.contains(node) || left_.contains(node)) continue;
    if (control_.lost(node)) {
      if (lost_.insert(node).second) report(What::kLost, node);
    } else if (lost_.erase(node) > 0) {
      report(What::kBack, node);
    }
  }
}

void ExchangeSupervisor::Watch::report(What what, NodeId node, std::uint64_t samples) {
  const std::scoped_lock lock(mutex_);
  if (what == What::kJoined) joined_.insert(node);
  if (what == What::kReady) ready_.insert(node);
  if (what == What::kGone || what == What::kLeft) gone_.insert(node);
  events_.push_back({what, node, samples});
  happened_.notify_all();
}

void ExchangeSupervisor::Watch::wait_ready(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  const auto ready = [this] {
    return std::all_of(members_.begin(), members_.end(),
                       [this](NodeId member) { return ready_.contains(member) || gone_.contains(member); });
  };
  const bool settled = happened_.wait_for(lock, patience, [&] { return failure_ || ready(); });
  if (failure_) std::rethrow_exception(failure_);
  if (settled) return;
  std::vector<NodeId> absent, deaf;
  for (const NodeId member : members_) {
    if (gone_.contains(member)) continue;
    if (!joined_.contains(member))
      absent.push_back(member);
    else if (!ready_.contains(member))
      deaf.push_back(member);
  }
  if (!absent.empty()) deaf.clear();  // deafness follows from absence
  throw common::NotReady(session_, patience, std::move(absent), std::move(deaf));
}

void ExchangeSupervisor::Watch::announce_gone(NodeId node) {
  TTF_CHECK(members_.contains(node), "node {} is not a member", index_of(node));
  {
    const std::scoped_lock lock(mutex_);
    announcements_.push_back(node);
  }
  waiter_.call();
}

std::optional<ExchangeSupervisor::Event> ExchangeSupervisor::Watch::next_event(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  happened_.wait_for(lock, patience, [this] { return failure_ || !events_.empty(); });
  if (!events_.empty()) {
    const Event event = events_.front();
    events_.pop_front();
    return event;
  }
  if (failure_) std::rethrow_exception(failure_);
  return {};
}

ExchangeSupervisor::ExchangeSupervisor(const common::Session& session) : watch_(std::make_unique<Watch>(session)) {}
ExchangeSupervisor::~ExchangeSupervisor() = default;
void ExchangeSupervisor::wait_ready(std::chrono::milliseconds patience) { watch_->wait_ready(patience); }
void ExchangeSupervisor::announce_gone(NodeId node) { watch_->announce_gone(node); }
std::optional<ExchangeSupervisor::Event> ExchangeSupervisor::next_event(std::chrono::milliseconds patience) {
  return watch_->next_event(patience);
}

}  // namespace ttf::bus::dds::exchange
