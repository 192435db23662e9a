// Sums up tracks without any truth: how long they live, and which of them are in one place.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "core/time.h"
#include "fusion/tracks/footprint.h"
#include "fusion/tracks/view.h"

namespace ttf::cli::track {

struct LivesSummary {
  std::uint64_t tracks = 0;
  // Pairs of tracks whose places overlap at some instant (fusion/tracks/footprint.h), and such pairs summed over all instants.
  std::uint64_t overlapping_pairs = 0, overlaps = 0;
  // [s], from a track's first state to its last: lower quartile, median and upper quartile. 0 without tracks.
  std::array<double, 3> lifetimes_s{};
};

class TrackLives {
 public:
  // Takes the tracks that are known together.
  void take(std::span<const fusion::tracks::TrackView> tracks);
  LivesSummary summary() const;

 private:
  std::map<TrackId, std::pair<GlobalTime, GlobalTime>> lives_;
  std::set<std::pair<TrackId, TrackId>> pairs_;
  std::uint64_t overlaps_ = 0;
};

}  // namespace ttf::cli::track
