// The clocks a node begins with, alike under every crank: its oscillator, drawn from the run's seed where the cluster
// leaves it open, and the clock of the cluster where it begins integrated.
#pragma once

#include <cstdint>

#include "bus/controller/controller.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::host {

// Drift (Node::drift_ppb, else drawn within max_drift_ppb) and phase. `index`: of the node in the cluster.
timebase::Oscillator drawn_oscillator(const schedules::model::Node& node, std::size_t index, std::uint64_t seed,
                                      std::uint32_t replication);

// Integrated nodes agree on rate and offset to within their microticks: the rate correction makes the cycle last its
// nominal time, and cycle 0 starts at the first microtick after `first_cycle`. The node must be on FlexRay.
bus::controller::InitialClock integrated_clock(const timebase::Oscillator& oscillator,
                                               const schedules::model::Cluster& cluster,
                                               const schedules::model::Node& node, TrueTime first_cycle);

}  // namespace ttf::nodes::host
