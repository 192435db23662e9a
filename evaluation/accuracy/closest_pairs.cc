#include "evaluation/accuracy/closest_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ttf::evaluation::accuracy {
namespace {

constexpr std::size_t kFew = 1024;  // pairs, up to which trying all is cheaper

struct Candidate {
  double distance;
  TruthPair pair;
};

class Candidates {
 public:
  Candidates(std::span<const PlanePosition> truth, std::span<const PlanePosition> estimates, double gate_m)
      : truth_(truth), estimates_(estimates), gate_(gate_m) {}

  void try_all() {
    for (std::size_t t = 0; t < truth_.size(); ++t)
      for (std::size_t e = 0; e < estimates_.size(); ++e) try_one(t, e);
  }

  // Sorts the estimates into squares of the gate's size, and tries those around each truth. Rounding moves a position
  // by half of a square. Beyond that, only equal positions are within the gate. So pairs are at most two squares apart.
  void try_near() {
    struct Place {
      double column, row;
      std::size_t estimate;
    };
    const auto square = [this](double position) { return std::floor(position / gate_); };
    const auto before = [](const Place& a, const Place& b) {
      return std::tie(a.column, a.row, a.estimate) < std::tie(b.column, b.row, b.estimate);
    };
    std::vector<Place> places;
    for (std::size_t e = 0; e < estimates_.size(); ++e)
      if (!std::isnan(estimates_[e].x) && !std::isnan(estimates_[e].y))
        places.push_back({square(estimates_[e].x), square(estimates_[e].y), e});
    std::sort(places.begin(), places.end(), before);
    for (std::size_t t = 0; t < truth_.size(); ++t) {
      const double column = square(truth_[t].x), row = square(truth_[t].y);
      if (std::isnan(column) || std::isnan(row)) continue;
      double last = std::numeric_limits<double>::quiet_NaN();
      for (double by = -2.0; by <= 2.0; ++by) {
        if (column + by == last) continue;  // huge numbers round to the same column
        last = column + by;
        auto place = std::lower_bound(places.begin(), places.end(), Place{last, row - 2.0, 0}, before);
        for (; place != places.end() && place->column == last && place->row <= row + 2.0; ++place)
          try_one(t, place->estimate);
      }
    }
  }

  std::vector<Candidate>& sorted() {
    std::sort(found_.begin(), found_.end(), [](const Candidate& a, const Candidate& b) {
      if (a.distance != b.distance) return a.distance < b.distance;
      return a.pair.truth != b.pair.truth ? a.pair.truth < b.pair.truth : a.pair.estimate < b.pair.estimate;
    });
    return found_;
  }

 private:
  void try_one(std::size_t t, std::size_t e) {
    // Bounds each axis on its own, no tighter than rounding: that excludes most pairs cheaply.
    const double reach = gate_ * (1.0 + 1e-9);
    const double dx = truth_[t].x - estimates_[e].x, dy = truth_[t].y - estimates_[e].y;
    if (std::abs(dx) > reach || std::abs(dy) > reach) return;
    const double distance = std::hypot(dx, dy);
    if (distance <= gate_) found_.push_back({distance, {t, e}});
  }

  std::span<const PlanePosition> truth_, estimates_;
  double gate_;
  std::vector<Candidate> found_;
};

}  // namespace

std::vector<TruthPair> closest_pairs(std::span<const PlanePosition> truth, std::span<const PlanePosition> estimates,
                                     double gate_m) {
  Candidates candidates(truth, estimates, gate_m);
  if (truth.size() * estimates.size() <= kFew || !(gate_m > 0.0))
    candidates.try_all();
  else
    candidates.try_near();
  std::vector<char> truth_taken(truth.size()), estimate_taken(estimates.size());
  std::vector<TruthPair> pairs;
  for (const Candidate& candidate : candidates.sorted()) {
    char &t = truth_taken[candidate.pair.truth], &e = estimate_taken[candidate.pair.estimate];
    if (t || e) continue;
    t = e = 1;
    pairs.push_back(candidate.pair);
  }
  return pairs;
}

}  // namespace ttf::evaluation::accuracy
