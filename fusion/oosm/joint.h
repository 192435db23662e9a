// The joint normal distribution of the newest state and of some kept earlier ones: the accumulated state
// density (Koch, Govaers: "On Accumulated State Densities with Applications to Out-of-Sequence Measurement
// Processing", IEEE TAES 47(4), 2011). Slots are in any order, so that only the blocks of added and dropped
// states move.
//
// Each slot i has x(i), C(i) = cov(x(i), x(now)), and A(i, j) = cov(x(i), x(j)) for j <= i.
//   keep       the newest state becomes a slot: x(i) = x, C(i) = P, A(i, j) = C(j)'
//   propagate  x <- F x, P <- F P F' + Q, C(i) <- C(i) F'
//   correct    slot a or the newest, G(.) = cov(., x(a)) H', S = L L', V(.) = G(.) L'^-1:
//              x(.) += V(.) L^-1 nu,  cov(i, j) -= V(i) V(j)', for the newest itself in Joseph form (correction.h)
//   insert     a state between two others: below
// A correction costs O(slots^2 n^2 m), the others O(slots n^3).
#pragma once

#include <array>
#include <cstddef>

#include "core/check.h"
#include "fusion/oosm/correction.h"
#include "fusion/oosm/whitening.h"

namespace ttf::fusion::oosm {

// x(tau) = a x(before) + b x(after) + e, with e ~ N(0, q) independent of everything else.
template <int N> struct Bridge {
  linear::Matrix<N> a = linear::Matrix<N>::Zero();
  linear::Matrix<N> b = linear::Matrix<N>::Zero();
  linear::Matrix<N> q = linear::Matrix<N>::Zero();
};

// Returns the bridge of a Markov process between two instants. `first` leads from the earlier one to tau,
// `second` from tau to the later one:
//   b = Q1 F2' (F2 Q1 F2' + Q2)^-1,  a = F1 - b F2 F1,  q = Q1 - b F2 Q1
// (the gain as in Garcia-Fernandez, Yi: "Continuous-discrete multiple target tracking with out-of-sequence
// measurements", IEEE TSP 69, 2021, eq. 36-37). Without noise only the earlier instant counts.
template <int N>
[[gnu::flatten]] Bridge<N> bridge(const linear::LinearStep<N>& first, const linear::LinearStep<N>& second) {
  const linear::Matrix<N> fq = second.f * first.q;
  linear::Matrix<N> whole = second.q;
  whole.noalias() += fq * second.f.transpose();
  const linear::Matrix<N> root = whitening<N>(whole);
  const linear::Matrix<N> half = root * fq;
  Bridge<N> result;
  result.b.noalias() = half.transpose() * root;
  result.a = first.f;
  result.a.noalias() -= result.b * (second.f * first.f);
  result.q = first.q;
  result.q.noalias() -= half.transpose() * half;
  return result;
}

template <int N, int M, int Slots> class Joint {
 public:
  static constexpr int kNow = -1;  // stands for the newest state

  const linear::Gaussian<N>& now() const { return now_; }
  int size() const { return size_; }

  void start(const linear::Gaussian<N>& prior) {
    now_ = prior;
    size_ = 0;
  }

  [[gnu::flatten]] int keep() {
    const int s = room();
    x_[at(s)] = now_.x;
    for (int j = 0; j < s; ++j) block(s, j) = cross_[at(j)].transpose();
    block(s, s) = cross_[at(s)] = now_.p;
    return s;
  }

  [[gnu::flatten]] void propagate(const linear::LinearStep<N>& step) {
    linear::predict<N>(now_, step);
    for (int i = 0; i < size_; ++i) cross_[at(i)] = (cross_[at(i)] * step.f.transpose()).eval();
  }

  [[gnu::flatten]] void correct_now(const linear::LinearMeasurement<N, M>& measurement) {
    const Whitened<N, M> whitened = correct<N, M>(now_, measurement);
    for (int i = 0; i < size_; ++i) gains_[at(i)].noalias() = cross_[at(i)] * whitened.h.transpose();
    correct_slots(whitened.v, whitened.nu);
  }

  [[gnu::flatten]] void correct_slot(int a, const linear::LinearMeasurement<N, M>& measurement) {
    linear::Matrix<M> s = measurement.r;
    s.noalias() += measurement.h * block(a, a) * measurement.h.transpose();
    const linear::Matrix<M> root = whitening<M>(s);
    const linear::Matrix<M, N> h = root * measurement.h;
    const linear::Vector<M> nu = root * (measurement.z - measurement.h * x_[at(a)]);
    for (int i = 0; i < a; ++i) gains_[at(i)].noalias() = block(a, i).transpose() * h.transpose();
    for (int i = a; i < size_; ++i) gains_[at(i)].noalias() = block(i, a) * h.transpose();
    const linear::Matrix<N, M> v = cross_[at(a)].transpose() * h.transpose();
    now_.x.noalias() += v * nu;
    now_.p.noalias() -= v * v.transpose();
    correct_slots(v, nu);
  }

  // Displaces the newest state and the slots `moves(slot)`, all by the same.
  template <class Moves> void displace(const Displacement<N>& displacement, const Moves& moves) {
    displacement.move(now_);
    for (int i = 0; i < size_; ++i) {
      if (!moves(i)) continue;
      x_[at(i)] += displacement.by;
      cross_[at(i)] += displacement.spread;
      for (int j = 0; j <= i; ++j)
        if (moves(j)) block(i, j) += displacement.spread;
    }
  }

  linear::Gaussian<N> kept(int s) const { return {x_[at(s)], between(s, s)}; }
  // Returns the state that insert() would keep.
  [[gnu::flatten]] linear::Gaussian<N> interpolated(int before, int after, const Bridge<N>& bridge) const {
    const linear::Gaussian<N> then = kept(before), later = after == kNow ? now_ : kept(after);
    const linear::Matrix<N> mixed = bridge.b * between(after, before) * bridge.a.transpose();
    linear::Gaussian<N> result;
    result.x = bridge.a * then.x + bridge.b * later.x;
    result.p = bridge.q + bridge.a * then.p * bridge.a.transpose() + bridge.b * later.p * bridge.b.transpose() + mixed +
               mixed.transpose();
    linear::symmetrise<N>(result.p);
    return result;
  }

  // Adds a slot by interpolation between the slot `before` and `after`, a slot or kNow.
  [[gnu::flatten]] int insert(int before, int after, const Bridge<N>& bridge) {
    const int s = room();
    const linear::Gaussian<N>& now = now_;
    const linear::Vector<N>& x_after = after == kNow ? now.x : x_[at(after)];
    const linear::Matrix<N>& cross_after = after == kNow ? now.p : cross_[at(after)];
    x_[at(s)] = bridge.a * x_[at(before)] + bridge.b * x_after;
    cross_[at(s)] = bridge.a * cross_[at(before)] + bridge.b * cross_after;
    for (int j = 0; j < s; ++j) block(s, j) = bridge.a * between(before, j) + bridge.b * between(after, j);
    const linear::Matrix<N>& with_after = after == kNow ? cross_[at(s)] : block(s, after);
    linear::Matrix<N> p = bridge.q + bridge.a * block(s, before).transpose() + bridge.b * with_after.transpose();
    linear::symmetrise<N>(p);
    block(s, s) = p;
    return s;
  }

  // Drops a slot; the last slot takes its place.
  void drop(int s) {
    TTF_CHECK(s >= 0 && s < size_, "slot {} of {}", s, size_);
    const int last = --size_;
    if (s == last) return;
    x_[at(s)] = x_[at(last)];
    cross_[at(s)] = cross_[at(last)];
    for (int j = 0; j < s; ++j) block(s, j) = block(last, j);
    for (int i = s + 1; i < last; ++i) block(i, s) = block(last, i).transpose();
    block(s, s) = block(last, last);
  }

 private:
  static constexpr std::size_t kBlocks = static_cast<std::size_t>(Slots) * (Slots + 1) / 2;

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static std::size_t at(int i, int j) { return at(i) * (at(i) + 1) / 2 + at(j); }
  linear::Matrix<N>& block(int i, int j) { return blocks_[at(i, j)]; }

  // Returns cov(x(i), x(j)); i is a slot or kNow, j a slot.
  linear::Matrix<N> between(int i, int j) const {
    linear::Matrix<N> result;
    if (i == kNow)
      result = cross_[at(j)].transpose();
    else if (i >= j)
      result = blocks_[at(i, j)];
    else
      result = blocks_[at(j, i)].transpose();
    return result;
  }

  int room() {
    TTF_CHECK(size_ < Slots, "all {} slots are taken", Slots);
    return size_++;
  }

  // Corrects the slots; their V is in gains_.
  [[gnu::flatten]] void correct_slots(const linear::Matrix<N, M>& now, const linear::Vector<M>& nu) {
    for (int i = 0; i < size_; ++i) {
      const linear::Matrix<N, M>& v = gains_[at(i)];
      x_[at(i)].noalias() += v * nu;
      cross_[at(i)].noalias() -= v * now.transpose();
      for (int j = 0; j <= i; ++j) block(i, j).noalias() -= v * gains_[at(j)].transpose();
    }
  }

  linear::Gaussian<N> now_;
  int size_ = 0;
  std::array<linear::Vector<N>, Slots> x_{};
  std::array<linear::Matrix<N>, Slots> cross_{};
  std::array<linear::Matrix<N>, kBlocks> blocks_{};
  std::array<linear::Matrix<N, M>, Slots> gains_{};  // for the current correction
};

}  // namespace ttf::fusion::oosm
