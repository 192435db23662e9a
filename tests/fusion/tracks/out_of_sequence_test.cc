// Rewinding for one late measurement, against the published closed forms: algorithms A (exact), B and C of
// Bar-Shalom, "Update with Out-of-Sequence Measurements in Tracking: Exact Solution", IEEE TAES 38(3), 2002.
// They are first checked against the paper's printed numbers.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

// The state at k after the measurement at k, with the values that the update keeps.
struct AtK {
  Dense x, nu, p, prior_p, h, s;
};
// The late measurement z at tau <= t(k): its h and r, the way back fb = F(tau, k), the noise q = Q(k, tau).
struct Late {
  Dense z, h, r, fb, q;
};
struct Updated {
  Dense x, p, w, p_tau, mse;  // mse: the true error covariance; p may differ
};

AtK update_at_k(const Dense& prior_x, const Dense& prior_p, const Dense& z, const Dense& h, const Dense& r) {
  AtK k;
  k.prior_p = prior_p;
  k.h = h;
  k.s = h * prior_p * h.transpose() + r;
  k.nu = z - h * prior_x;
  const Dense gain = prior_p * h.transpose() * inverse(k.s);
  k.x = prior_x + gain * k.nu;
  k.p = prior_p - gain * k.s * gain.transpose();
  return k;
}

Updated algorithm(char which, const AtK& k, const Late& late) {
  const Dense s_inverse = inverse(k.s), b = k.h.transpose() * s_inverse * k.h;
  const Dense p_xv = late.q - k.prior_p * b * late.q;
  Updated u;
  Dense x_tau = late.fb * k.x;
  Dense c = (k.p - p_xv) * late.fb.transpose() * late.h.transpose();
  const Dense true_c = c;
  if (which == 'A') {
    x_tau = late.fb * (k.x - late.q * k.h.transpose() * s_inverse * k.nu);
    const Dense p_vv = late.q - late.q * b * late.q;
    u.p_tau = late.fb * (k.p + p_vv - p_xv - p_xv.transpose()) * late.fb.transpose();
  } else if (which == 'B') {
    u.p_tau = late.fb * (k.p + late.q - p_xv - p_xv.transpose()) * late.fb.transpose();
  } else {
    u.p_tau = late.fb * k.p * late.fb.transpose();
    c = k.p * late.fb.transpose() * late.h.transpose();
  }
  const Dense s = late.h * u.p_tau * late.h.transpose() + late.r;
  u.w = c * inverse(s);
  u.x = k.x + u.w * (late.z - late.h * x_tau);
  u.p = k.p - u.w * s * u.w.transpose();
  const Dense e =
      which == 'A' ? u.p_tau : Dense(late.fb * (k.p + late.q - p_xv - p_xv.transpose()) * late.fb.transpose());
  u.mse = k.p - u.w * true_c.transpose() - true_c * u.w.transpose() +
          u.w * (late.h * e * late.h.transpose() + late.r) * u.w.transpose();
  return u;
}

