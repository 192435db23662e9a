// A campaign's coverage, class by class: how many faults were active, which checks noticed them, which harms
// they did, and the delays.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/campaign/campaign.h"

namespace ttf::experiments::campaign {

// Median and worst; meaningless if count is 0.
struct Spread {
  std::uint64_t count = 0;
  std::int64_t median_ns = 0, worst_ns = 0;
};
// The lower one of two medians.
Spread spread_of(std::vector<std::int64_t> values);

// Returns the names of those of `all` whose bit is set, joined by "+".
std::string names_of(unsigned bits, const std::vector<std::string_view>& all);

// Returns a class' name in tables: "noise", and "noise A+B *" outside the hypothesis.
std::string class_text(faults::FaultKind kind, bool in_hypothesis);

// The faults of one class within the hypothesis, or those outside.
struct ClassCoverage {
  faults::FaultKind kind{};
  bool in_hypothesis = true;
  std::uint64_t injected = 0, activated = 0;
  std::uint64_t detected = 0;           // activated and detected by another node or a guardian
  std::vector<std::uint64_t> by_check;  // a fault may count for several checks
  std::uint64_t by_itself = 0;          // noticed by its own controller
  std::uint64_t harmed = 0;
  std::vector<std::uint64_t> by_harm;
  std::uint64_t without = 0;  // start-ups that fail without the fault, too
  Spread detect, passive, halt, reintegrate;
};

struct Coverage {
  std::string variant;
  bool has_trait = false;              // in the bus' words
  std::vector<ClassCoverage> classes;  // classes with faults only, in the order of the kinds
  std::uint64_t harmed_in_hypothesis = 0;
  std::uint64_t harmed_unexpectedly = 0;  // by faults that should be harmless
};

// `variant`: index in the campaign.
Coverage coverage_of(const CampaignFile& campaign, const CampaignBus& bus, std::span<const FaultResult> results,
                     std::size_t variant);

// Returns the tables for people, of at most 100 columns.
std::string coverage_text(const Coverage& coverage, const Words& words);

// "frame_lost: feature did not receive fusion's slot 3, 1.2 cycles after the fault's first act"
std::string harm_text(const FaultOutcome& outcome, const CampaignBus& bus);
// "masquerading of fusion, in a running cluster: from=..."
std::string fault_text(const DrawnFault& drawn, const schedules::model::Cluster& cluster);
// Returns its keys as in a fault plan, without kind and node, for one cell of a table: "from: 5 ns; receivers:
// [fusion+laser]".
std::string parameters_text(const faults::Fault& fault, const schedules::model::Cluster& cluster);

}  // namespace ttf::experiments::campaign
