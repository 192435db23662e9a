// The class of a track's object: of the configured classes the most probable one. Four things count, each by its logarithm:
//   share    how frequent the class is;
//   sizes    how well its prior explains the measured sizes (fusion/tracks/body/size_evidence.h), and the present span;
//   reports  the classes that sensors reported. A report is right with the probability 1 - class_confusion;
//   speed    over ground, if it is known: where the vehicle has odometry.
//
// Each class is tried with both readings of the rectangle (fusion/tracks/body/reading.h): a measured face of 2 m may be a car's rear or
// a motorbike's side. The odds of a reading are the sums over all classes, times the density of the course:
//   course   an object moves along its length. Across, its velocity has a standard deviation of 0.3 m/s and a tenth of its speed, beside
//            the stated ones of velocity and axis. One velocity in a hundred is any, so that the course alone never outweighs everything.
// The track is read anew when the other reading is the more probable one. The point that it follows, its motion and the outline stay.
// All of it is a function of the present track, so that no odds are carried along.
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

// Returns whether the configuration lets tracks choose: then observations count in either reading.
inline bool chooses_class(const config::TrackerConfig& config) { return config.classes.size() >= 2; }

// Returns the logarithm of the odds of the other reading of a track with a known heading, with a choice of classes.
double log_odds_of_other_reading(const Track& track, const config::TrackerConfig& config,
                                 const estimators::Estimator& estimator, const SeenSpan* span = nullptr);

// Chooses reading and class of the object by its sizes so far, and by this span, which the extent does not contain yet. Without
// configured classes, nothing changes.
void choose_class(Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                  const SeenSpan* span = nullptr);

}  // namespace ttf::fusion::tracks::parts
