// Fault reports of whole drives, for tests: made from a plan, with queries.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "evaluation/faults/fault_account.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::evaluation::faults {

using ttf::faults::FaultKind;

inline const CheckSeen& others(const FaultEffects& effects, Check check) {
  return effects.by_others[static_cast<std::size_t>(check)];
}
inline const CheckSeen& faulty(const FaultEffects& effects, Check check) {
  return effects.by_faulty[static_cast<std::size_t>(check)];
}
inline const std::vector<HarmSeen>& harm(const FaultEffects& effects, Harm harm) {
  return effects.harms[static_cast<std::size_t>(harm)];
}
inline std::set<NodeId> harmed_nodes(const FaultEffects& effects, Harm kind) {
  std::set<NodeId> nodes;
  for (const HarmSeen& one : harm(effects, kind)) nodes.insert(one.node);
  return nodes;
}

// A drive with the injector's acts of a plan.
struct Planned {
  sim::drives::Drive drive;
  std::optional<FaultAccount> report;

  explicit Planned(const char* scenario = "scenarios/paper_scenario1.yaml")
      : drive(scenario, fusion::strategies::StrategyKind::kTt) {}
  ttf::faults::Fault& add(FaultKind kind, const char* node, std::int64_t from_ms, std::int64_t duration_ms) {
    ttf::faults::Fault& fault = drive.scenario.faults.faults.emplace_back();
    fault.kind = kind;
    fault.node_name = node;
    fault.from = Duration::milliseconds(from_ms);
    if (duration_ms > 0) fault.duration = Duration::milliseconds(duration_ms);
    return fault;
  }
  FaultAccount make_report() const {
    return {drive.cluster, ttf::faults::resolve(drive.scenario.faults, drive.cluster), !drive.scenario.startup.cold};
  }
  const FaultFindings& run() {
    report.emplace(drive.cluster, ttf::faults::resolve(drive.scenario.faults, drive.cluster),
                   !drive.scenario.startup.cold);
    drive.run(*report);
    report->finish(sim::drives::drive_end(drive.scenario));
    return report->findings();
  }
  NodeId node(const char* name) const { return *drive.cluster.find_node(name); }
  std::set<NodeId> on_flexray() const {
    std::set<NodeId> nodes;
    for (std::size_t n = 0; n < drive.cluster.nodes.size(); ++n)
      if (drive.cluster.nodes[n].flexray) nodes.insert(static_cast<NodeId>(n));
    return nodes;
  }
};

}  // namespace ttf::evaluation::faults
