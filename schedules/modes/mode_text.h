// Modes and their bounds as tables for people.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "schedules/model/cluster.h"
#include "schedules/modes/detection_modes.h"

namespace ttf::schedules::modes {

// Modes of one task that were found sound, with the names of the cameras: a capital letter each.
struct SoundModes {
  Detector detector;
  Grid grid;
  const std::vector<Mode>* modes = nullptr;
  std::string_view letters;
};

// A mode's bounds, or those of a change from a mode to another ("ABC then AaBaCa"), in a chain.
struct BoundsOfMode {
  std::string name;
  std::vector<CameraBound> cameras;
};
std::vector<BoundsOfMode> bounds_by_mode(const model::Cluster& cluster, const SoundModes& sound, std::size_t chain);

// Returns the names of the chains behind the task, in the order of their numbers.
std::vector<std::string> chain_names(const model::Cluster& cluster, const Detector& detector);

// Returns a row for each detection of the mode.
std::string instants_text(const Mode& mode, const SoundModes& sound);
// Returns the bounds of all chains, or a sentence if there is none.
std::string bounds_text(const model::Cluster& cluster, const SoundModes& sound);

// Returns the modes that the cluster's file states, with their bounds; empty without any. The cluster has passed check().
std::string stated_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::modes
