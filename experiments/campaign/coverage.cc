#include "experiments/campaign/coverage.h"

#include <fmt/format.h>

#include <algorithm>

namespace ttf::experiments::campaign {
namespace {

std::string in_cycles(const Spread& spread, Duration cycle) {
  if (spread.count == 0) return "-";
  return fmt::format("{:.1f} / {:.1f}", in_units_of(cycle, {spread.median_ns}), in_units_of(cycle, {spread.worst_ns}));
}

std::string_view short_name(evaluation::faults::Check check) {
  switch (check) {
    case evaluation::faults::Check::kBoundary: return "bound.";
    case evaluation::faults::Check::kConflict: return "confl.";
    case evaluation::faults::Check::kNoFrame: return "no fr.";
    case evaluation::faults::Check::kUnexpected: return "unexp.";
    case evaluation::faults::Check::kMissingTerm: return "missing";
    case evaluation::faults::Check::kGuardian: return "guard";
    case evaluation::faults::Check::kSyntax:
    case evaluation::faults::Check::kContent:
    case evaluation::faults::Check::kLimit:
    case evaluation::faults::Check::kPassive:
    case evaluation::faults::Check::kHalt: return name_of(check);
  }
  return "";
}

}  // namespace

std::string class_text(faults::FaultKind kind, bool in_hypothesis) {
  std::string name(faults::name_of(kind));
  if (!in_hypothesis) name += faults::has_node(kind) ? " *" : " A+B *";
  return name;
}

Spread spread_of(std::vector<std::int64_t> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.size(), values[(values.size() - 1) / 2], values.back()};
}

Coverage coverage_of(const CampaignFile& campaign, std::span<const FaultResult> results, std::size_t variant) {
  Coverage coverage;
  coverage.variant = campaign.variants[variant].name;
  coverage.guarded = campaign.variants[variant].guarded();
  for (const faults::FaultKind kind : faults::kAllFaultKinds)
    for (const bool in : {true, false}) {
      ClassCoverage row;
      row.kind = kind;
      row.in_hypothesis = in;
      std::vector<std::int64_t> detect, passive, halt, reintegrate;
      for (const FaultResult& result : results) {
        if (result.drawn.fault.kind != kind || in_hypothesis(result.drawn.fault) != in) continue;
        const FaultOutcome& outcome = result.outcomes[variant];
        ++row.injected;
        row.without += !outcome.starts_without;
        row.harmed += outcome.harms != 0;
        for (std::size_t h = 0; h < evaluation::faults::kAllHarms.size(); ++h)
          row.by_harm[h] += outcome.harms >> h & 1u;
        if (!outcome.activated) continue;
        ++row.activated;
        row.detected += outcome.seen_by_others != 0;
        row.by_itself += outcome.seen_by_itself != 0;
        for (std::size_t c = 0; c < evaluation::faults::kAllChecks.size(); ++c)
          row.by_check[c] += outcome.seen_by_others >> c & 1u;
        if (outcome.detected_after) detect.push_back(*outcome.detected_after);
        if (outcome.passive_after) passive.push_back(*outcome.passive_after);
        if (outcome.halt_after) halt.push_back(*outcome.halt_after);
        if (outcome.reintegrated_after) reintegrate.push_back(*outcome.reintegrated_after);
      }
      if (row.injected == 0) continue;
      row.detect = spread_of(std::move(detect));
      row.passive = spread_of(std::move(passive));
      row.halt = spread_of(std::move(halt));
      row.reintegrate = spread_of(std::move(reintegrate));
      if (in) coverage.harmed_in_hypothesis += row.harmed;
      coverage.classes.push_back(row);
    }
  return coverage;
}

std::string coverage_text(const Coverage& coverage, Duration cycle) {
  std::string out =
      fmt::format("variant {}{}\n{:<22}{:>9}{:>10}{:>9}", coverage.variant,
                  coverage.guarded ? " (guardian and two channels)" : "", "class", "injected", "activated", "detected");
  for (const evaluation::faults::Check check : evaluation::faults::kAllChecks)
    out += fmt::format("{:>9}", short_name(check));
  out += fmt::format("{:>9}{:>9}\n", "itself", "harmed");
  for (const ClassCoverage& row : coverage.classes) {
    out += fmt::format("{:<22}{:>9}{:>10}{:>9}", class_text(row.kind, row.in_hypothesis), row.injected, row.activated,
                       row.detected);
    for (const std::uint64_t count : row.by_check) out += fmt::format("{:>9}", count);
    out += fmt::format("{:>9}{:>9}\n", row.by_itself, row.harmed);
  }
  out += fmt::format("\n{:<22}{:>17}{:>17}{:>17}{:>17}", "cycles, median / worst", "to detect", "to passive", "to halt",
                     "to reintegrate");
  for (const evaluation::faults::Harm harm : evaluation::faults::kAllHarms) out += fmt::format("{:>14}", name_of(harm));
  out += '\n';
  for (const ClassCoverage& row : coverage.classes) {
    out += fmt::format("{:<22}{:>17}{:>17}{:>17}{:>17}", class_text(row.kind, row.in_hypothesis),
                       in_cycles(row.detect, cycle), in_cycles(row.passive, cycle), in_cycles(row.halt, cycle),
                       in_cycles(row.reintegrate, cycle));
    for (const std::uint64_t count : row.by_harm) out += fmt::format("{:>14}", count);
    out += '\n';
  }
  std::uint64_t without = 0;
  for (const ClassCoverage& row : coverage.classes) without += row.without;
  if (without > 0) out += fmt::format("{} start-ups fail without the fault, too\n", without);
  out += fmt::format("faults of the hypothesis that harmed a fault-free node: {}\n", coverage.harmed_in_hypothesis);
  return out;
}

std::string harm_text(const FaultOutcome& outcome, const schedules::model::Cluster& cluster) {
  std::string out = names_of(outcome.harms, evaluation::faults::kAllHarms);
  if (outcome.harmed != kNoNode) out += fmt::format(" at {}", cluster.node(outcome.harmed).name);
  if (outcome.sender != kNoNode) out += fmt::format(", {}'s slot {}", cluster.node(outcome.sender).name, outcome.slot);
  if (outcome.harmed_after)
    out += fmt::format(", {:.1f} cycles after the fault's first act",
                       in_units_of(cluster.cycle(), {*outcome.harmed_after}));
  return out;
}

std::string fault_text(const DrawnFault& drawn, const schedules::model::Cluster& cluster) {
  const faults::Fault& fault = drawn.fault;
  return fmt::format("{}{}{} in {}: {}", faults::name_of(fault.kind), fault.node == kNoNode ? "" : " of ",
                     fault.node == kNoNode ? "" : cluster.node(fault.node).name,
                     drawn.starts_up ? "a start-up" : "a running cluster", faults::entry_of(fault, cluster));
}

}  // namespace ttf::experiments::campaign
