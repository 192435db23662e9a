// Twins are two tracks of one object, for example one fed by the laser's lists and one by the camera's. They
// become one.
//
// After each list, the younger of two confirmed tracks is alike to the elder if
//   d' (P_elder + P_younger)^-1 d <= the quantile of chi-square for merge_probability.
// d is the difference of (x, y, vx, vy) of the centres, and of length and width if both tracks have measured them; each compared
// quantity is a degree of freedom. (The anchors may be different points of the object.) The same noise and the same object have driven both tracks, so their errors
// are correlated and the sum is an upper bound.
//
// A second condition tells cars side by side apart. A list contains an object once, as association assumes. So
// a list with an observation of both tracks shows two objects and resets the count; a list with neither does
// not count. The two tracks are united after merge_scans counted lists in a row with the younger alike to the
// same elder:
//   - the elder's birth, and so its identity, stays;
//   - the more certain estimate is kept whole, with its anchor: the one with the smaller determinant of the covariance of
//     (x, y, vx, vy). This is covariance intersection with all weight on one side (Julier, Uhlmann: "A non-divergent
//     estimation algorithm in the presence of unknown correlations", ACC 1997). It is consistent for every
//     correlation, which is unknown here, and keeps one layout with its modes, unlike a mixture of two layouts;
//   - the more certain heading is kept, and the extent that is more certain over its prior; reported classes add up, since each
//     observation counted once; hits are combined; the newest observation is the newer of the two;
//   - where tracks choose their class and the two read their object differently (fusion/tracks/body/reading.h), heading and extent are those
//     of the kept anchor.
// The twin of a younger track is the nearest elder by that distance, and among equals the eldest. The youngest
// track comes first. The constructor allocates all storage.
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class Twins {
 public:
  Twins(const config::TrackerConfig& config, std::size_t max_tracks);
  // Unites twins after a list; `newest` shows which tracks had an observation in it. Tracks are in order of birth.
  void unite(std::vector<Track>& tracks, const sensors::ObservationList& list, const estimators::Estimator& estimator);

 private:
  struct Seen {
    linear::Gaussian<2> at;  // the centre's position
    std::size_t track = 0;
  };
  struct Nearest {
    int elder = -1;
    double distance = 0.0;  // relative to the quantile, squared
  };
  void find_nearest(const std::vector<Track>& tracks, const estimators::Estimator& estimator);

  int lists_;
  bool reads_both_;
  double quantile_[7] = {};  // by degrees of freedom
  std::vector<Seen> by_x_;
  std::vector<Nearest> nearest_;
};

}  // namespace ttf::fusion::tracks::parts
