// The life of a track: the lists that counted for it and against it, its first observation and its last.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::fusion::tracks {

// The identity of an observation: the index-th of a measurement. A restarted sensor counts its measurements
// anew, so the instant distinguishes them.
struct ObservationId {
  MeasurementId measurement;
  std::uint16_t index = 0;
  GlobalTime measured{};
  bool operator==(const ObservationId&) const = default;
};

// Members are in the order of their use: those of every pass over all tracks come first. 1,000 tracks fill a processor's cache.
struct Life {
  TrackId id = kNoTrack;  // set on confirmation (fusion/tracks/identities.h)
  bool confirmed = false;
  std::uint8_t lists_elsewhere = 0;  // lists in a row that observed other points of the object
  std::uint32_t hits = 0;            // bit i: the list i lists ago had an observation of the track
  std::uint32_t doubtful = 0;        // such bits of the doubtful ones among them: these confirm nothing
  int lists = 0;                     // since birth, the first included
  int misses = 0;                    // lists in a row without an observation
  ObservationId birth, newest;       // the first observation and the last
  GlobalTime shared{};               // the newest list with an observation that it shares with other tracks
  double existence = 1.0;  // probability that the object exists (fusion/tracks/parts/existence.h); 1 for births m_of_n
};

// Counts the newest list, with or without an observation of the track.
inline void count_newest(Life& life, bool hit) {
  ++life.lists;
  life.hits = (life.hits << 1) | (hit ? 1u : 0u);
  life.misses = hit ? 0 : life.misses + 1;
}
// Counts a late list at its place, `since` counted lists before the newest.
inline void count_late(Life& life, int since, bool hit) {
  if (since < 32) {
    const std::uint32_t later = (1u << since) - 1u;
    life.hits = (life.hits & later) | ((life.hits & ~later) << 1) | ((hit ? 1u : 0u) << since);
    life.doubtful = (life.doubtful & later) | ((life.doubtful & ~later) << 1);
  }
  ++life.lists;
  if (since <= life.misses) life.misses = hit ? since : life.misses + 1;
}

}  // namespace ttf::fusion::tracks
