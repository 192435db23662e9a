// The lists of silhouettes that cameras of all kinds have: position, covariance, and the angle that the outline spans. A camera
// that reports classes adds `class` (fusion/config/classes.h).
#pragma once

#include <vector>

#include "nodes/host/signals.h"
#include "schedules/model/cluster.h"

namespace ttf::sensors {

// The place of `class` among the signals of a list with classes.
inline constexpr std::size_t kClassSignal = 7;

// Returns the signals of a layout, in this order. Throws InputError if it lacks one, or has others.
inline std::vector<std::size_t> bind_silhouettes(const schedules::model::Cluster& cluster,
                                                 const schedules::model::PduLayout& layout) {
  if (schedules::model::find_signal(layout.element, "class"))
    return nodes::host::bind_elements<8>(
        cluster, layout, {"x", "y", "sigma_x", "sigma_y", "correlation", "span", "sigma_span", "class"});
  return nodes::host::bind_elements<7>(cluster, layout,
                                       {"x", "y", "sigma_x", "sigma_y", "correlation", "span", "sigma_span"});
}

}  // namespace ttf::sensors
