// Two objects cross at a small angle in clutter; a tracker follows them.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion {

// 60 m by 20 m, lists every 100 ms. Each object is seen with detection_probability, its position with 0.3 m.
// Each square metre has clutter_density false observations. The objects start apart, so that both tracks can be
// established before they come close.
//
//   y [m]  4 o------____
//                      ____X____
//         -4 o------             ------
//            0 s       3 s        6 s
struct Crossing {
  double detection_probability = 0.9;
  double clutter_density = 0.01;  // [1/m^2]
  double process_noise = 0.5;     // of the truth [m^2/s^3]

  // Positions, and everything else, of both objects at each list.
  struct Drive {
    std::vector<std::vector<estimators::State>> truth;  // by list, by object
    std::vector<OwnedList> lists;
  };
  Drive draw_drive(std::uint64_t seed) const;
  config::TrackerConfig config() const;  // a configuration that has all this
};

struct Followed {
  double nees = 0.0;   // mean of (x, y, vx, vy) over objects and lists with a track within 5 m
  double gospa = 0.0;  // mean [m], cut-off 5 m, order 2
  std::uint64_t switches = 0, misses = 0, false_tracks = 0;  // CLEAR-MOT, gate 3 m
};
// Over `runs` drives of seeds 1, 2, ...; judged from 1.5 s on.
Followed follow(const Crossing& crossing, const config::TrackerConfig& config, int runs);

}  // namespace ttf::fusion
