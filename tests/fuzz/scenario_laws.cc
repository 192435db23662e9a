#include "tests/fuzz/scenario_laws.h"

#include <cmath>
#include <vector>

#include "core/check.h"
#include "nodes/scenario.h"
#include "nodes/scene.h"
#include "tests/fuzz/harness.h"

namespace ttf::fuzz {
namespace {

constexpr char kFile[] = "scenarios/drive.yaml";
constexpr Duration kLongestDrawn = Duration::milliseconds(2'000);  // longer worlds only cost time here

}  // namespace

bool check_scenario(const std::string& text) {
  nodes::Scenario scenario;
  if (!accepted(kFile, [&] { scenario = nodes::parse_scenario(text, kFile); })) return false;
  TTF_CHECK(scenario.evaluate_from <= scenario.duration, "evaluated from {}, {} long", scenario.evaluate_from.ns,
            scenario.duration.ns);
  scenario.world.duration = std::min(scenario.world.duration, kLongestDrawn);
  const nodes::WorldScene scene(scenario.world, scenario.seed, 0, TrueTime{});
  std::vector<world::ObjectState> states;
  for (const Duration at : {Duration{-1}, Duration{}, Duration::milliseconds(57), scenario.world.duration,
                            scenario.duration}) {
    scene.states_at(TrueTime{} + at, states);
    TTF_CHECK(states.size() == scenario.world.objects.size(), "{} objects", states.size());
    for (const world::ObjectState& s : states)
      TTF_CHECK(std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.heading) && std::isfinite(s.speed) &&
                    s.length > 0 && s.width > 0,
                "x {} y {} heading {} speed {} length {} width {}", s.x, s.y, s.heading, s.speed, s.length,
                s.width);
  }
  return true;
}

}  // namespace ttf::fuzz
