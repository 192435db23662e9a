// The section `plan` of a plan: schedules/synthesis/plan/loader.h has its keys.
#pragma once

#include "core/strict_yaml.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::plan {

// Reads plan.cycle, if it is there.
std::optional<CycleLengths> read_cycle(YamlMap& section);

// The same for plan.payload.
std::optional<PayloadLengths> read_payload(YamlMap& section);

// Reads the other keys into a plan whose cluster is complete. Adds findings.
void read_section(YamlMap& section, Plan& plan);

}  // namespace ttf::schedules::synthesis::plan
