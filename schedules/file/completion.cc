#include "schedules/file/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "schedules/analysis/clock_bounds.h"

namespace ttf::schedules::file {
namespace {

template <class Table> auto row_of(const Table& table, std::string_view name) {
  return std::find_if(std::begin(table), std::end(table), [&](const auto& row) { return row.name == name; });
}

const auto& integers(const model::GlobalParameters&) { return kGlobalIntegers; }
const auto& integers(const model::NodeParameters&) { return kNodeIntegers; }
const auto& scaled_ones(const model::GlobalParameters&) { return kGlobalScaled; }
const auto& scaled_ones(const model::NodeParameters&) { return kNodeScaled; }

// As a file has it.
std::string decimal(std::int64_t value, std::int64_t scale) {
  return fmt::format("{}", static_cast<double>(value) / static_cast<double>(scale));
}

}  // namespace

// An absent parameter without a value is a missing one. A value outside its range stays out, unless other mistakes may
// be the reason.
template <class Struct>
void Completion::take(Struct& into, YamlMap& map, Absent& absent, std::string_view name, std::string_view derivation,
                      std::optional<std::int64_t> value) {
  if (!absent.contains(name)) return;
  const auto integer = row_of(integers(into), name);
  const auto scaled = row_of(scaled_ones(into), name);
  const bool is_integer = integer != std::end(integers(into));
  if (!value) {
    if (is_integer)
      into.*(integer->member) = static_cast<int>(map.integer(name, {integer->low, integer->high}, integer->unit));
    else
      into.*(scaled->member) = map.scaled(name, scaled->scale, {scaled->low, scaled->high}, scaled->unit);
    return;
  }
  const std::int64_t scale = is_integer ? 1 : scaled->scale;
  const std::int64_t low = is_integer ? integer->low : scaled->low, high = is_integer ? integer->high : scaled->high;
  const std::string_view unit = is_integer ? integer->unit : scaled->unit;
  const std::int64_t inside = std::clamp(*value, low, high);
  if (is_integer)
    into.*(integer->member) = static_cast<int>(inside);
  else
    into.*(scaled->member) = inside;
  absent.erase(absent.find(name));
  if (inside != *value && findings_.empty())
    map.fail(name, fmt::format("is absent, and would be {}, {}: must be {}..{}{}{}", decimal(*value, scale), derivation,
                               decimal(low, scale), decimal(high, scale), unit.empty() ? "" : " ", unit));
  cluster_.derived.push_back({fmt::format("{}.{}", map.path(), name), decimal(inside, scale)});
}

void Completion::globals(YamlMap& map, Absent absent) {
  for (const GlobalRule& rule : global_rules())
    if (absent.contains(rule.parameter))
      take(cluster_.flexray, map, absent, rule.parameter, rule.derivation, rule.value(cluster_.flexray, absent));
}

void Completion::clock(std::size_t node, YamlMap& map, Absent absent) {
  waiting_.push_back({node, map, std::move(absent)});
  complete(waiting_.back(), clock_rules(), 0);
  model::Node& item = cluster_.nodes[node];
  item.microtick_ps = item.flexray->pdMicrotick_ps;
}

void Completion::complete(Waiting& waiting, std::span<const NodeRule> rules, std::int64_t worst_drift_ppb) {
  model::Node& node = cluster_.nodes[waiting.node];
  for (const NodeRule& rule : rules) {
    if (!waiting.absent.contains(rule.parameter)) continue;
    const Controller controller{cluster_,
                                static_cast<NodeId>(waiting.node),
                                {cluster_.flexray, *node.flexray, analysis::worst_drift_ppb(node), worst_drift_ppb}};
    take(*node.flexray, waiting.map, waiting.absent, rule.parameter, rule.derivation,
         rule.value(controller, waiting.absent));
  }
}

void Completion::finish() {
  std::int64_t worst = 0;
  for (const model::Node& node : cluster_.nodes)
    if (node.flexray) worst = std::max(worst, analysis::worst_drift_ppb(node));
  for (Waiting& waiting : waiting_) complete(waiting, node_rules(), worst);
  say_shared_values_once();
}

// A parameter that all controllers leave out, with one value, stands among the shared ones.
void Completion::say_shared_values_once() {
  std::vector<model::DerivedValue> said;
  for (const model::DerivedValue& one : cluster_.derived) {
    const std::string name = one.path.substr(one.path.rfind('.') + 1);
    const auto same = [&](const Waiting& waiting) {
      const std::string path = fmt::format("{}.{}", waiting.map.path(), name);
      return std::any_of(cluster_.derived.begin(), cluster_.derived.end(), [&](const model::DerivedValue& other) {
        return other.path == path && other.value == one.value;
      });
    };
    if (!one.path.starts_with("nodes.") || !std::all_of(waiting_.begin(), waiting_.end(), same)) {
      said.push_back(one);
      continue;
    }
    const std::string shared = "node_parameters." + name;
    if (std::none_of(said.begin(), said.end(), [&](const auto& before) { return before.path == shared; }))
      said.push_back({shared, one.value});
  }
  cluster_.derived = std::move(said);
}

}  // namespace ttf::schedules::file
