// Many constant-velocity filters at once, for the tracks of a crowd or for replications. Each operation handles
// four filters (lanes.h), in consecutive blocks of memory. Each filter gives the result that it gives alone.
//
//   Batch<Axes> batch(1000);  batch.set(i, prior);  batch.predict(step);  z.set(i, measurement);  batch.update(z);
//
// Axes (axes.h) is for independent axes, Joint (joint.h) for any covariance. Laws, tested:
//   L1 Alone    filter i is filters::Kalman with motion::ConstantVelocity and sensors::Position, bit for bit
//   L2 Unseen   a filter without a measurement keeps its bits
//   L3 NoHeap   nothing allocates after construction
#pragma once

#include <cstddef>
#include <vector>

#include "core/check.h"
#include "fusion/batch/axes.h"
#include "fusion/batch/joint.h"
#include "fusion/filters/ldl.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::batch {

// The measurements of a batch, at most one for each filter.
class Positions {
 public:
  explicit Positions(std::size_t count) : blocks_((count + kLanes - 1) / kLanes) {
    for (Position<Lanes>& block : blocks_) block.r_xx = block.r_yy = Lanes{} + 1.0;
  }
  // Sets a measurement; r is positive definite.
  void set(std::size_t i, const sensors::Measurement<2>& z) {
    Position<Lanes>& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    block.x[lane] = z.z(0), block.y[lane] = z.z(1);
    block.r_xx[lane] = z.r(0, 0), block.r_xy[lane] = z.r(1, 0), block.r_yy[lane] = z.r(1, 1);
    block.seen[lane] = -1;
  }
  void clear(std::size_t i) { blocks_[i / kLanes].seen[i % kLanes] = 0; }
  const std::vector<Position<Lanes>>& blocks() const { return blocks_; }

 private:
  std::vector<Position<Lanes>> blocks_;
};

inline void put(Axes<Lanes>& block, std::size_t lane, const linear::Gaussian<4>& state) {
  for (int i = 0; i < 2; ++i) {
    auto& a = block.axis[i];
    a.x[lane] = state.x(i), a.v[lane] = state.x(i + 2);
    a.p_xx[lane] = state.p(i, i), a.p_xv[lane] = state.p(i, i + 2), a.p_vv[lane] = state.p(i + 2, i + 2);
    for (const int other : {1 - i, 3 - i})
      TTF_CHECK(state.p(i, other) == 0.0 && state.p(i + 2, other) == 0.0, "the axes are correlated");
  }
}
inline void put(Joint<Lanes>& block, std::size_t lane, const linear::Gaussian<4>& state) {
  for (int c = 0; c < 4; ++c) {
    block.x[c][lane] = state.x(c);
    for (int r = 0; r <= c; ++r) block.p[Joint<Lanes>::at(r, c)][lane] = state.p(r, c);
  }
}

inline linear::Gaussian<4> taken(const Axes<Lanes>& block, std::size_t lane) {
  linear::Gaussian<4> state;
  for (int i = 0; i < 2; ++i) {
    const auto& a = block.axis[i];
    state.x(i) = a.x[lane], state.x(i + 2) = a.v[lane];
    state.p(i, i) = a.p_xx[lane], state.p(i + 2, i + 2) = a.p_vv[lane];
    state.p(i, i + 2) = state.p(i + 2, i) = a.p_xv[lane];
  }
  return state;
}
inline linear::Gaussian<4> taken(const Joint<Lanes>& block, std::size_t lane) {
  linear::Gaussian<4> state;
  for (int c = 0; c < 4; ++c) {
    state.x(c) = block.x[c][lane];
    for (int r = 0; r <= c; ++r) state.p(r, c) = state.p(c, r) = block.p[Joint<Lanes>::at(r, c)][lane];
  }
  return state;
}

template <template <class> class Form> class Batch {
 public:
  explicit Batch(std::size_t count) : count_(count), blocks_((count + kLanes - 1) / kLanes) {}

  std::size_t size() const { return count_; }
  void set(std::size_t i, const linear::Gaussian<4>& state) { put(blocks_[i / kLanes], i % kLanes, state); }
  linear::Gaussian<4> state(std::size_t i) const { return taken(blocks_[i / kLanes], i % kLanes); }

  void predict(const Step& step) {
    for (Form<Lanes>& block : blocks_) batch::predict(block, step);
  }
  void update(const Positions& z) {
    check_size(z);
    for (std::size_t b = 0; b < blocks_.size(); ++b) batch::update(blocks_[b], z.blocks()[b]);
  }
  // Predicts and updates in one pass through memory.
  void step(const Step& by, const Positions& z) {
    check_size(z);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      batch::predict(blocks_[b], by);
      batch::update(blocks_[b], z.blocks()[b]);
    }
  }

 private:
  void check_size(const Positions& z) const {
    TTF_CHECK(z.blocks().size() == blocks_.size(), "{} blocks of measurements of {}", z.blocks().size(),
              blocks_.size());
  }

  std::size_t count_;
  std::vector<Form<Lanes>> blocks_;
};

}  // namespace ttf::fusion::batch
