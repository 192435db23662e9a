#include "cli/node_set/vehicle.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "cli/output.h"
#include "core/counted.h"
#include "sim/drives/drive.h"

namespace ttf::cli::node_set {
namespace {

using nodes::runner::vehicle::Line;

constexpr std::chrono::milliseconds kPatience{1'000};

std::unique_ptr<Line> line_of(const NodeSet& set, std::size_t self, const sim::drives::Surroundings& around) {
  sim::world::vehicle::Driven* const driven = around.world ? around.world->world().driven() : nullptr;
  if (driven == nullptr) return nullptr;
  std::vector<std::size_t> others = nodes::runner::vehicle::processes_of(set.cluster);
  const std::size_t launch = set.cluster.nodes.size();
  if (self != launch && std::ranges::count(others, self) == 0) return nullptr;
  others.push_back(launch);
  std::erase(others, self);
  return std::make_unique<Line>(
      nodes::runner::vehicle::LinePlan{set.session, self, std::move(others), sim::drives::drive_start(set.cluster)},
      *driven);
}

}  // namespace

std::unique_ptr<Line> vehicle_line(const NodeSet& set, NodeId node, const sim::drives::Surroundings& around) {
  return line_of(set, index_of(node), around);
}

std::unique_ptr<Line> vehicle_line_of_launch(const NodeSet& set, const sim::drives::Surroundings& around) {
  return line_of(set, set.cluster.nodes.size(), around);
}

void catch_up(Line& line) {
  if (!line.catch_up(kPatience))
    print_warnings("no process of this host answered about the vehicle: the commands to it so far are unknown");
}

nlohmann::ordered_json vehicle_json(const nodes::runner::vehicle::Counts& counts) {
  return {{"told", counts.reported}, {"heard", counts.received},      {"late", counts.late},
          {"gaps", counts.gaps},     {"malformed", counts.malformed}, {"whole", counts.whole}};
}

std::string vehicle_problem(const nlohmann::json& json) {
  const auto late = json.value("late", std::uint64_t{0});
  if (!json.value("whole", true)) return "lacks commands to the vehicle, and saw it on another way";
  if (late > 0)
    return fmt::format("heard {} to the vehicle too late, and saw it elsewhere for a moment", counted(late, "command"));
  return "";
}

void warn_of_vehicle(const NodeSet& set, NodeId node, const nodes::runner::vehicle::Counts& counts) {
  const std::string& name = set.cluster.node(node).name;
  if (const std::string problem = vehicle_problem(vehicle_json(counts)); !problem.empty())
    print_warnings(fmt::format("{} {}", name, problem));
  if (counts.reported + counts.received == 0)
    print_warnings(
        fmt::format("{} knows of no command to the vehicle: the actuator's node must run on this host, with "
                    "the same --session ({})",
                    name, set.session));
}

}  // namespace ttf::cli::node_set
