#include "tests/fuzz/scenario_laws.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "sensors/scene.h"
#include "sim/drives/scenario.h"
#include "tests/fuzz/harness.h"

namespace ttf::fuzz {
namespace {

constexpr char kScenarioFile[] = "scenarios/drive.yaml";
constexpr Duration kLongestDrawn = Duration::milliseconds(2'000);  // longer worlds only cost time here

}  // namespace

bool check_scenario(const std::string& text) {
  sim::drives::Scenario scenario;
  if (!accepted(kScenarioFile, [&] { scenario = sim::drives::parse_scenario(text, kScenarioFile); })) return false;
  TTF_CHECK(scenario.evaluate_from <= scenario.duration, "evaluated from {}, {} long", scenario.evaluate_from.ns,
            scenario.duration.ns);
  for (const faults::Fault& fault : scenario.faults.faults) {
    TTF_CHECK(fault.from >= Duration{} && fault.from <= scenario.duration && fault.duration > Duration{},
              "{} from {} for {}", faults::name_of(fault.kind), fault.from.ns, fault.duration.ns);
    TTF_CHECK(fault.probability >= 0.0 && fault.probability <= 1.0 && fault.every >= 1 && fault.flips >= 1 &&
                  fault.flips <= 24 && fault.shift >= Duration{-9'000} && fault.interval >= Duration{} &&
                  std::is_sorted(fault.bits.begin(), fault.bits.end()),
              "{}: {} of every {}, {} flips", faults::name_of(fault.kind), fault.probability, fault.every, fault.flips);
    TTF_CHECK(faults::has_node(fault.kind) != fault.node_name.empty(), "{} of '{}'", faults::name_of(fault.kind),
              fault.node_name);
  }
  scenario.world.duration = std::min(scenario.world.duration, kLongestDrawn);
  const sensors::WorldScene scene(scenario.world, scenario.seed, 0, TrueTime{});
  std::vector<sim::world::ObjectState> states;
  for (const Duration at :
       {Duration{-1}, Duration{}, Duration::milliseconds(57), scenario.world.duration, scenario.duration}) {
    scene.states_at(TrueTime{} + at, states);
    TTF_CHECK(states.size() == scenario.world.objects.size(), "{} objects", states.size());
    for (const sim::world::ObjectState& s : states)
      TTF_CHECK(std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.heading) && std::isfinite(s.speed) &&
                    s.length > 0 && s.width > 0,
                "x {} y {} heading {} speed {} length {} width {}", s.x, s.y, s.heading, s.speed, s.length, s.width);
  }
  return true;
}

}  // namespace ttf::fuzz
