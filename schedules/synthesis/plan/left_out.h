// Finds the values that a plan leaves out, and puts placeholders in their place, so that the loader of cluster files
// (schedules/file/loader.h) reads the rest.
#pragma once

#include <optional>
#include <vector>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::plan {

// The left-out values by their places in the file.
struct LeftOutValues {
  struct Frame {
    bool slot = false, base_cycle = false, repetition = false, is_list = false;
  };
  LeftOutParameters parameters;
  bool cycle = false;
  std::vector<std::vector<PlannedTask>> tasks;  // by node and task
  std::vector<LeftOut> sensors;
  std::vector<Frame> frames;  // by entry
  std::vector<std::vector<bool>> shortest_periods;
  std::vector<bool> layouts;  // by PDU
};

// `longest_cycle` stands for a cycle that is left out, and the longest payload for one that is. A value that is left out by half is a finding.
LeftOutValues fill_in(StrictYaml& file, Duration longest_cycle, const std::optional<PayloadLengths>& payload,
                      Findings& findings);

}  // namespace ttf::schedules::synthesis::plan
