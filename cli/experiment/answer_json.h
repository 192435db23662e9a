// The answer of a sweep as JSON: answer.json of its folder, and `--json`.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/sweep/answers/answer_text.h"

namespace ttf::cli::experiment {

// Numbers that are not finite are null. `libraries`: those of steps, with their hashes.
nlohmann::ordered_json answer_json(const experiments::sweep::SweepFile& sweep,
                                   const experiments::sweep::answers::SweepAnswer& answer,
                                   const std::map<std::string, std::string>& libraries);

}  // namespace ttf::cli::experiment
