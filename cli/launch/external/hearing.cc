#include "cli/launch/external/hearing.h"

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
schedules::model::Channels heard_channels(const node_set::NodeSet& set) {
  using schedules::model::Channels;
  return set.bus.medium->has_interfaces() && set.bus.interfaces.size() == 1 ? Channels::kA : Channels::kAB;
}

}  // namespace

Hearing::Hearing(const node_set::NodeSet& set, std::vector<NodeId> nodes)
    : set_(set), nodes_(std::move(nodes)), judge_(set.cluster, nodes_, set.time_scale_ppm, heard_channels(set)) {
  const bus::ports::HeardIdentifiers identifiers = judge_.identifiers();
  listener_ = set.bus.medium->listen({set.cluster, set.bus.interfaces, set.can_interfaces, set.session, identifiers});
}

void Hearing::begin(bus::ports::MachineTime origin) {
  origin_ = origin;
  if (set_.scenario.startup.cold) return;  // the cluster's first cycle begins when it will
  const nodes::runner::DriveClock clock(origin, set_.time_scale_ppm);
  judge_.begin(clock.machine_time(sim::engine::kFirstCycle));
}

void Hearing::take_in() {
  while (const auto heard = listener_->hear()) in_order_.add(*heard);
  in_order_.hand_over([&](const bus::ports::Heard& heard) { judge_.hear(heard); });
}

std::optional<Account> Hearing::account(NodeId node, bus::ports::MachineTime now) const {
  const auto found = std::ranges::find(nodes_, node);
  if (found == nodes_.end()) return std::nullopt;
  const auto number = static_cast<std::size_t>(found - nodes_.begin());
  Account account{set_.cluster.node(node).name, judge_.counts(number), {}, {}, judge_.never_heard(number)};
  if (!account.counts.first) return account;
  if (origin_) account.first = *account.counts.first - *origin_;
  // Behind the end of the drive all are silent: the other nodes' last frame says how far it went.
  const Duration since = std::min(now, judge_.cluster_heard().value_or(now)) - *account.counts.last;
  if (since > judge_.longest_silence(number)) account.silent = since;
  return account;
}

supervision::ExternalHealth Hearing::health(NodeId node, bus::ports::MachineTime now) const {
  supervision::ExternalHealth health;
  const auto found = account(node, now);
  if (!found) return health;
  health.heard = found->counts.first.has_value();
  health.sending = health.heard && !found->silent;
  health.words = status_text(*found);
  if (health.heard) health.missing = found->counts.missing;
  return health;
}

std::vector<Account> Hearing::accounts(bus::ports::MachineTime now) const {
  std::vector<Account> all;
  for (const NodeId node : nodes_) all.push_back(*account(node, now));
  return all;
}

std::vector<std::string> Hearing::warnings() const {
  std::vector<std::string> sentences;
  if (!listener_->failure().empty()) sentences.push_back(listener_->failure());
  if (listener_->lost() > 0)
    sentences.push_back(fmt::format("the launch did not hear {} of real nodes and their cluster: its buffer was full",
                                    counted(listener_->lost(), "frame")));
  return sentences;
}

}  // namespace ttf::cli::launch::external
