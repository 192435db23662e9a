#include "experiments/campaign/coverage.h"

#include <fmt/format.h>

#include <algorithm>

namespace ttf::experiments::campaign {
namespace {

std::string in_units(const Spread& spread, Duration unit) {
  if (spread.count == 0) return "-";
  return fmt::format("{:.1f} / {:.1f}", in_units_of(unit, {spread.median_ns}), in_units_of(unit, {spread.worst_ns}));
}

}  // namespace

std::string names_of(unsigned bits, const std::vector<std::string_view>& all) {
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((bits >> i & 1u) == 0) continue;
    if (!out.empty()) out += '+';
    out += all[i];
  }
  return out;
}

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

Coverage coverage_of(const CampaignFile& campaign, const CampaignBus& bus, std::span<const FaultResult> results,
                     std::size_t variant) {
  const Words& words = bus.words();
  Coverage coverage;
  coverage.variant = campaign.variants[variant].name;
  coverage.has_trait = bus.has_trait(variant);
  for (const faults::FaultKind kind : faults::kAllFaultKinds)
    for (const bool in : {true, false}) {
      ClassCoverage row;
      row.kind = kind;
      row.in_hypothesis = in;
      row.by_check.resize(words.checks.size());
      row.by_harm.resize(words.harms.size());
      std::vector<std::int64_t> detect, passive, halt, reintegrate;
      for (const FaultResult& result : results) {
        if (result.drawn.fault.kind != kind || bus.in_hypothesis(result.drawn.fault) != in) continue;
        const FaultOutcome& outcome = result.outcomes[variant];
        ++row.injected;
        row.without += !outcome.starts_without;
        row.harmed += outcome.harms != 0;
        if (outcome.harms != 0) coverage.harmed_unexpectedly += bus.is_harmless(variant, result.drawn.fault);
        for (std::size_t h = 0; h < row.by_harm.size(); ++h) row.by_harm[h] += outcome.harms >> h & 1u;
        if (!outcome.activated) continue;
        ++row.activated;
        row.detected += outcome.seen_by_others != 0;
        row.by_itself += outcome.seen_by_itself != 0;
        for (std::size_t c = 0; c < row.by_check.size(); ++c) row.by_check[c] += outcome.seen_by_others >> c & 1u;
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
      coverage.classes.push_back(std::move(row));
    }
  return coverage;
}

std::string coverage_text(const Coverage& coverage, const Words& words) {
  std::string out = fmt::format("variant {}{}\n{:<22}{:>9}{:>10}{:>9}", coverage.variant,
                                coverage.has_trait ? fmt::format(" ({})", words.trait) : "", "class", "injected",
                                "activated", "detected");
  for (const std::string_view check : words.check_columns) out += fmt::format("{:>9}", check);
  out += fmt::format("{:>9}{:>9}\n", "itself", "harmed");
  for (const ClassCoverage& row : coverage.classes) {
    out += fmt::format("{:<22}{:>9}{:>10}{:>9}", class_text(row.kind, row.in_hypothesis), row.injected, row.activated,
                       row.detected);
    for (const std::uint64_t count : row.by_check) out += fmt::format("{:>9}", count);
    out += fmt::format("{:>9}{:>9}\n", row.by_itself, row.harmed);
  }
  out +=
      fmt::format("\n{:<22}{:>17}{:>17}{:>17}{:>17}", fmt::format("{}, median / worst", words.unit_name), "to detect",
                  "to passive", fmt::format("to {}", words.halt), fmt::format("to {}", words.reintegrate));
  for (const std::string_view harm : words.harms) out += fmt::format("{:>14}", harm);
  out += '\n';
  for (const ClassCoverage& row : coverage.classes) {
    out += fmt::format("{:<22}{:>17}{:>17}{:>17}{:>17}", class_text(row.kind, row.in_hypothesis),
                       in_units(row.detect, words.unit), in_units(row.passive, words.unit),
                       in_units(row.halt, words.unit), in_units(row.reintegrate, words.unit));
    for (const std::uint64_t count : row.by_harm) out += fmt::format("{:>14}", count);
    out += '\n';
  }
  std::uint64_t without = 0;
  for (const ClassCoverage& row : coverage.classes) without += row.without;
  if (without > 0) out += fmt::format("{} start-ups fail without the fault, too\n", without);
  out += fmt::format("faults of the hypothesis that harmed a fault-free node: {}\n", coverage.harmed_in_hypothesis);
  return out;
}

std::string harm_text(const FaultOutcome& outcome, const CampaignBus& bus) {
  const Words& words = bus.words();
  std::string out = names_of(outcome.harms, words.harms);
  if (outcome.harmed != kNoNode) out += fmt::format(" at {}", bus.cluster().node(outcome.harmed).name);
  if (outcome.sender != kNoNode)
    out += fmt::format(", {}'s {} {}", bus.cluster().node(outcome.sender).name, words.frame_id, outcome.frame_id);
  if (outcome.harmed_after)
    out += fmt::format(", {:.1f} {} after the fault's first act", in_units_of(words.unit, {*outcome.harmed_after}),
                       words.unit_name);
  return out;
}

std::string fault_text(const DrawnFault& drawn, const schedules::model::Cluster& cluster) {
  const faults::Fault& fault = drawn.fault;
  return fmt::format("{}{}{} in {}: {}", faults::name_of(fault.kind), fault.node == kNoNode ? "" : " of ",
                     fault.node == kNoNode ? "" : cluster.node(fault.node).name,
                     drawn.starts_up ? "a start-up" : "a running cluster", faults::entry_of(fault, cluster));
}

std::string parameters_text(const faults::Fault& fault, const schedules::model::Cluster& cluster) {
  std::string out;
  for (const auto& [key, value] : faults::keys_of(fault, cluster)) {
    if (!out.empty()) out += "; ";
    std::string cell = value;  // a list's commas would split the table's cell
    for (std::size_t at = 0; (at = cell.find(", ", at)) != std::string::npos;) cell.replace(at, 2, 1, '+');
    out += fmt::format("{}: {}", key, cell);
  }
  return out;
}

}  // namespace ttf::experiments::campaign
