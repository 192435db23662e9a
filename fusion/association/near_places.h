// Finds the places of tracks that may be in an observation's gate, in a time that hardly grows with their number if they are
// apart.
//
// The plane is cut into square cells, as large as a common reach from end to end, so that a search passes two by two of them.
// The few places of a larger reach lie in no cell, and each search passes them all. Cells share buckets, of which there are a
// few for each place. Cells that follow each other along y have buckets that do so, too. Sorting and halving would take far
// longer: the processor cannot foresee half of their branches. The constructor allocates all storage.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ttf::fusion::association {

// A position [m] with the variances of its axes [m^2].
struct TrackPlace {
  double x = 0.0, y = 0.0, variance_x = 0.0, variance_y = 0.0;
  double reach = 0.0;  // [m] from the place to any point of its track's object that may have been observed
  std::size_t track = 0;
};

class NearPlaces {
 public:
  explicit NearPlaces(std::size_t most);

  // Forgets all places. The next ones are searched with this bound on the squared distance.
  void begin(double gate);
  // The places come in the order of their tracks: 0, 1, 2 and so on.
  void add(const TrackPlace& place) {
    places_.push_back(place);
    const double reach_x = place.reach + reach_of(place.variance_x), reach_y = place.reach + reach_of(place.variance_y);
    reaches_.push_back({reach_x, reach_y});
    sum_ += std::max(reach_x, reach_y);
  }
  // Puts the places that were added since begin() into cells. Searches follow, with variances that are not larger.
  void arrange(double variance_x, double variance_y);
  std::span<const TrackPlace> all() const { return places_; }

  // Calls try_one(place) for the places that `at`, a position with its variances, may be in the gate of. They are not farther
  // than the reach of both on either axis.
  template <class Try> void near(const TrackPlace& at, const Try& try_one) {
    const double own_x = reach_of(at.variance_x), own_y = reach_of(at.variance_y);
    std::size_t found = 0;
    const auto search = [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t i = first; i < last; ++i) {
        const Spot& spot = spots_[i];
        found_[found] = spot.track;
        found += static_cast<std::size_t>(static_cast<int>(std::abs(spot.x - at.x) <= spot.reach.x + own_x) &
                                          static_cast<int>(std::abs(spot.y - at.y) <= spot.reach.y + own_y));
      }
    };
    const std::int64_t column = cell_of(at.x - own_x - common_), row = cell_of(at.y - own_y - common_);
    for (std::int64_t c = 0; c < kAcross; ++c) {
      const std::size_t bucket = bucket_of(column + c, row);
      search(begin_[bucket], begin_[bucket + kAcross]);
    }
    search(0, wide_);
    for (std::size_t i = 0; i < found; ++i) try_one(places_[found_[i]]);
  }

 private:
  static constexpr std::int64_t kAcross = 2;  // cells that a search passes on each axis

  struct Reach {
    double x, y;  // [m]
    bool beyond(double common) const { return std::max(x, y) > common; }
  };
  struct Spot {
    double x, y;
    Reach reach;
    std::uint32_t track;
  };

  // Rounded up, so that it excludes no pair inside a gate.
  double reach_of(double variance) const {
    constexpr double kRoundedUp = 1.0 + 1e-12;
    return kRoundedUp * std::sqrt(gate_ * variance);
  }
  // Cells beyond the farthest one count as that one.
  std::int64_t cell_of(double coordinate) const {
    constexpr double kFarthest = 1e9;
    return static_cast<std::int64_t>(
        std::floor(std::max(-kFarthest, std::min(kFarthest, coordinate * cells_per_metre_))));
  }
  std::size_t bucket_of(std::int64_t column, std::int64_t row) const {
    return (static_cast<std::size_t>(column) * step_ + static_cast<std::size_t>(row)) & mask_;
  }
  void choose_common();
  void count_by_bucket();
  Spot spot_of(std::size_t track) const;

  double gate_ = 0.0;
  std::vector<TrackPlace> places_;  // by track
  std::vector<Reach> reaches_;      // by track
  double sum_ = 0.0;                // the larger reaches' sum
  double common_ = 0.0;             // [m], the largest reach of a place in a cell
  double cells_per_metre_ = 0.0;
  std::size_t step_ = 0, mask_ = 0;    // buckets from column to column; their number less one
  std::uint32_t wide_ = 0;             // so many spots, the first ones, have a larger reach
  std::vector<std::uint32_t> bucket_;  // by track
  std::vector<std::uint32_t> begin_;   // each bucket's first spot
  std::vector<Spot> spots_;            // by bucket; the first buckets follow the last one once more
  std::vector<std::uint32_t> found_;   // in a search
};

}  // namespace ttf::fusion::association
