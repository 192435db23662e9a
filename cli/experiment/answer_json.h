// The answer of a sweep as JSON: answer.json of its folder, and `--json`.
#pragma once

#include <nlohmann/json.hpp>

#include "experiments/sweep/answers/text.h"

namespace ttf::cli::experiment {

// Numbers that are not finite are null.
nlohmann::ordered_json answer_json(const experiments::sweep::SweepFile& sweep,
                                   const experiments::sweep::answers::SweepAnswer& answer);

}  // namespace ttf::cli::experiment
