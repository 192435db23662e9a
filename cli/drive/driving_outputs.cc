#include "cli/drive/driving_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/sweep/driving.h"
#include "report/drawing/tables.h"

namespace ttf::cli::drive {
report::plots::DrivingOptions driving_options(const sim::drives::Scenario& scenario,
                                              const schedules::model::Cluster& cluster, const std::string& title) {
  report::plots::DrivingOptions options{title, sim::drives::evaluation_start(scenario),
                                        sim::drives::drive_end(scenario), scenario.world.ego->front,
                                        scenario.world.ego->width};
  if (const auto lane = experiments::sweep::lane_kept(scenario, cluster))
    options.lane = [lane = evaluation::driving::TrueLane(*lane)](const recording::records::EgoTruth& ego) {
      const evaluation::driving::InLane place = lane.place_of(ego);
      return report::plots::PlaceInLane{place.offset, place.heading};
    };
  return options;
}

}  // namespace ttf::cli::drive
