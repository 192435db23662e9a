// The tables of `ttfusion run` about a fault plan: injected faults, the checks that detected them, the
// guardians' interventions, changes of state, and harm to fault-free nodes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/faults/fault_account.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::drive {

// Returns the nodes on FlexRay that no active fault names. `plan` is the drive's plan, resolved.
std::vector<NodeId> fault_free_nodes(const evaluation::faults::FaultFindings& findings, const faults::FaultPlan& plan,
                                     const schedules::model::Cluster& cluster);

// `drive` names it in the first line. Effects without a matching fault have lines of their own, "unattributed".
std::string faults_text(std::string_view drive, const evaluation::faults::FaultFindings& findings,
                        const std::vector<NodeId>& fault_free, const schedules::model::Cluster& cluster);
// Returns the same as JSON, with times in seconds from the start of the drive; absent times are null.
nlohmann::ordered_json faults_json(const std::vector<evaluation::faults::FaultSeen>& faults,
                                   const schedules::model::Cluster& cluster);
// Returns the controllers on private CANs that had errors.
nlohmann::ordered_json cans_json(const std::vector<evaluation::faults::CanSeen>& cans,
                                 const schedules::model::Cluster& cluster);
nlohmann::ordered_json names_json(const std::vector<NodeId>& nodes, const schedules::model::Cluster& cluster);
nlohmann::ordered_json unattributed_json(const evaluation::faults::FaultEffects& effects,
                                         const schedules::model::Cluster& cluster);

}  // namespace ttf::cli::drive
