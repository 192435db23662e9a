// The rule for the true objects and the image's objects that count in a drive's measures. Others are left out.
//
//   J1  A true object counts while it is in view: a sensor could measure it (sensors/in_view.h). One that is in no field, or
//       hidden, is left out: it is neither missed nor matched.
//   J2  Pairs are found among all true objects, whether they are in view or not (fusion/metrics/object_pairs.h). An image's object whose
//       true object is out of view is left out with it: it is neither false nor a match. Any other counts.
//   J3  Identity outlasts the time out of view: an object that comes back with another track than it had is a switch
//       (fusion/metrics/clear_mot.h, C3).
//   J4  There is no grace: an object counts from the first instant in view. A tracker that needs several lists to confirm
//       it misses it meanwhile.
//
// Errors of an object that is out of view do not count, either. A tracker need not have a track there. If such errors
// counted, a tracker that gives up at once would have smaller ones than a tracker that predicts.
//
// KITTI's evaluation has the same rule for ground truth that is too far occluded: its misses and its matches are ignored (Geiger, Lenz,
// Urtasun: "Are we ready for autonomous driving? The KITTI vision benchmark suite", CVPR 2012, and its development kit). nuScenes
// leaves out boxes without a point of laser or radar (Caesar et al.: "nuScenes: a multimodal dataset for autonomous
// driving", CVPR 2020). Estimates there count as false.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/metrics/object_pairs.h"
#include "fusion/metrics/point.h"

namespace ttf::evaluation::accuracy {

// Places in the lists that were given. Those in no list are left out.
struct JudgedObjects {
  std::vector<std::size_t> truths, shown;          // ascending
  std::vector<fusion::metrics::ObjectPair> pairs;  // by growing distance
};

// `in_view` has an entry for each truth. `shown` are the image's objects, `gate_m` the largest distance of a pair [m].
JudgedObjects judged_objects(std::span<const fusion::metrics::Point> truths, const std::vector<bool>& in_view,
                             std::span<const fusion::metrics::Point> shown, double gate_m);

}  // namespace ttf::evaluation::accuracy
