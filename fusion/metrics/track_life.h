// Measures how an object was tracked from its birth on: when first, for how much of its life, how often it was
// lost, and by how many tracks.
//
// An object's life is the set of instants at which the truth lists it. An object out of sight for a while is
// not missed.
//   L1  confirmation: the first instant at which one of the given tracks, confirmed ones, is matched to the object
//   L2  fraction tracked: instants with a match / instants listed; mostly tracked from 80 %, mostly lost below 20 %
//       (Li, Huang, Nevatia: "Learning to associate", CVPR 2009; the bounds as py-motmetrics documents them)
//   L3  fragmentation: tracked, then missed, then tracked again, by the same track or another; misses before the first
//       and after the last match do not count
//   L4  switches: as CLEAR-MOT counts them (clear_mot.h, C3)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "fusion/metrics/identity.h"

namespace ttf::fusion::metrics {

enum class Coverage { kMostlyTracked, kPartlyTracked, kMostlyLost };

struct ObjectLife {
  Identity object = 0;
  TrueTime born{}, last{};  // the first and the last listed instant
  std::optional<TrueTime> confirmed;
  std::uint64_t instants = 0, tracked = 0;
  std::uint64_t missed_in_a_row = 0;  // listed instants since the last match, or since birth
  std::uint64_t fragmentations = 0, switches = 0;

  std::optional<Duration> confirmed_after() const {
    return confirmed ? std::optional<Duration>(*confirmed - born) : std::nullopt;
  }
  double fraction_tracked() const { return static_cast<double>(tracked) / static_cast<double>(instants); }
  Coverage coverage() const;
};

struct LifeSummary {
  std::size_t objects = 0, confirmed = 0;
  std::size_t mostly_tracked = 0, partly_tracked = 0, mostly_lost = 0;
  std::size_t lost = 0;  // objects with a fragmentation or a switch: their track ended or changed
  std::uint64_t fragmentations = 0, switches = 0;
  // Both are not a number without a value: no object confirmed, or no object at all.
  double mean_confirmed_after_s = 0.0, mean_fraction_tracked = 0.0;
  Duration worst_confirmed_after{};  // among the confirmed objects
};

class TrackLives {
 public:
  // Takes one instant, later than the last: the objects that the truth lists, each once, in any order, and the
  // matches of ClearMot::step. The storage grows with the number of different objects.
  void step(TrueTime at, std::span<const Identity> objects, std::span<const Match> matches);

  std::span<const ObjectLife> lives() const { return lives_; }  // in the order of the objects' names
  LifeSummary summary() const;

 private:
  ObjectLife& life_of(Identity object, TrueTime at);

  std::optional<TrueTime> now_;
  std::vector<ObjectLife> lives_;
};

}  // namespace ttf::fusion::metrics
