// Prints the share of each variant of a vehicle in a packing, and the slots that the variants save.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/schedule/packing/account.h"

namespace ttf::cli::schedule::packing {

// A table with a line for each variant, in place of that of nodes.
std::string variants_table(const Account& account);

// The slots that all signals need as those of one vehicle.
int slots_as_one_vehicle(const Account& account);

// A sentence on them.
std::string saving_text(const Account& account);

nlohmann::ordered_json variants_json(const Account& account);

}  // namespace ttf::cli::schedule::packing
