// The checker's rules as rows of a table, in the order of their findings. A bus description, such as an imported FIBEX
// file, has no tasks: rules that need them are skipped, and named.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "schedules/check/checker.h"

namespace ttf::schedules::check {

struct ClusterRule {
  std::string_view name;
  std::string_view subject;  // for people
  bool needs_tasks = false;
  void (*check)(const model::Cluster& cluster, ClusterFindings& findings) = nullptr;
};
std::span<const ClusterRule> rules();

// Returns whether the rule is skipped for this cluster.
bool is_skipped(const ClusterRule& rule, const model::Cluster& cluster);
// Returns one sentence that names the skipped rules; empty if there are none.
std::string skipped_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::check
