#include "sim/drives/startup.h"

#include <utility>

#include "core/errors.h"
#include "core/ids.h"
#include "core/random.h"

namespace ttf::sim::drives {

Startup load_startup(YamlMap& scenario, Duration latest) {
  Startup startup;
  startup.file = scenario.file();
  if (!scenario.has("startup")) return startup;
  auto mapping = scenario.map_or_word("startup", "integrated", "must be a mapping with kind: cold, or integrated");
  if (!mapping) return startup;
  YamlMap& yaml = *mapping;
  startup.cold = yaml.choice<bool>("kind", {{"integrated", false}, {"cold", true}});
  if (startup.cold) {
    startup.spread = yaml.duration_or("spread", startup.spread, {Duration{}, latest});
    if (yaml.has("power_on")) {
      const auto names = yaml.named_texts("power_on");
      YamlMap times = yaml.map("power_on");
      for (const auto& entry : names)
        startup.power_on.push_back(
            {entry.first, times.duration(entry.first, {Duration{}, latest}), times.line(entry.first)});
    }
    startup.wake_up = yaml.text_or("wake_up", "");
    startup.wake_up_line = yaml.line("wake_up");
  }
  yaml.finish();
  return startup;
}

std::vector<nodes::host::NodeStart> node_starts(const Startup& startup, const schedules::model::Cluster& cluster,
                                                std::uint64_t seed, std::uint32_t replication) {
  Findings findings;
  std::vector<nodes::host::NodeStart> starts(cluster.nodes.size());
  for (std::size_t n = 0; n < starts.size(); ++n) {
    RandomStream stream({seed, replication, Purpose::kPowerOn, static_cast<std::uint16_t>(n), 0});
    starts[n].after = Duration{stream.integer(0, startup.spread.ns)};
  }
  for (const Startup::PowerOn& entry : startup.power_on) {
    if (const auto node = cluster.find_node(entry.node))
      starts[index_of(*node)].after = entry.after;
    else
      findings.add({startup.file, entry.line, "startup.power_on", entry.node, "is not a node of " + cluster.file});
  }
  if (!startup.wake_up.empty()) {
    const auto refuse = [&](std::string why) {
      findings.add({startup.file, startup.wake_up_line, "startup.wake_up", startup.wake_up, std::move(why)});
    };
    const auto waker = cluster.find_node(startup.wake_up);
    const auto& flexray = waker ? cluster.node(*waker).flexray : std::nullopt;
    if (!waker)
      refuse("is not a node of " + cluster.file);
    else if (!flexray)
      refuse("must be on FlexRay to wake others over it");
    else if (!schedules::model::includes(flexray->pChannels, flexray->pWakeupChannel))
      refuse("must be attached to its wake-up channel");
    else
      for (std::size_t n = 0; n < starts.size(); ++n) {
        const auto& node = cluster.nodes[n].flexray;
        if (static_cast<NodeId>(n) == *waker)
          starts[n].how = nodes::host::ColdStart::kWakes;
        else if (node && schedules::model::includes(node->pChannels, flexray->pWakeupChannel))
          starts[n].how = nodes::host::ColdStart::kSleeps;
      }
  }
  findings.throw_if_any();
  return starts;
}

}  // namespace ttf::sim::drives
