#include "cli/launch/external/listening.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/live_media/live_media.h"
#include "core/counted.h"
#include "nodes/runner/drive_clock.h"
#include "sim/engine/cluster_simulation.h"

namespace ttf::cli::launch::external {
namespace {

// One interface is that of channel A.
schedules::model::Channels received_channels(const node_set::NodeSet& set) {
  using schedules::model::Channels;
  return set.bus.medium->has_interfaces() && set.bus.interfaces.size() == 1 ? Channels::kA : Channels::kAB;
}

}  // namespace

Listening::Listening(const node_set::NodeSet& set, std::vector<NodeId> nodes)
    : set_(set), nodes_(std::move(nodes)), judge_(set.cluster, nodes_, set.time_scale_ppm, received_channels(set)) {
  const bus::ports::ReceivedIdentifiers identifiers = judge_.identifiers();
  listener_ = set.bus.medium->listen({set.cluster, set.bus.interfaces, set.can_interfaces, set.session, identifiers});
}

void Listening::begin(bus::ports::MachineTime origin) {
  origin_ = origin;
  if (set_.scenario.startup.cold) return;  // the cluster's first cycle begins when it will
  const nodes::runner::DriveClock clock(origin, set_.time_scale_ppm);
  judge_.begin(clock.machine_time(sim::engine::kFirstCycle));
}

void Listening::take_in() {
  while (const auto received = listener_->receive()) in_order_.add(*received);
  in_order_.hand_over([&](const bus::ports::ReceivedFrame& received) { judge_.receive(received); });
}

std::optional<Account> Listening::account(NodeId node, bus::ports::MachineTime now) const {
  const auto found = std::ranges::find(nodes_, node);
  if (found == nodes_.end()) return std::nullopt;
  const auto number = static_cast<std::size_t>(found - nodes_.begin());
  Account account{set_.cluster.node(node).name, judge_.counts(number), {}, {}, judge_.never_received(number)};
  if (!account.counts.first) return account;
  if (origin_) account.first = *account.counts.first - *origin_;
  // Behind the end of the drive all are silent: the other nodes' last frame says how far it went.
  const Duration since = std::min(now, judge_.cluster_received().value_or(now)) - *account.counts.last;
  if (since > judge_.longest_silence(number)) account.silent = since;
  return account;
}

supervision::ExternalHealth Listening::health(NodeId node, bus::ports::MachineTime now) const {
  supervision::ExternalHealth health;
  const auto found = account(node, now);
  if (!found) return health;
  health.received = found->counts.first.has_value();
  health.sending = health.received && !found->silent;
  health.words = status_text(*found);
  if (health.received) health.missing = found->counts.missing;
  return health;
}

std::vector<Account> Listening::accounts(bus::ports::MachineTime now) const {
  std::vector<Account> all;
  for (const NodeId node : nodes_) all.push_back(*account(node, now));
  return all;
}

std::vector<std::string> Listening::warnings() const {
  std::vector<std::string> sentences;
  if (!listener_->failure().empty()) sentences.push_back(listener_->failure());
  if (listener_->lost() > 0)
    sentences.push_back(fmt::format("the launch did not hear {} of real nodes and their cluster: its buffer was full",
                                    counted(listener_->lost(), "frame")));
  return sentences;
}

}  // namespace ttf::cli::launch::external
