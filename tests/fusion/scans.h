// Scans for tests.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "fusion/observation.h"
#include "fusion/timeline.h"

namespace ttf::testing_support {

inline fusion::Observation position(double x, double y, double sigma = 0.2) {
  fusion::Observation observation;
  observation.z << x, y, 0.0;
  observation.r(0, 0) = observation.r(1, 1) = sigma * sigma;
  return observation;
}

inline GlobalTime at_ms(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }

inline fusion::StoredScan scan(std::uint8_t sensor, std::uint32_t sequence, std::int64_t ms,
                               std::vector<fusion::Observation> observations) {
  fusion::StoredScan stored;
  stored.id = {SensorId{sensor}, sequence};
  stored.measured = at_ms(ms);
  stored.observations = std::move(observations);
  return stored;
}

// The same bits: states, covariances, ids, in the same order.
inline bool same_bits(const fusion::TrackSet& a, const fusion::TrackSet& b) {
  if (a.tracks.size() != b.tracks.size() || a.time != b.time || a.next_id != b.next_id) return false;
  for (std::size_t t = 0; t < a.tracks.size(); ++t) {
    const fusion::Track &l = a.tracks[t], &r = b.tracks[t];
    if (l.id != r.id || l.confirmed != r.confirmed || l.hits != r.hits || l.misses != r.misses) return false;
    for (Eigen::Index i = 0; i < 6; ++i)
      if (std::bit_cast<std::uint64_t>(l.estimate.x(i)) != std::bit_cast<std::uint64_t>(r.estimate.x(i)))
        return false;
    for (Eigen::Index i = 0; i < 36; ++i)
      if (std::bit_cast<std::uint64_t>(l.estimate.p.data()[i]) !=
          std::bit_cast<std::uint64_t>(r.estimate.p.data()[i]))
        return false;
  }
  return true;
}

}  // namespace ttf::testing_support
