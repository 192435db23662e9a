// Draws a trial's cluster: the clocks of nodes and guardians, and the instants of power-on. A pure function of
// the campaign's seed and the trial's index.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "sim/engine/bus_simulation.h"
#include "timebase/oscillator.h"

namespace ttf::experiments::campaign::flexray {

class TrialDraws {
 public:
  TrialDraws(std::uint64_t seed, std::uint32_t index, const schedules::model::Cluster& cluster)
      : seed_(seed), index_(index), cluster_(cluster) {}

  // Nodes by NodeId: powered on within some cycles, or integrated in a cluster whose cycle 0 starts at
  // `origin`.
  std::vector<sim::engine::BusNode> starting() const;
  std::vector<sim::engine::BusNode> integrated(TrueTime origin) const;
  std::vector<timebase::Oscillator> guardians() const;  // by channel

 private:
  RandomStream stream(Purpose purpose, std::size_t entity) const;
  timebase::Oscillator oscillator(std::size_t entity, std::int64_t microtick_ps, std::optional<std::int64_t> fixed_ppb,
                                  std::int64_t most_ppb) const;
  sim::engine::BusNode node(std::size_t n) const;

  std::uint64_t seed_;
  std::uint32_t index_;
  const schedules::model::Cluster& cluster_;
};

}  // namespace ttf::experiments::campaign::flexray
