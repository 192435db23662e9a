#include "evaluation/cluster/startup_account.h"

namespace ttf::evaluation::cluster {

NodeStartup& StartupAccount::of(NodeId node) {
  NodeStartup& startup = nodes_[node];
  startup.node = node;
  return startup;
}

void StartupAccount::on(const recording::records::PowerChanged& power) {
  NodeStartup& startup = of(power.stamp.node);
  if (power.on && !startup.powered) startup.powered = power.stamp.true_time;
  if (power.on) return;
  startup.state = "off";
  startup.why = "its supply was switched off";
}

void StartupAccount::on(const recording::records::StateChanged& change) {
  NodeStartup& startup = of(change.stamp.node);
  startup.state = change.to_name;
  startup.why = change.why;
  if (!change.consequence.empty()) startup.why += "; " + std::string(change.consequence);
  if (change.to != recording::records::PocKind::kNormalActive || startup.active) return;
  // It happens at the start of a cycle; global time counts whole macroticks.
  const std::int64_t cycle = cycle_.ns > 0 ? (change.stamp.global.ns + cycle_.ns / 2) / cycle_.ns : 0;
  startup.active = {change.stamp.true_time, cycle, std::string(change.from_name), startup.why};
}

std::vector<NodeStartup> StartupAccount::nodes() const {
  std::vector<NodeStartup> list;
  for (const auto& entry : nodes_) list.push_back(entry.second);
  return list;
}

}  // namespace ttf::evaluation::cluster
