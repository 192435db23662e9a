#include "experiments/campaign/flexray/trial_draws.h"

#include "sim/medium/star_coupler.h"

namespace ttf::experiments::campaign::flexray {
namespace {

constexpr int kCyclesToPowerOn = 2;  // all nodes, in a start-up
constexpr std::int64_t kGuardianDriftPpb = 1'500'000, kIdleMicrotick_ps = 25'000;

}  // namespace

RandomStream TrialDraws::stream(Purpose purpose, std::size_t entity) const {
  return RandomStream({seed_, index_, purpose, static_cast<std::uint16_t>(entity), 0});
}

timebase::Oscillator TrialDraws::oscillator(std::size_t entity, std::int64_t microtick_ps,
                                            std::optional<std::int64_t> fixed_ppb, std::int64_t most_ppb) const {
  RandomStream draw = stream(Purpose::kClockDrift, entity);
  const std::int64_t ppb = draw.integer(-most_ppb, most_ppb);
  return {microtick_ps, fixed_ppb.value_or(ppb), draw.integer(0, microtick_ps - 1)};
}

sim::engine::BusNode TrialDraws::node(std::size_t n) const {
  const schedules::model::Node& node = cluster_.nodes[n];
  return {oscillator(n, node.microtick_ps, node.drift_ppb, node.max_drift_ppb)};
}

std::vector<sim::engine::BusNode> TrialDraws::starting() const {
  std::vector<sim::engine::BusNode> nodes;
  for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
    const std::int64_t latest = cluster_.cycle().ns * kCyclesToPowerOn;
    nodes.push_back(node(n));
    nodes.back().power_on = TrueTime{stream(Purpose::kCampaign, n + 1).integer(0, latest)};
  }
  return nodes;
}

// The rate correction cancels the drift to a microtick per cycle, as after start-up.
std::vector<sim::engine::BusNode> TrialDraws::integrated(TrueTime origin) const {
  std::vector<sim::engine::BusNode> nodes;
  for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
    sim::engine::BusNode& made = nodes.emplace_back(node(n));
    const Microticks begins = made.oscillator.ticks_at(origin);
    const std::int64_t thousand = (made.oscillator.ticks_at(origin + cluster_.cycle() * 1000) - begins).value;
    made.clock = {begins + Microticks{1},
                  static_cast<int>((thousand + 500) / 1000 - cluster_.nodes[n].flexray->pMicroPerCycle)};
  }
  return nodes;
}

std::vector<timebase::Oscillator> TrialDraws::guardians() const {
  std::vector<timebase::Oscillator> guardians;
  for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
    const bool needed = sim::medium::StarCoupler::needed(cluster_, channel);
    guardians.push_back(
        oscillator(cluster_.nodes.size() + index_of(channel),
                   needed ? sim::medium::StarCoupler::microtick_ps(cluster_, channel) : kIdleMicrotick_ps, std::nullopt,
                   kGuardianDriftPpb));
  }
  return guardians;
}

}  // namespace ttf::experiments::campaign::flexray
