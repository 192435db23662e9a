#include "schedules/file/shortest_periods.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/int128.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"

namespace ttf::schedules::file {
namespace {

constexpr Duration kGrain = Duration::microseconds(10);
constexpr Duration kNever = Duration::milliseconds(10'000);

// Returns the shortest true time between two lists of a message, as the tasks of its sender write them.
std::optional<Duration> between_lists(const model::Cluster& cluster, std::size_t can,
                                      const model::CanMessage& message) {
  const model::Node& sender = cluster.node(message.sender);
  const auto responses = analysis::worst_responses(cluster, message.sender);
  if (!responses) return std::nullopt;
  std::optional<Duration> shortest;
  for (std::size_t t = 0; t < sender.tasks.size(); ++t)
    for (const model::PortBinding& out : sender.tasks[t].writes) {
      if (out.pdu != message.pdu || out.medium != model::MediumId::can(can)) continue;
      if (shortest || !(*responses)[t].written) return std::nullopt;  // two writers, or no bound
      const std::int64_t fast = 1'000'000'000 - analysis::worst_drift_ppb(sender);
      shortest =
          Duration{static_cast<std::int64_t>(static_cast<Int128>((*responses)[t].written->ns) * fast / 1'000'000'000)};
    }
  return shortest;
}

}  // namespace

void derive_shortest_periods(model::Cluster& cluster) {
  std::vector<std::pair<std::size_t, model::CanMessage*>> absent;
  for (std::size_t c = 0; c < cluster.can_buses.size(); ++c)
    for (model::CanMessage& message : cluster.can_buses[c].messages)
      if (message.shortest_period == Duration{}) absent.emplace_back(c, &message);
  for (auto& [can, message] : absent) message->shortest_period = kNever;
  // Lists that activate a sender come before those that it writes. From the longest periods on, each round corrects what depends
  // on the one before it.
  std::vector<bool> bounded(absent.size(), true);
  bool changed = true;
  for (std::size_t round = 0; changed && round <= absent.size(); ++round) {
    changed = false;
    for (std::size_t i = 0; i < absent.size(); ++i) {
      auto& [can, message] = absent[i];
      const std::optional<Duration> shortest = between_lists(cluster, can, *message);
      bounded[i] = shortest && *shortest >= kGrain;
      if (!bounded[i]) continue;
      const Duration rounded = std::min(Duration{shortest->ns / kGrain.ns * kGrain.ns}, kNever);
      changed = changed || rounded != message->shortest_period;
      message->shortest_period = rounded;
    }
  }
  for (std::size_t i = 0; i < absent.size(); ++i)
    if (!bounded[i] || changed) absent[i].second->shortest_period = {};
}

}  // namespace ttf::schedules::file
