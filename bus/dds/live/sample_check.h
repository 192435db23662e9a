// Checks of samples. Only sources of this folder include it.
#pragma once

#include "bus/dds/live/live_sample.h"
#include "bus/ports/live_medium.h"

namespace ttf::bus::dds::live {

// Returns whether the sample's fields are consistent for this line.
bool well_formed(const ttf_LiveSample& sample, ports::Line line);
// Returns whether a clock may show the sample's instants.
bool of_a_clock(const ttf_LiveSample& sample);

}  // namespace ttf::bus::dds::live
