#include "schedules/check/rules.h"

#include <fmt/format.h>

#include <array>

namespace ttf::schedules::check {
namespace {

constexpr std::array<ClusterRule, 10> kRules{{{"cycle", "the cycle and its segments", false, check_cycle},
                                              {"clocks", "clock synchronisation and start-up", false, check_clocks},
                                              {"slots", "owners and payloads of slots", false, check_slots},
                                              {"dynamic", "the dynamic segment", false, check_dynamic},
                                              {"can", "messages and loads of CANs", false, check_can},
                                              {"tasks", "activations and deadlines of tasks", true, check_tasks},
                                              {"flow", "writers and readers of lists", true, check_flow},
                                              {"loops", "sensors that follow their hosts", true, check_loops},
                                              {"modes", "modes of tasks", true, check_modes},
                                              {"round", "ages within a round of cycles", true, check_round}}};

}  // namespace

std::span<const ClusterRule> rules() { return kRules; }

bool is_skipped(const ClusterRule& rule, const model::Cluster& cluster) {
  return rule.needs_tasks && !cluster.describes_tasks();
}

std::string skipped_text(const model::Cluster& cluster) {
  std::string names;
  for (const ClusterRule& rule : kRules)
    if (is_skipped(rule, cluster)) names += fmt::format("{}{}", names.empty() ? "" : ", ", rule.subject);
  if (names.empty()) return names;
  return fmt::format("{} describes no tasks, so these are not checked: {}", cluster.name, names);
}

std::vector<Finding> check(const model::Cluster& cluster) {
  ClusterFindings findings(cluster);
  for (const ClusterRule& rule : kRules)
    if (!is_skipped(rule, cluster)) rule.check(cluster, findings);
  return findings.take();
}

}  // namespace ttf::schedules::check
