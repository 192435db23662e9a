// The evidence that measurements give of an object's size, apart from the prior that its extent began with.
//
// An extent N(m, P) that began with the prior N(m0, P0) has gathered the information Y = P^-1 - P0^-1 and y = P^-1 m - P0^-1 m0.
// With another prior N(m1, P1), the same measurements would have given P2 = (P1^-1 + Y)^-1 and m2 = P2 (P1^-1 m1 + y). This is
// exact for linear measurements that stay clear of the bound (fusion/tracks/body/extent.h). Bounded ones count less, or not at all,
// where the prior was sharper. Spans keep the derivative and the gate of the first prior. How well the prior predicted the
// measurements is
//   ln p = -1/2 (ln det P1 - ln det P2 + m1^T P1^-1 m1 - m2^T P2^-1 m2) + a constant that all priors share.
// So sizes decide the class of an object, however many lists measured them, and no list counts twice.
#pragma once

#include "fusion/config/classes.h"
#include "fusion/tracks/body/extent.h"

namespace ttf::fusion::tracks::body {

struct SizeEvidence {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // Y [1/m^2], positive semidefinite
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();     // y [1/m]
};

// Returns what the extent has gathered since it began with this prior. The sizes did not walk (extent_noise is 0 with classes). A
// variance above the prior's counts as no information.
SizeEvidence evidence_of(const Extent& extent, const config::Sizes& began);

// An extent by a prior and evidence, and ln p above.
struct Explained {
  Extent extent;
  double log_likelihood = 0.0;
};
Explained explained(const SizeEvidence& evidence, const config::Sizes& prior);

}  // namespace ttf::fusion::tracks::body
