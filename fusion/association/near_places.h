// Finds the places of tracks that may be in an observation's gate, in n log n for n tracks that are apart.
//
// The places are cut into strips along x, each as long as there are many, and each strip is sorted by y. So a search passes
// few strips, and few places of each. A few places are one strip, sorted by x. The constructor allocates all storage.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace ttf::fusion::association {

// A position [m] with the variances of its axes [m^2].
struct Place {
  double x = 0.0, y = 0.0, variance_x = 0.0, variance_y = 0.0;
  double reach = 0.0;  // [m] from the place to any point of its track's object that may have been observed
  std::size_t track = 0;
};

class NearPlaces {
 public:
  explicit NearPlaces(std::size_t most);

  void clear();
  // The places come in the order of their tracks: 0, 1, 2 and so on.
  void add(const Place& place) {
    by_track_.push_back(place);
    largest_variance_x_ = std::max(largest_variance_x_, place.variance_x);
    largest_variance_y_ = std::max(largest_variance_y_, place.variance_y);
    largest_reach_ = std::max(largest_reach_, place.reach);
  }
  // Sorts the places that were added since clear(). Searches follow.
  void sort();
  std::span<const Place> all() const { return places_; }

  // Calls try_one(place) for the places that are not beyond the reach of the least certain one, on either axis. `at` has a
  // position and its variances. All other places are outside of a gate with this bound on the squared distance.
  template <class Try> void near(const Place& at, double gate, const Try& try_one) const {
    const double reach_x = kRoundedUp * std::sqrt(gate * (largest_variance_x_ + at.variance_x)) + largest_reach_;
    const double reach_y = kRoundedUp * std::sqrt(gate * (largest_variance_y_ + at.variance_y)) + largest_reach_;
    const double low = at.x - reach_x, high = at.x + reach_x;
    if (strips_.empty()) {
      const Place* one = first_not(all(), [&](const Place& p) { return p.x < low; });
      for (; one != all().data() + all().size() && one->x <= high; ++one)
        if (std::abs(one->y - at.y) <= reach_y) try_one(*one);
      return;
    }
    const std::span<const Strip> strips(strips_);
    const Strip* strip = first_not(strips, [&](const Strip& s) { return s.high < low; });
    for (; strip != strips.data() + strips.size() && strip->low <= high; ++strip) {
      const std::span<const Place> here = all().subspan(strip->begin, strip->end - strip->begin);
      const Place* one = first_not(here, [&](const Place& p) { return p.y < at.y - reach_y; });
      for (; one != here.data() + here.size() && one->y <= at.y + reach_y; ++one) try_one(*one);
    }
  }

 private:
  // Makes a rounded bound exclude no pair inside a gate.
  static constexpr double kRoundedUp = 1.0 + 1e-12;

  struct Strip {
    double low = 0.0, high = 0.0;  // x
    std::size_t begin = 0, end = 0;
  };
  struct Along {
    double x = 0.0;
    std::size_t track = 0;
  };

  // Returns the first element of a sorted range that is not `before`. The number of halvings is that of the range alone, and
  // none of them branches. The processor would foresee half of the branches wrongly.
  template <class T, class Before> static const T* first_not(std::span<const T> range, const Before& before) {
    const T* first = range.data();
    for (std::size_t left = range.size(); left > 0;) {
      const std::size_t half = (left + 1) / 2;
      first += half * static_cast<std::size_t>(before(first[half - 1]));
      left -= half;
    }
    return first;
  }

  std::vector<Place> by_track_, places_;
  std::vector<Along> along_x_;  // the next sort begins with this order, and hardly changes it
  std::vector<Strip> strips_;   // empty if there is only one
  double largest_variance_x_ = 0.0, largest_variance_y_ = 0.0, largest_reach_ = 0.0;
};

}  // namespace ttf::fusion::association
