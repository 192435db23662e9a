// The tables of `ttfusion run` about a fault plan: injected faults, the checks that detected them, the
// guardians' interventions, changes of state, and harm to fault-free nodes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/faults/fault_account.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::drive {

// Return "-" for one that the cluster has not.
std::string node_name(NodeId node, const schedules::model::Cluster& cluster);
std::string can_name(std::uint8_t bus, const schedules::model::Cluster& cluster);

// Returns the nodes on FlexRay that no active fault names. `plan` is the drive's plan, resolved.
std::vector<NodeId> fault_free_nodes(const evaluation::faults::FaultFindings& findings, const faults::FaultPlan& plan,
                                     const schedules::model::Cluster& cluster);

// `drive` names it in the first line. Effects without a matching fault have lines of their own, "unattributed".
std::string faults_text(std::string_view drive, const evaluation::faults::FaultFindings& findings,
                        const std::vector<NodeId>& fault_free, const schedules::model::Cluster& cluster);

}  // namespace ttf::cli::drive
