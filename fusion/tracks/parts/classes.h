// The class of a track's object: of the configured classes the most probable one. Four things count, each by its logarithm:
//   share    how frequent the class is;
//   sizes    how well its prior explains the measured sizes (fusion/tracks/body/size_evidence.h), and the present span;
//   reports  the classes that sensors reported. A report is right with the probability 1 - class_confusion;
//   speed    over ground, if it is known: where the vehicle has odometry.
//
// When another class becomes the most probable one, the extent is what it would have become with the prior of that class. Measured
// sides keep their values, and the others take those of the class. So the point that the track follows stays, and only the centre
// behind it moves.
#pragma once

#include "fusion/config/tracker_config.h"
#include "fusion/tracks/body/extent.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

// Returns the prior that the extent of this track has.
inline const config::Sizes& prior_of(const Track& track, const config::TrackerConfig& config) {
  return config.classes.empty() ? config.sizes : config.classes[track.class_index].sizes;
}

// The angle that an outline spans, seen from a place [m], with its standard deviation [rad].
struct SeenSpan {
  linear::Vector<2> from;
  double angle, sigma;
};

// Chooses the class of the object by its sizes so far, and by this span, which the extent does not contain yet. Without
// configured classes, nothing changes.
void choose_class(Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                  const SeenSpan* span = nullptr);

}  // namespace ttf::fusion::tracks::parts
