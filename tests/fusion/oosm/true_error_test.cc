// A method's stated covariance against that of its error, computed without chance
// (tests/fusion/oosm/true_error.h).
#include "tests/fusion/oosm/true_error.h"

#include <gtest/gtest.h>

#include "tests/fusion/oosm/any_methods.h"

namespace ttf::fusion::oosm {
namespace {

linear::Matrix<2> error_of(Kind kind, const Line& motion, const linear::Matrix<2>& prior,
                           const Timeline<2, 1>& arrivals) {
  return true_error(OnLine(kind, motion), motion, prior, arrivals);
}
linear::Matrix<2> said_by(Kind kind, const Line& motion, const linear::Matrix<2>& prior,
                          const Timeline<2, 1>& arrivals) {
  OnLine method(kind, motion);
  method.start(GlobalTime{}, {linear::Vector<2>::Zero(), prior});
  take_all(method, arrivals);
  return method.state().p;
}

// The mean square error of B and C in closed form. x(tau) = F^-1 x lacks the noise v since tau:
//   E = F^-1 [P + Q - Pxv - Pxv'] F'^-1,  Pxz = (P - Pxv) F'^-1 H',  Pxv = Q - P- U Q,
//   M = P - W Pxz' - Pxz W' + W (H E H' + R) W'.
template <class Memory>
linear::Matrix<2> closed_form(const Line& motion, const linear::Matrix<2>& prior, const Timeline<2, 1>& arrivals) {
  linear::Gaussian<2> state{linear::Vector<2>::Zero(), prior};
  GlobalTime time{};
  linear::Matrix<2> predicted, information;
  Memory memory;
  for (std::size_t i = 0; i + 1 < arrivals.size(); ++i) {
    advance<2>(state, motion, arrivals[i].stamp.time() - time);
    time = arrivals[i].stamp.time();
    predicted = state.p;
    const auto& z = arrivals[i].measurement;
    information = z.h.transpose() * (z.h * predicted * z.h.transpose() + z.r).inverse() * z.h;
    memory.corrected(predicted, correct<2, 1>(state, z));
  }
  const auto& [stamp, late] = arrivals.back();
  const linear::LinearStep<2> step = motion.step((time - stamp.time()).seconds());
  const Retrodicted<2> used = memory.retrodict(state, step);
  const linear::Vector<2> w =
      used.cross * late.h.transpose() / (late.h * used.then.p * late.h.transpose() + late.r)(0, 0);

  const linear::Matrix<2> back = step.f.inverse(), pxv = step.q - predicted * information * step.q;
  const linear::Matrix<2> e = back * (state.p + step.q - pxv - pxv.transpose()) * back.transpose();
  const linear::Vector<2> pxz = (state.p - pxv) * back.transpose() * late.h.transpose();
  const linear::Matrix<1> s = late.h * e * late.h.transpose() + late.r;
  return state.p - w * pxz.transpose() - pxz * w.transpose() + w * s * w.transpose();
}

TEST(TrueError, OfBAndCIsTheClosedForm) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream stream({.seed = seed});
    const linear::Matrix<2> prior = drawn_prior<2>(stream).p;
    auto events = drawn_timeline<2, 1>(stream, 8);
    for (std::size_t i = 0; i < 8; ++i) events[i].stamp = stamp_at(after_ms(300 * static_cast<std::int64_t>(i) + 100));
    const auto arrivals = one_late(events, 1);
    for (const double q : {0.1, 4.0, 100.0}) {
      const Line motion{q};
      const linear::Matrix<2> b = closed_form<MemoryB<2>>(motion, prior, arrivals);
      const linear::Matrix<2> c = closed_form<MemoryC<2>>(motion, prior, arrivals);
      EXPECT_LT((error_of(Kind::kB, motion, prior, arrivals) - b).norm(), 1e-10 * b.norm());
      EXPECT_LT((error_of(Kind::kC, motion, prior, arrivals) - c).norm(), 1e-10 * c.norm());
    }
  }
}

TEST(TrueError, IsWhatExactMethodsSayInAnyOrder) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RandomStream stream({.seed = seed});
    const linear::Matrix<2> prior = drawn_prior<2>(stream).p;
    const auto arrivals = delayed(stream, drawn_timeline<2, 1>(stream, 24), 8);
    for (const Kind kind : {Kind::kRewind, Kind::kAugmented, Kind::kClone}) {
      const linear::Matrix<2> error = error_of(kind, Line{2.0}, prior, arrivals);
      EXPECT_LT((said_by(kind, Line{2.0}, prior, arrivals) - error).norm(), 1e-10 * error.norm());
    }
  }
}

// "A few percent" at most; and B, "practically indistinguishable" from A.
TEST(TrueError, OfAl1AndBl1IsALittleAboveTheBest) {
  for (const double q : {0.1, 1.0, 4.0})
    for (int lag = 1; lag <= 5; ++lag) {
      const linear::Matrix<2> prior = linear::Matrix<2>::Identity();
      const double best = error_of(Kind::kRewind, Line{q}, prior, positions(lag)).trace();
      for (const Kind kind : {Kind::kAl1, Kind::kBl1}) {
        const double error = error_of(kind, Line{q}, prior, positions(lag)).trace();
        EXPECT_GE(error, best * (1.0 - 1e-12)) << name_of(kind) << " q " << q << " lag " << lag;
        EXPECT_LT(error, best * 1.05) << name_of(kind) << " q " << q << " lag " << lag;
      }
    }
  for (const double q : {0.1, 1.0, 4.0}) {
    const double a = error_of(Kind::kA, Line{q}, linear::Matrix<2>::Identity(), positions(1)).trace();
    EXPECT_NEAR(error_of(Kind::kB, Line{q}, linear::Matrix<2>::Identity(), positions(1)).trace(), a, 1e-3 * a);
  }
}

TEST(TrueError, OfCIsAboveWhatItSays) {
  const linear::Matrix<2> prior = linear::Matrix<2>::Identity();
  EXPECT_GT(error_of(Kind::kC, Line{4.0}, prior, positions(1)).trace(),
            1.05 * said_by(Kind::kC, Line{4.0}, prior, positions(1)).trace());
}

}  // namespace
}  // namespace ttf::fusion::oosm
