// The measures of tracking as a whole (evaluation/accuracy/tracking_judge.h), as JSON: the same for `run`, `launch` and
// `track`.
#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/accuracy/tracking_judge.h"

namespace ttf::cli {

// Returns `gospa`, `ospa`, `clear_mot` and `track_life`. Values that are not finite become null.
nlohmann::ordered_json tracking_json(const evaluation::accuracy::TrackingMeasures& measures);

}  // namespace ttf::cli
