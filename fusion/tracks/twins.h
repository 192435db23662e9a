// Two tracks of one object, such as one that the laser's lists feed and one that the camera's do, become one.
//
// After each list, of two confirmed tracks the younger is alike to the elder if
//   d' (P_elder + P_younger)^-1 d <= the quantile of chi-square for merge_probability,
// d being the difference of (x, y, vx, vy), and of length and width where both know them: as many degrees of freedom as
// are compared. Both have been driven by the same noise and by one object, so that their errors are correlated and the
// sum is an upper bound; what tells cars that drive side by side apart is the second condition. A list has an object
// once (as association assumes): the list in which both have an observation shows two objects, and the count begins
// anew. A list that has neither counts for nothing. After merge_scans lists in a row that had one of them, the younger
// alike to the same elder, the two are united:
//   - the elder's birth, and so its identity, stays;
//   - of the estimates the more certain one is kept, whole: that of the smaller determinant of the covariance of (x, y,
//     vx, vy). It is covariance intersection with all weight on one side (Julier, Uhlmann: "A non-divergent estimation
//     algorithm in the presence of unknown correlations", ACC 1997): consistent whatever the correlation, which nobody
//     knows here, and a belief of one layout with its modes, which a mixture of two layouts would not be;
//   - heading and extent likewise, each the more certain one; classes are added up, since each observation was counted
//     once; hits are joined, and what is newest is the newer's.
// A younger track has for its twin the nearest elder by that distance, of equal ones the eldest; the youngest is asked
// first. Storage is taken at construction.
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks {

class Twins {
 public:
  Twins(const config::TrackerConfig& config, std::size_t max_tracks);
  // After a list was taken in: hits says who had an observation in it. Tracks in order of birth.
  void unite(std::vector<Track>& tracks, const estimators::Estimator& estimator);

 private:
  struct Seen {
    estimators::Cartesian at;
    std::size_t track = 0;
  };
  struct Nearest {
    int elder = -1;
    double distance = 0.0;  // of the quantile, squared
  };
  void find_nearest(const std::vector<Track>& tracks, const estimators::Estimator& estimator);

  int scans_;
  double quantile_[7] = {};  // by degrees of freedom
  std::vector<Seen> by_x_;
  std::vector<Nearest> nearest_;
};

}  // namespace ttf::fusion::tracks
