#include "cli/drive/fault_tables.h"

#include <fmt/format.h>

#include <optional>

#include "core/counted.h"
#include "evaluation/faults/reach.h"
#include "recording/records/enumerations.h"
#include "report/drawing/tables.h"
#include "report/drive/injected_table.h"

namespace ttf::cli::drive {
namespace {

using evaluation::faults::CanSeen;
using evaluation::faults::CheckSeen;
using evaluation::faults::FaultEffects;
using evaluation::faults::FaultFindings;
using evaluation::faults::FaultSeen;
using evaluation::faults::GuardianSeen;
using evaluation::faults::Harm;
using evaluation::faults::HarmSeen;
using evaluation::faults::StateSeen;
using recording::records::CanError;

double seconds(TrueTime at) { return (at - TrueTime{}).seconds(); }
std::string cell(TrueTime at) { return report::drawing::cell(seconds(at), 6); }

std::string node_names(const std::vector<NodeId>& nodes, const schedules::model::Cluster& cluster) {
  std::string names;
  for (const NodeId node : nodes) names += (names.empty() ? "" : ", ") + node_name(node, cluster);
  return names;
}

constexpr std::string_view kUnattributed = "unattributed";

// Calls `each` for every fault's effects with its name in the tables; unattributed effects come last.
template <class Each> void for_each(const FaultFindings& findings, Each each) {
  for (const FaultSeen& fault : findings.faults) each(fmt::format("{}", fault.fault), fault, fault.begins);
  each(std::string(kUnattributed), findings.unattributed, std::optional<TrueTime>());
}

std::string injected_text(const FaultFindings& findings, const schedules::model::Cluster& cluster) {
  report::drawing::Table table(report::drive::injected_columns());
  table.end_in_words();
  for (const FaultSeen& fault : findings.faults)
    table.add(report::drive::injected_row(fault, node_name(fault.node, cluster)));
  return table.text();
}

std::string seers(const CheckSeen& seen, const schedules::model::Cluster& cluster) {
  std::string names = node_names(seen.nodes, cluster);
  for (const auto channel : schedules::model::kBothChannels)
    if (seen.guardians[index_of(channel)])
      names += fmt::format("{}guardian {}", names.empty() ? "" : ", ", letter(channel));
  return names;
}

std::string checks_text(const FaultFindings& findings, const schedules::model::Cluster& cluster) {
  report::drawing::Table table({"#", "check", "cycles", "after [ms]", "seen by"});
  table.end_in_words();
  for_each(findings, [&](const std::string& name, const FaultEffects& effects, std::optional<TrueTime> begins) {
    for (const auto check : evaluation::faults::kAllChecks)
      for (const bool faulty : {false, true}) {
        const CheckSeen& seen = (faulty ? effects.by_faulty : effects.by_others)[static_cast<std::size_t>(check)];
        if (seen.cycles == 0) continue;
        table.add({name, std::string(name_of(check)), fmt::format("{}", seen.cycles),
                   begins ? report::drawing::cell(in_ms(seen.first - *begins), 3) : "-",
                   seers(seen, cluster) + (faulty ? " (faulty)" : "")});
      }
  });
  return table.rows() == 0 ? "No check on FlexRay found a fault.\n" : table.text();
}

// Returns "" without guardians, or if they did not intervene.
std::string guardians_text(const FaultFindings& findings) {
  report::drawing::Table table({"#", "guardians", "signals", "first cycle", "first [s]", "why"});
  table.end_in_words();
  for_each(findings, [&](const std::string& name, const FaultEffects& effects, std::optional<TrueTime>) {
    for (const GuardianSeen& kept : effects.guardians)
      table.add({name, kept.cut ? "cut" : "blocked", fmt::format("{}", kept.signals),
                 fmt::format("{}", kept.first_cycle), cell(kept.first), kept.why});
  });
  return table.rows() == 0 ? "" : table.text() + "\n";
}

std::string states_text(const FaultFindings& findings, const schedules::model::Cluster& cluster) {
  report::drawing::Table table({"#", "node", "first [s]", "times", "from", "to", "why"});
  table.end_in_words();
  for_each(findings, [&](const std::string& name, const FaultEffects& effects, std::optional<TrueTime>) {
    for (const StateSeen& state : effects.states)
      table.add({name, node_name(state.node, cluster), cell(state.first), fmt::format("{}", state.times), state.from,
                 state.to, state.why});
  });
  return table.rows() == 0 ? "No node changed its state on FlexRay.\n" : table.text();
}

// Returns "" without errors on a private CAN.
std::string cans_text(const FaultFindings& findings, const schedules::model::Cluster& cluster) {
  report::drawing::Table table(
      {"CAN", "node", "first [s]", "error frames begun", "error passive", "bus off", "errors"});
  table.end_in_words();
  for (const CanSeen& seen : findings.cans) {
    std::uint64_t all = 0;
    std::string words;
    for (std::size_t e = 0; e < seen.errors.size(); ++e) {
      if (seen.errors[e] == 0) continue;
      all += seen.errors[e];
      words += (words.empty() ? "" : ", ") +
               counted(seen.errors[e], fmt::format("{} error", to_text(static_cast<CanError>(e))));
    }
    table.add({can_name(seen.bus, cluster), node_name(seen.node, cluster), cell(seen.first), fmt::format("{}", all),
               fmt::format("{}", seen.passive), fmt::format("{}", seen.bus_off), words.empty() ? "-" : words});
  }
  return table.rows() == 0 ? "" : table.text() + "\n";
}

// Describes the harm to a node: its count and its first place.
std::string harm_words(Harm harm, const HarmSeen& harmed, const schedules::model::Cluster& cluster) {
  const std::string node = harmed.node == kNoNode ? "" : node_name(harmed.node, cluster);
  const std::string where =
      harmed.sender == kNoNode ? "" : fmt::format("slot {} of {}", harmed.slot, node_name(harmed.sender, cluster));
  const bool often = harmed.times > 1;
  switch (harm) {
    case Harm::kFrameLost:  // counts lost frames of all slots and senders
      return often ? fmt::format("{}: {} lost on all channels, the first: {}", node, counted(harmed.times, "frame"),
                                 where)
                   : fmt::format("{}: a frame lost on all channels: {}", node, where);
    case Harm::kFrameForged:
      return often ? fmt::format("{}: {} of wrong senders taken for valid, the first: {}", node,
                                 counted(harmed.times, "frame"), where)
                   : fmt::format("{}: a frame of a wrong sender taken for valid: {}", node, where);
    case Harm::kLeftActive: return node + " left normal active" + (often ? fmt::format(" {} times", harmed.times) : "");
    case Harm::kNotStarted: return node + " never became normal active";
    case Harm::kPrecision:
      return "clocks further apart than the assumed precision" + (often ? fmt::format(", {} times", harmed.times) : "");
  }
  return "";
}

std::string harms_text(const FaultFindings& findings, const std::vector<NodeId>& sound,
                       const schedules::model::Cluster& cluster) {
  std::string text;
  for_each(findings, [&](const std::string& name, const FaultEffects& effects, std::optional<TrueTime>) {
    for (const Harm harm : evaluation::faults::kAllHarms)
      for (const HarmSeen& harmed : effects.harms[static_cast<std::size_t>(harm)])
        text += fmt::format("HARMED{}{}, {:.6f} s: {}\n", name == kUnattributed ? ", " : " by fault ", name,
                            seconds(harmed.first), harm_words(harm, harmed, cluster));
  });
  if (text.empty()) text = "No fault-free node was harmed.\n";
  return text + (sound.empty() ? "No node was fault-free to the end.\n"
                               : fmt::format("{} to the end: {}\n", counted(sound.size(), "fault-free node"),
                                             node_names(sound, cluster)));
}

}  // namespace

std::string node_name(NodeId node, const schedules::model::Cluster& cluster) {
  return index_of(node) < cluster.nodes.size() ? cluster.node(node).name : "-";
}

std::string can_name(std::uint8_t bus, const schedules::model::Cluster& cluster) {
  return bus < cluster.can_buses.size() ? cluster.can_buses[bus].name : "-";
}

std::vector<NodeId> fault_free_nodes(const FaultFindings& findings, const faults::FaultPlan& plan,
                                     const schedules::model::Cluster& cluster) {
  std::vector<bool> faulty(cluster.nodes.size(), false);
  for (const FaultSeen& fault : findings.faults) {
    const std::vector<bool> named = evaluation::faults::named_by(plan.faults.at(fault.fault), cluster);
    for (std::size_t n = 0; n < named.size(); ++n) faulty[n] = faulty[n] || named[n];
  }
  std::vector<NodeId> sound;
  for (std::size_t n = 0; n < faulty.size(); ++n)
    if (!faulty[n] && cluster.nodes[n].flexray) sound.push_back(static_cast<NodeId>(n));
  return sound;
}

std::string faults_text(std::string_view drive, const FaultFindings& findings, const std::vector<NodeId>& fault_free,
                        const schedules::model::Cluster& cluster) {
  std::string text = fmt::format("Faults, {}\n", drive);
  if (findings.faults.empty()) return text + "No fault of the plan began.\n";
  return text + injected_text(findings, cluster) + "\n" + checks_text(findings, cluster) + "\n" +
         guardians_text(findings) + states_text(findings, cluster) + "\n" + cans_text(findings, cluster) +
         harms_text(findings, fault_free, cluster);
}

}  // namespace ttf::cli::drive
