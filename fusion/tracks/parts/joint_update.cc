#include "fusion/tracks/parts/joint_update.h"

#include <algorithm>

#include "fusion/tracks/body/reading.h"
#include "fusion/tracks/parts/classes.h"
#include "fusion/tracks/parts/existence.h"
#include "fusion/tracks/parts/referral.h"

namespace ttf::fusion::tracks::parts {

JointUpdate::JointUpdate(const config::TrackerConfig& config, std::size_t max_observations) : config_(config) {
  if (config.association != config::Association::kJpda) return;
  explanations_.reserve(max_observations + 1);
  explained_.reserve(max_observations);
}

void JointUpdate::update(Track& track, std::size_t column, const sensors::ObservationList& list,
                         const association::JointAssociation& joint, const estimators::Estimator& estimator,
                         double visible) {
  const double unseen = joint.none_of_column(column) * exists_unseen(track.existence, config_, visible);
  double exists = unseen;
  for (const association::JointAssociation::Shared& shared : joint.of_column(column)) exists += shared.probability;
  if (!(exists > 0.0)) return;  // a long lost track without any observation
  explanations_.clear();
  explained_.clear();
  explanations_.push_back({nullptr, unseen / exists});
  for (const association::JointAssociation::Shared& shared : joint.of_column(column)) {
    const sensors::Observation& z = list.observations[static_cast<std::size_t>(shared.row)];
    const auto other = chooses_class(config_) ? body::better_reading(track, estimator, z) : std::nullopt;
    explained_.push_back(referred(track, estimator, other ? *other : z));
    explanations_.push_back({&explained_.back(), shared.probability / exists});
  }
  if (explanations_.size() > 1) estimator.update(track.estimate, explanations_);
  if (config_.birth == config::Birth::kExistence) track.existence = std::min(1.0, exists);
}

}  // namespace ttf::fusion::tracks::parts
