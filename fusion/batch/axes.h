// Constant velocity with independent axes. The covariance is block-diagonal and stays so if r_xy = 0 in every
// measurement. Two filters of two states need half the arithmetic of joint.h.
//
// The operations are those of filters::Kalman with motion::ConstantVelocity and sensors::Position, in their
// order, without the terms that are zero. So every number equals that filter's bit for bit, except for the sign
// of a zero.
#pragma once

#include "fusion/batch/step.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::batch {

template <class V> struct Axes {
  struct Axis {
    V x{}, v{};  // [m], [m/s]
    V p_xx{}, p_xv{}, p_vv{};
  };
  Axis axis[2];
};

template <class V> [[gnu::always_inline]] inline void predict(Axes<V>& state, const Step& step) {
  motion::unrolled<2>([&](int i) {
    auto& a = state.axis[i];
    const V moved = a.p_xv + step.dt * a.p_vv;
    a.x += step.dt * a.v;
    a.p_xx = (a.p_xx + step.dt * a.p_xv) + step.dt * moved + step.q_xx;
    a.p_xv = moved + step.q_xv;
    a.p_vv += step.q_vv;
  });
}

// Updates in Joseph form, multiplied out (fusion/filters/correct.h). Returns the NIS, valid in seen lanes only.
template <class V> [[gnu::always_inline]] inline V update(Axes<V>& state, const Position<V>& z) {
  V nis{};
  motion::unrolled<2>([&](auto axis) {
    constexpr int i = axis;
    auto& a = state.axis[i];
    const V nu = (i == 0 ? z.x : z.y) - a.x;
    const V r = i == 0 ? z.r_xx : z.r_yy;
    const V inverse = 1.0 / (a.p_xx + r);
    const V g_x = a.p_xx * inverse, g_v = a.p_xv * inverse;
    const V t_xx = a.p_xx - g_x * a.p_xx, t_xv = a.p_xv - g_x * a.p_xv;
    const V t_vx = a.p_xv - g_v * a.p_xx, t_vv = a.p_vv - g_v * a.p_xv;
    const V e_x = t_xx - g_x * r, e_v = t_vx - g_v * r;
    a.x = select(z.seen, a.x + g_x * nu, a.x);
    a.v = select(z.seen, a.v + g_v * nu, a.v);
    a.p_xx = select(z.seen, t_xx - e_x * g_x, a.p_xx);
    a.p_xv = select(z.seen, t_xv - e_x * g_v, a.p_xv);
    a.p_vv = select(z.seen, t_vv - e_v * g_v, a.p_vv);
    nis += nu * nu * inverse;
  });
  return nis;
}

}  // namespace ttf::fusion::batch
