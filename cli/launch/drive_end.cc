#include "cli/launch/drive_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/counted.h"
#include "recording/records/enumerations.h"

namespace ttf::cli::launch {
namespace {

using recording::records::PocKind;

// Returns why a node was not in operation, or no value if it was.
std::optional<std::string> why_absent(const NodeAtEnd& node) {
  if (node.external) return node.state.empty() ? std::nullopt : std::optional(node.state);
  if (!node.ending) return "never started";
  if (!node.ending->success()) return node.ending->text();
  const auto state = recording::records::from_text<PocKind>(node.state);
  if (!node.on_flexray || state == PocKind::kNormalActive) return std::nullopt;
  return node.state.empty() ? "no state reported" : node.state;
}

}  // namespace

DriveEnd drive_end(const std::vector<NodeAtEnd>& nodes) {
  DriveEnd end;
  bool anybody = false;
  for (const NodeAtEnd& node : nodes) {
    auto why = why_absent(node);
    anybody = anybody || (node.on_flexray && !node.external && !why);
    if (why) end.absent.push_back({node.name, std::move(*why)});
  }
  end.nobody = !anybody;
  return end;
}

std::string DriveEnd::sentence() const {
  if (absent.empty()) return "";
  std::vector<std::string> names;
  std::vector<std::pair<std::string, std::vector<std::string>>> by_state;  // in the order of their first nodes
  for (const drive::AbsentNode& one : absent) {
    names.push_back(one.name);
    auto same = std::ranges::find(by_state, one.state, &std::pair<std::string, std::vector<std::string>>::first);
    if (same == by_state.end()) same = by_state.insert(by_state.end(), {one.state, {}});
    same->second.push_back(one.name);
  }
  std::string text =
      nobody ? "no node was in operation at the end: "
             : fmt::format("{} {} not in operation at the end: ", joined(names), names.size() == 1 ? "was" : "were");
  if (by_state.size() == 1) return text + by_state.front().first;
  for (const auto& [state, who] : by_state)
    text += fmt::format("{}{} ({})", state == by_state.front().first ? "" : "; ", state, joined(who));
  return text;
}

std::vector<std::string> states_at_end(const schedules::model::Cluster& cluster, bool cold,
                                       const std::vector<evaluation::cluster::NodeStartup>& changes) {
  std::vector<std::string> states;
  for (const schedules::model::Node& node : cluster.nodes)
    states.emplace_back(!node.flexray ? "" : cold ? "not powered on" : to_text(PocKind::kNormalActive));
  for (const evaluation::cluster::NodeStartup& node : changes)
    if (cluster.node(node.node).flexray && !node.state.empty()) states[index_of(node.node)] = node.state;
  return states;
}

std::vector<NodeAtEnd> EndWatch::nodes(const schedules::model::Cluster& cluster, const std::vector<std::string>& states,
                                       const std::vector<NodeId>& external) const {
  std::vector<NodeAtEnd> nodes;
  for (std::size_t n = 0; n < endings_.size(); ++n)
    nodes.push_back({cluster.nodes[n].name, cluster.nodes[n].flexray.has_value(), endings_[n], states[n], false});
  for (const NodeId node : external) nodes[index_of(node)].external = true;
  return nodes;
}

supervision::Hooks EndWatch::around(supervision::Hooks hooks) {
  supervision::Hooks all = hooks;
  all.on_all_ready = [this, inner = hooks.on_all_ready] {
    begun_ = true;
    return inner ? inner() : nlohmann::json::object();
  };
  all.on_gone = [this, inner = hooks.on_gone](std::size_t node, const supervision::Ending& ending, bool comes_back) {
    endings_[node] = ending;
    if (inner) inner(node, ending, comes_back);
  };
  return all;
}

}  // namespace ttf::cli::launch
