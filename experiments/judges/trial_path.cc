#include "experiments/judges/trial_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "experiments/judges/riccati_steps.h"

namespace ttf::experiments::judges {
namespace {

double to_seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

// A measurement's instant, as its age at the use: the newest one that the use rests on, and older ones by rounds.
struct Window {
  std::int64_t newest = 0, oldest = 0;
  double variance = 0.0;
};

std::vector<Window> windows_at(const Round& round, Duration use) {
  std::vector<Window> windows;
  for (const Sighting& one : round.sightings) {
    const std::int64_t behind = (use - one.known).ns, length = round.length.ns;
    const std::int64_t since = (behind % length + length) % length;  // it is known
    const std::int64_t delay = (one.known - one.measured).ns;
    windows.push_back({delay + std::max<std::int64_t>(since - one.within.ns, 0), delay + since, one.variance});
  }
  return windows;
}

// A piece of the path: u = sum of c s^i, s seconds behind its older end.
struct Piece {
  std::int64_t newer = 0, older = 0;  // ages
  std::array<double, 4> c{};

  double at(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
  double square(double s) const { return at(s) * at(s); }
  // Returns the largest u^2 of these ages, which need not lie in the piece.
  double largest_square(std::int64_t from, std::int64_t to) const {
    const double low = to_seconds(older - std::min(to, older)), high = to_seconds(older - std::max(from, newer));
    double largest = std::max(square(low), square(high));
    const auto look = [&](double s) {
      if (s > low && s < high) largest = std::max(largest, square(s));
    };
    const double a = 3.0 * c[3], b = c[2], root = b * b - a * c[1];  // a s^2 + 2 b s + c1 = 0
    if (root < 0.0) return largest;
    const double sum = -(b + std::copysign(std::sqrt(root), b));
    if (a != 0.0) look(sum / a);
    if (sum != 0.0) look(c[1] / sum);
    return largest;
  }
};

template <int K> class TrialPath {
 public:
  using Vector = Eigen::Matrix<double, K, 1>;

  TrialPath(const std::vector<Window>& windows, std::int64_t round, double density)
      : windows_(windows), round_(round), density_(density) {
    set_events();
  }

  // Returns the bound for the error of l' x at the use.
  double bound(const Vector& l) {
    pieces_.clear();
    const double value = l.dot(follow(l));
    double cost = energy_;
    for (const Window& window : windows_) cost += information(window);
    return value * value / cost;
  }

 private:
  // A measurement, and the covariance behind it.
  struct Event {
    std::int64_t age = 0;
    double variance = 0.0;
    Square<K> p = Square<K>::Zero();
  };

  // Events of one round repeat; newer ones come once.
  void set_events() {
    std::int64_t repeats = 0;
    for (const Window& one : windows_) repeats = std::max(repeats, one.newest);
    for (const Window& one : windows_) {
      std::int64_t age = one.newest;
      for (; age < repeats; age += round_) once_.push_back({age, one.variance});
      repeating_.push_back({age, one.variance});
    }
    const auto newer = [](const Event& a, const Event& b) { return a.age < b.age; };
    std::stable_sort(once_.begin(), once_.end(), newer);
    std::stable_sort(repeating_.begin(), repeating_.end(), newer);
    Steps<K> steps;
    std::int64_t before = repeats + round_;
    for (auto event = repeating_.rbegin(); event != repeating_.rend(); before = event->age, ++event)
      steps = steps.then(flow(before, event->age)).then(informed<K>(event->variance));
    Square<K> p = periodic(steps);
    before = repeats + round_;
    for (auto* events : {&repeating_, &once_})
      for (auto event = events->rbegin(); event != events->rend(); before = event->age, ++event)
        p = event->p = informed<K>(event->variance).of(flow(before, event->age).of(p));
    at_use_ = flow(before, 0).of(p);
  }

  Steps<K> flow(std::int64_t older, std::int64_t newer) const { return moved<K>(to_seconds(older - newer), density_); }

  // Follows the path from the use backwards. Returns its state at the use.
  Vector follow(const Vector& l) {
    energy_ = 0.0;
    const Vector at_use = at_use_ * l;
    Vector costate = l;
    std::int64_t age = 0;
    for (const Event& event : once_) step(event, event.age, age, costate);
    for (int count = 0; count < kMostRounds; ++count) {
      for (const Event& event : repeating_) step(event, event.age + count * round_, age, costate);
      if (ramp(age, end_) <= kNegligible * at_use.dot(l)) break;
    }
    energy_ += ramp(age, end_);
    return at_use;
  }

  // Goes back to an older event.
  void step(const Event& event, std::int64_t to, std::int64_t& age, Vector& costate) {
    const double dt = to_seconds(to - age);
    const Vector newer = costate;
    if constexpr (K == 2) costate(1) += dt * costate(0);
    end_ = event.p * costate;
    Piece piece{age, to, {end_(0)}};
    if constexpr (K == 1) {
      piece.c[1] = density_ * costate(0);
      energy_ += density_ * dt * costate(0) * costate(0);
    } else {
      piece.c[1] = end_(1);
      piece.c[2] = density_ * costate(1) / 2.0;
      piece.c[3] = -density_ * costate(0) / 6.0;
      energy_ += density_ * dt / 3.0 * (costate(1) * costate(1) + costate(1) * newer(1) + newer(1) * newer(1));
    }
    if (to > age) pieces_.push_back(piece);
    costate(0) -= end_(0) / event.variance;
    age = to;
  }

  // Returns D of the path that begins at rest, ends in this state and has the least D. It takes as long as what
  // follows, or a round. Keeps its piece.
  double ramp(std::int64_t age, const Vector& end) {
    const std::int64_t length = std::max(round_, age);
    const double h = to_seconds(length), u = end(0);
    ramp_ = {age, age + length, {}};
    if constexpr (K == 1) {
      ramp_.c[1] = u / h;
      return u * u / h / density_;
    } else {
      const double v = end(1) * h;
      ramp_.c[2] = (3.0 * u - v) / (h * h);
      ramp_.c[3] = (v - 2.0 * u) / (h * h * h);
      return (12.0 * u * u - 12.0 * u * v + 4.0 * v * v) / (h * h * h) / density_;
    }
  }

  // Returns the most that the window's measurements of all rounds count.
  double information(const Window& window) {
    double sum = 0.0;
    std::size_t first = 0;
    const std::int64_t end = ramp_.older;
    for (std::int64_t by = 0; window.newest + by < end; by += round_) {
      const std::int64_t from = window.newest + by, to = std::min(window.oldest + by, end);
      while (first < pieces_.size() && pieces_[first].older < from) ++first;
      double largest = to > ramp_.newer ? ramp_.largest_square(from, to) : 0.0;
      for (std::size_t i = first; i < pieces_.size() && pieces_[i].newer <= to; ++i)
        largest = std::max(largest, pieces_[i].largest_square(from, to));
      sum += largest;
    }
    return sum / window.variance;
  }

  static constexpr int kMostRounds = 4'000;
  static constexpr double kNegligible = 1e-9;

  const std::vector<Window>& windows_;
  std::int64_t round_;
  double density_;
  std::vector<Event> once_, repeating_;  // the newest first
  Square<K> at_use_;
  std::vector<Piece> pieces_;  // the newest first
  Piece ramp_;
  Vector end_;
  double energy_ = 0.0;
};

// The mean of a prediction over h is that of x + t v: by the sum of two functionals, (1, h/2) and (0, h/sqrt(12)).
template <int K> double bounded(const std::vector<Window>& windows, std::int64_t length, double density, double h) {
  TrialPath<K> path(windows, length, density);
  if constexpr (K == 1) {
    return path.bound(Eigen::Matrix<double, 1, 1>{1.0}) + density * h / 2.0;
  } else {
    double sum = path.bound({1.0, h / 2.0});
    if (h > 0.0) sum += path.bound({0.0, h / std::sqrt(12.0)});
    return sum + density * h * h * h / 12.0;
  }
}

}  // namespace

double bounded_mean_error(const Round& round, Motion motion, double density) {
  constexpr double kRounding = 1e-9;
  double sum = 0.0;
  for (const Duration use : round.uses) {
    const std::vector<Window> windows = windows_at(round, use);
    const double h = round.held.seconds();
    sum += motion == Motion::kRandomWalk ? bounded<1>(windows, round.length.ns, density, h)
                                         : bounded<2>(windows, round.length.ns, density, h);
  }
  return (1.0 - kRounding) * sum / static_cast<double>(round.uses.size());
}

}  // namespace ttf::experiments::judges
