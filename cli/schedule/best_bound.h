// `ttfusion schedule sequence --best-beta`: the bound of a frame with the least expected error.
#pragma once

#include <string>

#include "schedules/sequence/expected_error.h"

namespace ttf::cli::schedule {

struct BestBound {
  schedules::sequence::FrameRequest request;  // its bound is the largest one that is tried
  schedules::sequence::DetectionTimes times;
  schedules::sequence::TrackingModel model;
  double share = 0.5;
  std::string sensors;
  bool json = false;
};

// Prints all frames up to the bound, and the best of them.
void print_best_bound(const BestBound& asked);

}  // namespace ttf::cli::schedule
