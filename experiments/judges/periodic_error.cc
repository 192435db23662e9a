#include "experiments/judges/periodic_error.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/check.h"
#include "experiments/judges/riccati_steps.h"

namespace ttf::experiments::judges {
namespace {

std::int64_t within_round(std::int64_t ns, std::int64_t round) { return (ns % round + round) % round; }

template <int K> class Recursion {
 public:
  Recursion(const Round& round, double density) : round_(round), length_(round.length.ns) {
    for (const Sighting& sighting : round.sightings) {
      measured_.push_back(sighting.measured.ns);
      updates_.push_back(informed<K>(sighting.variance));
    }
    set_boundaries();
    for (std::size_t i = 0; i < boundaries_.size(); ++i)
      flows_.push_back(moved<K>(static_cast<double>(end(i) - boundaries_[i]) * 1e-9, density));
    set_periodic();
  }

  // Returns the covariance of the prediction to a use.
  Square<K> at(std::int64_t use) const {
    std::int64_t from = use;  // all that is measured before is known
    std::vector<std::int64_t> unknown;
    for (std::size_t s = 0; s < measured_.size(); ++s) {
      const std::int64_t behind = use - round_.sightings[s].known.ns;
      const std::int64_t rounds = (behind - within_round(behind, length_)) / length_;
      unknown.push_back(measured_[s] + (rounds + 1) * length_);
      from = std::min(from, unknown.back());
    }
    std::size_t i = index_of(from);
    Square<K> p = before_[i];
    for (std::int64_t now = from;; now += end(i) - boundaries_[i], i = (i + 1) % boundaries_.size()) {
      for (std::size_t s = 0; s < measured_.size(); ++s)
        if (within_round(measured_[s], length_) == boundaries_[i] && now < unknown[s]) p = updates_[s].of(p);
      if (now >= use) return p;
      p = flows_[i].of(p);
    }
  }

 private:
  std::int64_t end(std::size_t i) const { return i + 1 < boundaries_.size() ? boundaries_[i + 1] : length_; }
  std::size_t index_of(std::int64_t at) const {
    const auto found = std::lower_bound(boundaries_.begin(), boundaries_.end(), within_round(at, length_));
    return static_cast<std::size_t>(found - boundaries_.begin());
  }

  void set_boundaries() {
    boundaries_ = {0};
    for (const std::int64_t at : measured_) boundaries_.push_back(within_round(at, length_));
    for (const Duration use : round_.uses) boundaries_.push_back(within_round(use.ns, length_));
    std::sort(boundaries_.begin(), boundaries_.end());
    boundaries_.erase(std::unique(boundaries_.begin(), boundaries_.end()), boundaries_.end());
  }

  // Finds the periodic covariance at the first boundary, and from there at all of them, before their measurements.
  void set_periodic() {
    Steps<K> rounds;
    for (std::size_t i = 0; i < boundaries_.size(); ++i) {
      for (std::size_t s = 0; s < measured_.size(); ++s)
        if (within_round(measured_[s], length_) == boundaries_[i]) rounds = rounds.then(updates_[s]);
      rounds = rounds.then(flows_[i]);
    }
    Square<K> p = periodic(rounds);
    for (std::size_t i = 0; i < boundaries_.size(); ++i) {
      before_.push_back(p);
      for (std::size_t s = 0; s < measured_.size(); ++s)
        if (within_round(measured_[s], length_) == boundaries_[i]) p = updates_[s].of(p);
      p = flows_[i].of(p);
    }
  }

  const Round& round_;
  std::int64_t length_;
  std::vector<std::int64_t> measured_, boundaries_;
  std::vector<Steps<K>> updates_, flows_;  // by sighting; from boundary to boundary
  std::vector<Square<K>> before_;          // by boundary
};

// The mean over h of the error that is predicted from p: (1, t) p (1, t)' + q t^3 / 3, or p + q t.
template <int K> double held_error(const Square<K>& p, double density, double h) {
  if constexpr (K == 1)
    return p(0, 0) + density * h / 2.0;
  else
    return p(0, 0) + h * p(0, 1) + h * h / 3.0 * p(1, 1) + density * h * h * h / 12.0;
}

template <int K> std::vector<double> errors(const Round& round, double density) {
  const Recursion<K> recursion(round, density);
  std::vector<double> found;
  for (const Duration use : round.uses)
    found.push_back(held_error<K>(recursion.at(use.ns), density, round.held.seconds()));
  return found;
}

}  // namespace

std::vector<double> errors_at_uses(const Round& round, Motion motion, double density) {
  TTF_CHECK(round.length > Duration{} && !round.sightings.empty() && density > 0.0, "a round of {} ns, density {}",
            round.length.ns, density);
  for (const Sighting& one : round.sightings) TTF_CHECK(one.within == Duration{}, "a window of {} ns", one.within.ns);
  return motion == Motion::kRandomWalk ? errors<1>(round, density) : errors<2>(round, density);
}

double mean_error(const Round& round, Motion motion, double density) {
  const std::vector<double> errors = errors_at_uses(round, motion, density);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

}  // namespace ttf::experiments::judges
