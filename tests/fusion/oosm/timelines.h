// Motions that compose, measurements drawn for them, and the orders in which they may arrive.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/random.h"
#include "fusion/oosm/method.h"
#include "tests/fusion/textbook.h"

namespace ttf::fusion::oosm {

// White noise of density q in continuous time: on the first's position, on the acceleration of each axis of
// the second.
struct RandomWalk {
  double q = 1.0;
  linear::LinearStep<1> step(double dt) const { return {linear::Matrix<1>(1.0), linear::Matrix<1>(q * dt)}; }
};

template <int Axes> struct ConstantVelocity {
  double q = 1.0;
  linear::LinearStep<2 * Axes> step(double dt) const {  // position, velocity, position, ...
    linear::LinearStep<2 * Axes> step;
    for (int i = 0; i < 2 * Axes; i += 2) {
      step.f(i, i + 1) = dt;
      step.q.template block<2, 2>(i, i) << q * dt * dt * dt / 3, q * dt * dt / 2, q * dt * dt / 2, q * dt;
    }
    return step;
  }
};

constexpr GlobalTime after_ms(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }
constexpr Stamp stamp_at(GlobalTime time, std::uint8_t sensor = 0, std::uint32_t sequence = 0) {
  return {time, {SensorId{sensor}, sequence}};
}

template <int N, int M> struct Event {
  Stamp stamp;
  linear::LinearMeasurement<N, M> measurement;
};
template <int N, int M> using Timeline = std::vector<Event<N, M>>;

template <int Rows, int Columns> linear::Matrix<Rows, Columns> drawn(RandomStream& stream) {
  linear::Matrix<Rows, Columns> result;
  for (int i = 0; i < Rows * Columns; ++i) result.data()[i] = stream.normal();
  return result;
}

template <int N> linear::Gaussian<N> drawn_prior(RandomStream& stream) {
  const linear::Matrix<N> root = drawn<N, N>(stream);
  return {drawn<N, 1>(stream), linear::Matrix<N>(root * root.transpose() + linear::Matrix<N>::Identity())};
}

// Draws `count` measurements in order, of two sensors. They are 1 ns to 200 ms apart, or (one in eight) at
// the same instant. All of H and R is drawn.
template <int N, int M> Timeline<N, M> drawn_timeline(RandomStream& stream, int count) {
  Timeline<N, M> events(static_cast<std::size_t>(count));
  GlobalTime time{};
  std::uint32_t sequence = 0;
  for (auto& event : events) {
    if (stream.integer(0, 7) != 0) time += Duration::nanoseconds(stream.integer(1, 200'000'000));
    const auto sensor = static_cast<std::uint8_t>(stream.integer(0, 1));
    event.stamp = stamp_at(time, sensor, sequence++);
    event.measurement.z = drawn<M, 1>(stream);
    event.measurement.h = drawn<M, N>(stream);
    const linear::Matrix<M> root = drawn<M, M>(stream);
    event.measurement.r = root * root.transpose() + 0.1 * linear::Matrix<M>::Identity();
  }
  std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return events;
}

// Each comes behind as many as `most` later ones.
template <int N, int M> Timeline<N, M> delayed(RandomStream& stream, const Timeline<N, M>& events, int most) {
  std::vector<std::pair<std::int64_t, std::size_t>> arrivals;
  for (std::size_t i = 0; i < events.size(); ++i)
    arrivals.emplace_back(static_cast<std::int64_t>(i) + stream.integer(0, most), i);
  std::sort(arrivals.begin(), arrivals.end());
  Timeline<N, M> result;
  for (const auto& arrival : arrivals) result.push_back(events[arrival.second]);
  return result;
}

// The last but `lag` comes last.
template <int N, int M> Timeline<N, M> one_late(Timeline<N, M> events, int lag) {
  std::rotate(events.end() - 1 - lag, events.end() - lag, events.end());
  return events;
}

// Takes all in the given order. A late one is announced before anything later is taken.
template <Method X, int N, int M> std::vector<Taken> take_all(X& method, const Timeline<N, M>& arrivals) {
  std::vector<Taken> taken;
  for (auto event = arrivals.begin(); event != arrivals.end(); ++event) {
    for (auto later = event + 1; later != arrivals.end(); ++later)
      if (later->stamp < event->stamp) method.announce(later->stamp);
    taken.push_back(method.take(event->stamp, event->measurement));
  }
  return taken;
}

// The textbook's filter, in order (tests/fusion/textbook.h).
template <int N, int M, Motion<N> Model>
linear::Gaussian<N> in_order(const Model& motion, linear::Gaussian<N> state, Timeline<N, M> events) {
  std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  GlobalTime time{};
  for (const auto& event : events) {
    advance<N>(state, motion, event.stamp.time() - time);
    update<N, M>(state, event.measurement);
    time = event.stamp.time();
  }
  return state;
}

template <int N> double relative_difference(const linear::Gaussian<N>& a, const linear::Gaussian<N>& b) {
  return std::max((a.x - b.x).norm() / b.x.norm(), (a.p - b.p).norm() / b.p.norm());
}

template <int N> bool same_bits(const linear::Gaussian<N>& a, const linear::Gaussian<N>& b) {
  return a.x == b.x && a.p == b.p;  // no zeros of either sign and no NaN are at stake
}

// Positions once a second, the last late measurement from the middle of an interval.
inline Timeline<2, 1> positions(int lag) {
  const linear::LinearMeasurement<2, 1> position{linear::Vector<1>(0.0), linear::Matrix<1, 2>(1.0, 0.0),
                                                 linear::Matrix<1>(0.5)};
  Timeline<2, 1> arrivals;
  for (int i = 1; i <= 12; ++i) arrivals.push_back({stamp_at(after_ms(1000 * i)), position});
  arrivals.push_back({stamp_at(after_ms(12'500 - 1000 * lag), 1), position});
  return arrivals;
}

}  // namespace ttf::fusion::oosm
