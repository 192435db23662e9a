// The update of a track by all observations in its gate, with their probabilities given that its object exists: probabilistic
// data association (fusion/association/joint_association.h, fusion/estimators/estimator.h). The constructor allocates all
// storage.
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/association/joint_association.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class JointUpdate {
 public:
  // Without storage unless jpda.
  JointUpdate(const config::TrackerConfig& config, std::size_t max_observations);

  // Updates the estimate of the track, the column-th of its set. With births by existence it updates the existence, too
  // (fusion/tracks/parts/existence.h).
  void update(Track& track, std::size_t column, const sensors::ObservationList& list,
              const association::JointAssociation& joint, const estimators::Estimator& estimator, double visible);

 private:
  config::TrackerConfig config_;
  std::vector<estimators::Explanation> explanations_;
  std::vector<sensors::Observation> explained_;
};

}  // namespace ttf::fusion::tracks::parts
