#include "experiments/campaign/coverage.h"

#include <fmt/format.h>

#include <algorithm>

namespace ttf::experiments::campaign {
namespace {

std::string in_units(const Spread& spread, Duration unit) {
  if (spread.count == 0) return "-";
  return fmt::format("{:.1f} / {:.1f}", in_units_of(unit, {spread.median_ns}), in_units_of(unit, {spread.worst_ns}));
}

constexpr std::size_t kWidest = 100, kClasses = 22;  // characters of a line, and of its first column

// A column behind the classes.
struct Column {
  std::string head;
  std::size_t width;
  std::vector<std::string> cells;  // by class
};

// Columns without room go on below.
std::string table_text(const std::string& head, const std::vector<std::string>& classes,
                       const std::vector<Column>& columns) {
  std::string out;
  for (std::size_t from = 0, to = 0; from < columns.size(); from = to) {
    for (std::size_t width = kClasses; to < columns.size() && width + columns[to].width <= kWidest; ++to)
      width += columns[to].width;
    if (from > 0) out += '\n';
    out += fmt::format("{:<{}}", head, kClasses);
    for (std::size_t c = from; c < to; ++c) out += fmt::format("{:>{}}", columns[c].head, columns[c].width);
    out += '\n';
    for (std::size_t row = 0; row < classes.size(); ++row) {
      out += fmt::format("{:<{}}", classes[row], kClasses);
      for (std::size_t c = from; c < to; ++c) out += fmt::format("{:>{}}", columns[c].cells[row], columns[c].width);
      out += '\n';
    }
  }
  return out;
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
  constexpr std::size_t kCount = 9, kTimes = 17, kHarms = 14;
  std::vector<std::string> classes;
  for (const ClassCoverage& row : coverage.classes) classes.push_back(class_text(row.kind, row.in_hypothesis));
  const auto column = [&](std::string_view head, std::size_t width, const auto& cell_of) {
    Column made{std::string(head), width, {}};
    for (const ClassCoverage& row : coverage.classes) made.cells.push_back(fmt::format("{}", cell_of(row)));
    return made;
  };
  const auto times = [&](std::string_view head, Spread ClassCoverage::*of) {
    return column(head, kTimes, [&](const ClassCoverage& row) { return in_units(row.*of, words.unit); });
  };
  std::vector<Column> counts{
      column("injected", kCount, [](const ClassCoverage& row) { return row.injected; }),
      column("activated", kCount + 1, [](const ClassCoverage& row) { return row.activated; }),
      column("detected", kCount, [](const ClassCoverage& row) { return row.detected; }),
  };
  for (std::size_t c = 0; c < words.check_columns.size(); ++c)
    counts.push_back(column(words.check_columns[c], kCount, [&](const ClassCoverage& row) { return row.by_check[c]; }));
  counts.push_back(column("itself", kCount, [](const ClassCoverage& row) { return row.by_itself; }));
  counts.push_back(column("harmed", kCount, [](const ClassCoverage& row) { return row.harmed; }));
  std::vector<Column> harms;
  for (std::size_t h = 0; h < words.harms.size(); ++h)
    harms.push_back(column(words.harms[h], kHarms, [&](const ClassCoverage& row) { return row.by_harm[h]; }));
  std::string out =
      fmt::format("variant {}{}\n{}\n{}\n{}", coverage.variant,
                  coverage.has_trait ? fmt::format(" ({})", words.trait) : "", table_text("class", classes, counts),
                  table_text(fmt::format("{}, median / worst", words.unit_name), classes,
                             {times("to detect", &ClassCoverage::detect), times("to passive", &ClassCoverage::passive),
                              times(fmt::format("to {}", words.halt), &ClassCoverage::halt),
                              times(fmt::format("to {}", words.reintegrate), &ClassCoverage::reintegrate)}),
                  table_text("class", classes, harms));
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