Dense scalar(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

// Scalar random walk with unit measurement noise and P(k-1|k-1) = 1, the late measurement half-way.
Updated random_walk(char which, double q) {
  const AtK k = update_at_k(scalar(0), scalar(1.0 + q), scalar(1), scalar(1), scalar(1));
  return algorithm(which, k, {scalar(0.5), scalar(1), scalar(1), scalar(1), scalar(0.5 * q)});
}

TEST(OutOfSequence, ThePaperTableI) {
  const struct {
    char which;
    double p_tau, w, p, mse;
  } rows[] = {{'A', 0.750, 0.286, 0.524, 0.524}, {'B', 0.833, 0.273, 0.530, 0.530}, {'C', 0.667, 0.400, 0.400, 0.560}};
  for (const auto& row : rows) {
    const Updated u = random_walk(row.which, 1.0);
    EXPECT_NEAR(u.p_tau(0, 0), row.p_tau, 5e-4) << row.which;
    EXPECT_NEAR(u.w(0, 0), row.w, 5e-4) << row.which;
    EXPECT_NEAR(u.p(0, 0), row.p, 5e-4) << row.which;
    EXPECT_NEAR(u.mse(0, 0), row.mse, 5e-4) << row.which;
  }
}

TEST(OutOfSequence, ThePaperTableII) {
  EXPECT_NEAR(random_walk('A', 1.0).p(0, 0), 0.5238, 5e-5);
  EXPECT_NEAR(random_walk('B', 1.0).p(0, 0), 0.5303, 5e-5);
  EXPECT_NEAR(random_walk('C', 1.0).p(0, 0), 0.4000, 5e-5);
  EXPECT_NEAR(random_walk('C', 1.0).mse(0, 0), 0.5600, 5e-5);
  EXPECT_NEAR(random_walk('A', 0.05).p(0, 0), 0.3469, 5e-5);
  EXPECT_NEAR(random_walk('B', 0.05).p(0, 0), 0.3469, 5e-5);
  EXPECT_NEAR(random_walk('C', 0.05).p(0, 0), 0.3387, 5e-5);
  EXPECT_NEAR(random_walk('C', 0.05).mse(0, 0), 0.3470, 5e-5);
}

// Taking both in order, as the tracker does after rewinding, is algorithm A's exact solution.
TEST(OutOfSequence, InOrderProcessingIsAlgorithmA) {
  const auto update = [](double p) { return p / (p + 1.0); };
  for (const double q : {0.05, 1.0, 4.0})
    EXPECT_NEAR(update(update(1.0 + 0.5 * q) + 0.5 * q), random_walk('A', q).p(0, 0), 1e-15) << "q " << q;
}

// One object through the tracker's history:
//
//      list 0        list 1 (late)     list 2
//   ----x---------------x-----------------x------> measured        arrival: 0, 2, 1
//      0 ms           tau             1000 ms
//
// Against algorithm A, which never rewinds: the same estimate by entirely different steps.
TEST(OutOfSequence, RewindingEqualsAlgorithmA) {
  config::TrackerConfig config;
  config.gate_probability = 0.999999;
  config.initial_velocity_sigma = 3.0;
  config.process_noise = 2.0;
  for (const std::int64_t tau : {0, 1, 250, 500, 750, 999}) {
    const sensors::Observation first = position(10.0, 4.0, 0.3), between = position(10.4, 4.3, 0.2),
                               last = position(11.5, 3.6, 0.4);
    Timeline timeline(config, 4);
    ASSERT_EQ(timeline.insert(list_of(0, 0, at_ms(0), {first}).view()), Timeline::Insertion::kInOrder);
    ASSERT_EQ(timeline.insert(list_of(0, 1, at_ms(1000), {last}).view()), Timeline::Insertion::kInOrder);
    ASSERT_EQ(timeline.insert(list_of(1, 0, at_ms(tau), {between}).view()), Timeline::Insertion::kLate);
    ASSERT_EQ(timeline.current().tracks.size(), 1u);
    const estimators::Cartesian rewound = seen_as(timeline.current().tracks[0].estimate);

    const config::MotionModel motion = config.motion;
    const double whole = 1.0, back = 1.0 - 1e-3 * static_cast<double>(tau);
    const estimators::Cartesian start = seen_as(timeline.estimator().initial(first));
    const Dense f = transition(motion, whole).topLeftCorner<4, 4>();
    const Dense prior_p = f * Dense(start.p.topLeftCorner<4, 4>()) * f.transpose() +
                          Dense(driving_noise(motion, config.process_noise, whole).topLeftCorner<4, 4>());
    Dense h = Eigen::MatrixXd::Zero(2, 4);
    h(0, 0) = h(1, 1) = 1.0;
    const AtK k = update_at_k(f * Dense(start.x.head<4>()), prior_p, Dense(last.z.head<2>()), h,
                              Dense(last.r.topLeftCorner<2, 2>()));
    const Late late{Dense(between.z.head<2>()), h, Dense(between.r.topLeftCorner<2, 2>()),
                    Dense(transition(motion, -back).topLeftCorner<4, 4>()),
                    Dense(driving_noise(motion, config.process_noise, back).topLeftCorner<4, 4>())};
    const Updated a = algorithm('A', k, late), c = algorithm('C', k, late);
    EXPECT_LT((Dense(rewound.x.head<4>()) - a.x).norm(), 1e-10) << "tau " << tau;
    EXPECT_LT((Dense(rewound.p.topLeftCorner<4, 4>()) - a.p).norm(), 1e-10) << "tau " << tau;
    // The comparison can fail: the approximation differs, and is too sure of itself.
    if (tau > 1 && tau < 900) {
      EXPECT_GT((Dense(rewound.x.head<4>()) - c.x).norm(), 1e-3) << "tau " << tau;
      EXPECT_GT(rewound.p(2, 2), c.p(2, 2) + 1e-3) << "tau " << tau;
    }
  }
}

}  // namespace
}  // namespace ttf::fusion::tracks
