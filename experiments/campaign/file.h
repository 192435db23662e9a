// The file of a fault campaign. On FlexRay:
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
//
// On a CAN of the cluster the last eight keys are:
//
//   can: observation_can                        its nodes get the faults
//   duration: 200 ms                            length of a simulation
//   classes: {can_omission: 1, ...}
//   variants:
//     automatic: {recovery: automatic}          of a controller that is bus off
//     by_host: {recovery: host, restart_after: 20 ms}
//   expect: {harmless: [can_omission, ...]}     kinds whose faults may not harm in any variant; optional
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"
#include "sim/medium/can_medium.h"

namespace ttf::experiments::campaign {

// A variant of the campaign's cluster.
struct Variant {
  std::string name;

  // On FlexRay: the wiring.
  schedules::model::Topology topology = schedules::model::Topology::kBus;
  bool guardian = false;
  schedules::model::Channels channels = schedules::model::Channels::kAB;  // kA: channel A carries everything
  bool guarded() const { return guardian && channels == schedules::model::Channels::kAB; }

  // On a CAN.
  sim::medium::CanRecovery recovery = sim::medium::CanRecovery::kAutomatic;
  Duration restart_after{};  // by the host, from bus off on
};

struct CampaignFile {
  std::string name;
  std::string file;  // for messages
  std::string cluster_file;
  int cluster_line = 0;
  std::int64_t faults = 0;
  std::uint64_t seed = 0;
  std::array<std::int64_t, faults::kAllFaultKinds.size()> weights{};  // in the order of the kinds
  std::vector<Variant> variants;

  // On FlexRay.
  double startup_share = 0.0;
  int steady_cycles = 0, startup_cycles = 0;
  int restart_halted_after = 0;                 // [cycles]
  std::optional<std::int64_t> expected_harmed;  // faults of the hypothesis, with guardian and two channels

  // On a CAN.
  std::string can;  // its name; empty: the campaign is on FlexRay
  int can_line = 0;
  Duration duration{};
  std::vector<faults::FaultKind> harmless;  // expected

  bool is_on_can() const { return !can.empty(); }
};

// All throw InputError.
CampaignFile load_campaign(const std::string& path);
CampaignFile parse_campaign(std::string text, std::string name);
CampaignFile read_campaign(const StrictYaml& yaml);

// Returns the campaign's cluster as in its file. Throws InputError.
schedules::model::Cluster read_cluster_of(const CampaignFile& campaign);

}  // namespace ttf::experiments::campaign
