// Periodic instants in a cluster file: {base_cycle, repetition, offset}. Some follow from others, and may be absent.
#pragma once

#include <vector>

#include "core/strict_yaml.h"
#include "schedules/left_out/parts.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// The parts that may be absent.
struct MayLack {
  bool instant = false, repetition = false;
};

// Reads base cycle and repetition. An absent part is noted in `absent`, and has a placeholder. With an absent
// repetition the base cycle has no bound yet. A base cycle is absent with the instant's other key alone (`within`: an offset or a slot;
// null: with any).
void load_multiplexing(YamlMap& map, const model::GlobalParameters& flexray, const std::vector<int>& allowed,
                       const char* within, MayLack may, left_out::Instant& absent, int& base_cycle, int& repetition);

model::CycleInstant load_instant(YamlMap& map, const model::GlobalParameters& flexray, MayLack may,
                                 left_out::Instant& absent);

}  // namespace ttf::schedules::file
