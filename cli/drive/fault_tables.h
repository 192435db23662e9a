// What `ttfusion run` says of a fault plan: what was injected, which check saw it and in how many cycles, what
// guardians kept from the others and why, which nodes changed state, and whether a node without a fault was harmed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/faults/fault_account.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::drive {

// The nodes on FlexRay that no fault that began names. `plan`: the run's, resolved.
std::vector<NodeId> fault_free_nodes(const evaluation::faults::FaultFindings& findings, const faults::FaultPlan& plan,
                                     const schedules::model::Cluster& cluster);

// `run`: what the tables are of, in their first line. What fits none of the faults has lines of its own,
// "unattributed".
std::string faults_text(std::string_view run, const evaluation::faults::FaultFindings& findings,
                        const std::vector<NodeId>& fault_free, const schedules::model::Cluster& cluster);
// The same, times in seconds from the start of the run; null where there is none.
nlohmann::ordered_json faults_json(const std::vector<evaluation::faults::FaultSeen>& faults,
                                   const schedules::model::Cluster& cluster);
nlohmann::ordered_json names_json(const std::vector<NodeId>& nodes, const schedules::model::Cluster& cluster);
nlohmann::ordered_json unattributed_json(const evaluation::faults::FaultEffects& effects,
                                         const schedules::model::Cluster& cluster);

}  // namespace ttf::cli::drive
