// The file of a fault campaign:
//
//   kind: fault_campaign
//   name: fault_campaign
//   cluster: ../schedules/flexray_demo.yaml     from this file's folder
//   faults: 100000                              each injected alone, once in every variant
//   seed: 1
//   start_up: 0.25                              share of faults injected into a start-up; the others: a running cluster
//   cycles: {steady_state: 60, start_up: 90}    length of a simulation
//   restart_halted_after: 2                     cycles until a halted controller's host restarts it; 0: never
//   classes: {crash: 1, drift: 2, ...}          weights, 0 for absent classes; all alike without `classes`
//   variants:
//     guardian: {topology: star, guardian: true, channels: AB}
//     bus: {topology: bus, guardian: false, channels: AB}
//   expect: {harmed_with_guardian: 0}           the most faults of the hypothesis that may harm; optional
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign {

// A wiring of the campaign's cluster.
struct Variant {
  std::string name;
  schedules::model::Topology topology = schedules::model::Topology::kBus;
  bool guardian = false;
  schedules::model::Channels channels = schedules::model::Channels::kAB;  // kA: channel A carries everything

  bool guarded() const { return guardian && channels == schedules::model::Channels::kAB; }
};

struct CampaignFile {
  std::string name;
  std::string file;  // for messages
  std::string cluster_file;
  int cluster_line = 0;
  std::int64_t faults = 0;
  std::uint64_t seed = 0;
  double startup_share = 0.0;
  int steady_cycles = 0, startup_cycles = 0;
  int restart_halted_after = 0;                                       // [cycles]
  std::array<std::int64_t, faults::kAllFaultKinds.size()> weights{};  // in the order of the kinds
  std::vector<Variant> variants;
  std::optional<std::int64_t> expected_harmed;  // faults of the hypothesis, with guardian and two channels
};

// All throw InputError.
CampaignFile load_campaign(const std::string& path);
CampaignFile parse_campaign(std::string text, std::string name);
CampaignFile read_campaign(const StrictYaml& yaml);

// Returns the campaign's cluster, wired as in the variant and proved consistent; all its nodes are on FlexRay.
// Throws InputError.
schedules::model::Cluster cluster_of(const CampaignFile& campaign, const Variant& variant);

}  // namespace ttf::experiments::campaign
