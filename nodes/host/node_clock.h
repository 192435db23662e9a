// The clocks with which a node begins, the same under every engine. The oscillator is drawn from the drive's
// seed unless the cluster sets it; a node that begins integrated also has a clock of the cluster.
#pragma once

#include <cstdint>

#include "bus/controller/controller.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::host {

// Returns an oscillator with drift (Node::drift_ppb, else drawn within max_drift_ppb) and phase. `index` is the
// node's place in the cluster.
timebase::Oscillator drawn_oscillator(const schedules::model::Node& node, std::size_t index, std::uint64_t seed,
                                      std::uint32_t replication);

// Returns a clock with which integrated nodes agree on rate and offset to within their microticks. The rate
// correction gives the cycle its nominal length; cycle 0 starts at the first microtick after `first_cycle`. The
// node must be on FlexRay.
bus::controller::InitialClock integrated_clock(const timebase::Oscillator& oscillator,
                                               const schedules::model::Cluster& cluster,
                                               const schedules::model::Node& node, TrueTime first_cycle);

}  // namespace ttf::nodes::host
