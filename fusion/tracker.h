// The multi-object tracker all strategies share: prediction, gating, global nearest neighbour, M-of-N confirmation, deletion.
//
// A step is a pure function of the tracks, the scan and the configuration; tracks are values, so that a strategy can keep
// snapshots and go back. Heading and extent are scalar random-walk filters beside the linear Cartesian state. Storage is taken
// at construction: nothing allocates afterwards.
#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/assignment.h"
#include "fusion/filter.h"
#include "fusion/observation.h"
#include "fusion/tracker_config.h"

namespace ttf::fusion {

// A scalar with its variance; `known` once something was measured.
struct Scalar {
  double value = 0.0;
  double variance = 0.0;
  bool known = false;
};

struct Track {
  TrackId id{};
  Estimate estimate;
  Scalar heading;                 // [rad], the direction it faces
  Scalar length, width;           // [m]
  std::uint32_t hits = 0;         // bit i: the scan i scans ago had an observation of it
  int scans = 0;                  // since birth, the first included
  int misses = 0;                 // scans in a row without an observation
  bool confirmed = false;
};

struct TrackSet {
  std::vector<Track> tracks;      // in order of birth
  GlobalTime time{};              // the tracks' states are of this instant
  std::uint16_t next_id = 0;
  bool started = false;

  explicit TrackSet(std::size_t capacity = 0) { tracks.reserve(capacity); }
  // Copies within the capacity: no allocation.
  void assign(const TrackSet& other);
};

class Tracker {
 public:
  Tracker(const TrackerConfig& config, std::size_t max_observations);

  // Takes the scan in; scan.measured must not be before set.time.
  void step(TrackSet& set, const Scan& scan);
  // Room for tentative and confirmed tracks together.
  std::size_t max_tracks() const { return max_tracks_; }
  const TrackerConfig& config() const { return config_; }

 private:
  void predict_all(TrackSet& set, GlobalTime to) const;
  void associate(const TrackSet& set, const Scan& scan);
  void correct(Track& track, const Observation& observation, const Innovation& innovation) const;
  void give_birth(TrackSet& set, const Scan& scan);
  void prune(TrackSet& set) const;

  TrackerConfig config_;
  std::size_t max_observations_, max_tracks_;
  double gate_[4] = {};           // by dimension of the observation
  Assignment assignment_;
  std::vector<Candidate> candidates_;
  std::vector<char> near_track_;  // per observation: inside the gate of a confirmed track
  std::vector<int> observation_of_;
};

// Scalars and tracks at a later instant; what an image shows of a track.
Scalar predicted(const Scalar& scalar, double noise, double dt);
struct TrackView {
  TrackId id{};
  GlobalTime valid_at{};
  State state = State::Zero();
  Covariance covariance = Covariance::Zero();
  // Heading: the direction of motion weighed with the measured axis; speed: magnitude of the velocity; acceleration: along
  // the heading.
  double heading = 0.0, sigma_heading = 0.0;
  double speed = 0.0, sigma_speed = 0.0;
  double acceleration = 0.0, sigma_acceleration = 0.0;
  double length = 0.0, sigma_length = 0.0;
  double width = 0.0, sigma_width = 0.0;
  bool confirmed = false;
};
TrackView view_of(const Track& track, GlobalTime time, GlobalTime at, const TrackerConfig& config);

}  // namespace ttf::fusion
