#include "cli/fault_tables.h"

#include <fmt/format.h>

#include <optional>

#include "report/tables.h"

namespace ttf::cli {
namespace {

using experiments::CheckSeen;
using experiments::FaultSeen;
using experiments::Harm;
using experiments::StateSeen;

double seconds(TrueTime at) { return (at - TrueTime{}).seconds(); }
std::string cell(TrueTime at) { return report::cell(seconds(at), 6); }
std::string cell(const std::optional<TrueTime>& at) { return at ? cell(*at) : "-"; }

std::string node_name(NodeId node, const schedules::Cluster& cluster) {
  return index_of(node) < cluster.nodes.size() ? cluster.node(node).name : "-";
}

std::string node_names(const std::vector<NodeId>& nodes, const schedules::Cluster& cluster) {
  std::string names;
  for (const NodeId node : nodes) names += (names.empty() ? "" : ", ") + node_name(node, cluster);
  return names;
}

std::string_view words(Harm harm) {
  switch (harm) {
    case Harm::kLeftActive: return "left normal active";
    case Harm::kNotStarted: return "never became normal active";
    case Harm::kPrecision: return "clocks further apart than the assumed precision";
    case Harm::kFrameLost: return "did not receive a frame on any channel";
    case Harm::kFrameForged: return "took another's frame for valid";
  }
  return "";
}

std::string injected_text(const std::vector<FaultSeen>& faults, const schedules::Cluster& cluster) {
  report::Table table({"#", "fault", "node", "begins [s]", "first act [s]", "acts", "ends [s]", "what it did first"});
  for (const FaultSeen& fault : faults)
    table.add({fmt::format("{}", fault.fault), fault.kind, node_name(fault.node, cluster), cell(fault.begins),
               cell(fault.first_act), fmt::format("{}", fault.acts), cell(fault.ends), fault.text});
  return table.text();
}

std::string checks_text(const std::vector<FaultSeen>& faults, const schedules::Cluster& cluster) {
  report::Table table({"#", "check", "cycles", "after [ms]", "seen by"});
  for (const FaultSeen& fault : faults)
    for (const auto check : experiments::kAllChecks)
      for (const bool faulty : {false, true}) {
        const CheckSeen& seen = (faulty ? fault.by_faulty : fault.by_others)[static_cast<std::size_t>(check)];
        if (seen.cycles == 0) continue;
        table.add({fmt::format("{}", fault.fault), std::string(name_of(check)), fmt::format("{}", seen.cycles),
                   report::cell(1e3 * (seen.first - fault.begins).seconds(), 3),
                   node_names(seen.nodes, cluster) + (faulty ? " (faulty)" : "")});
      }
  return table.rows() == 0 ? "No check saw anything.\n" : table.text();
}

std::string states_text(const std::vector<FaultSeen>& faults, const schedules::Cluster& cluster) {
  report::Table table({"#", "node", "first [s]", "times", "from", "to", "why"});
  for (const FaultSeen& fault : faults)
    for (const StateSeen& state : fault.states)
      table.add({fmt::format("{}", fault.fault), node_name(state.node, cluster), cell(state.first),
                 fmt::format("{}", state.times), state.from, state.to, state.why});
  return table.rows() == 0 ? "No node changed its state.\n" : table.text();
}

std::string harms_text(const std::vector<FaultSeen>& faults, const schedules::Cluster& cluster) {
  std::string text;
  for (const FaultSeen& fault : faults)
    for (const Harm harm : experiments::kAllHarms) {
      const auto& harmed = fault.harms[static_cast<std::size_t>(harm)];
      if (!harmed) continue;
      text += fmt::format("HARMED by fault {}, {:.6f} s: {}{}", fault.fault, seconds(harmed->first),
                          harmed->node == kNoNode ? "" : node_name(harmed->node, cluster) + " ", words(harm));
      if (harmed->sender != kNoNode)
        text += fmt::format(": slot {} of {}", harmed->slot, node_name(harmed->sender, cluster));
      text += "\n";
    }
  return text.empty() ? "No fault-free node was harmed.\n" : text;
}

nlohmann::ordered_json names_json(const std::vector<NodeId>& nodes, const schedules::Cluster& cluster) {
  auto names = nlohmann::ordered_json::array();
  for (const NodeId node : nodes) names.push_back(node_name(node, cluster));
  return names;
}

nlohmann::ordered_json checks_json(const FaultSeen& fault, const schedules::Cluster& cluster) {
  auto checks = nlohmann::ordered_json::array();
  for (const auto check : experiments::kAllChecks)
    for (const bool faulty : {false, true}) {
      const CheckSeen& seen = (faulty ? fault.by_faulty : fault.by_others)[static_cast<std::size_t>(check)];
      if (seen.cycles > 0)
        checks.push_back({{"check", name_of(check)}, {"by_faulty_node", faulty}, {"cycles", seen.cycles},
                          {"first_s", seconds(seen.first)}, {"nodes", names_json(seen.nodes, cluster)}});
    }
  return checks;
}

nlohmann::ordered_json seconds_or_null(const std::optional<TrueTime>& at) {
  return at ? nlohmann::ordered_json(seconds(*at)) : nlohmann::ordered_json(nullptr);
}
nlohmann::ordered_json name_or_null(NodeId node, const schedules::Cluster& cluster) {
  return node == kNoNode ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(node_name(node, cluster));
}

}  // namespace

std::string faults_text(std::string_view run, const std::vector<FaultSeen>& faults, const schedules::Cluster& cluster) {
  std::string text = fmt::format("Faults, {}\n", run);
  if (faults.empty()) return text + "None of the plan's faults began.\n";
  return text + injected_text(faults, cluster) + "\n" + checks_text(faults, cluster) + "\n" + states_text(faults, cluster) +
         "\n" + harms_text(faults, cluster);
}

nlohmann::ordered_json faults_json(const std::vector<FaultSeen>& faults, const schedules::Cluster& cluster) {
  auto json = nlohmann::ordered_json::array();
  for (const FaultSeen& fault : faults) {
    nlohmann::ordered_json one;
    one["fault"] = fault.fault;
    one["kind"] = fault.kind;
    one["node"] = name_or_null(fault.node, cluster);
    one["begins_s"] = seconds(fault.begins);
    one["ends_s"] = seconds_or_null(fault.ends);
    one["acts"] = fault.acts;
    one["first_act_s"] = seconds_or_null(fault.first_act);
    one["first_act"] = fault.text;
    one["checks"] = checks_json(fault, cluster);
    one["states"] = nlohmann::ordered_json::array();
    for (const StateSeen& state : fault.states)
      one["states"].push_back({{"node", node_name(state.node, cluster)}, {"from", state.from}, {"to", state.to},
                               {"why", state.why}, {"first_s", seconds(state.first)}, {"times", state.times}});
    one["harmed"] = fault.harmed();
    one["harms"] = nlohmann::ordered_json::array();
    for (const Harm harm : experiments::kAllHarms)
      if (const auto& harmed = fault.harms[static_cast<std::size_t>(harm)])
        one["harms"].push_back({{"harm", name_of(harm)}, {"first_s", seconds(harmed->first)},
                                {"node", name_or_null(harmed->node, cluster)},
                                {"sender", name_or_null(harmed->sender, cluster)}, {"slot", harmed->slot}});
    json.push_back(std::move(one));
  }
  return json;
}

}  // namespace ttf::cli
