// The DGPS reference: an antenna on the tracked car, off the bus, with errors of its own. In the paper it
// turned out to vary more than the sensors that it was to judge.
//
// The sensor car's alignment comes from two fixes at different spots before the drive. So all fixes are turned
// about the sensor's origin by a constant error: atan2(difference of the two fixes' cross errors, baseline).
// Now and then the solution jumps away for several fixes (loss of carrier lock or of corrections). The velocity
// comes from the carriers' Doppler shifts: it is independent of the position's error, does not jump with it,
// and is turned by the alignment, too.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "core/time.h"
#include "sim/world/world.h"

namespace ttf::sim::world {

struct ReferenceConfig {
  Duration period = Duration::milliseconds(100);
  Duration latency = Duration::milliseconds(60);
  double sigma_m = 0.25;  // per axis: code differential positioning
  // Per axis. NovAtel's OEM receivers state 0.03 m/s RMS, u-blox' NEO-M8 0.05 m/s (data sheets, velocity accuracy).
  double velocity_sigma_mps = 0.05;
  double excursion_probability = 0.04;  // probability that an excursion begins at a fix
  double excursion_m = 1.0;             // its size, uniform in direction
  int excursion_fixes = 3;              // its length
  double alignment_baseline_m = 50.0;   // between the two spots
};
ReferenceConfig load_reference(YamlMap& yaml);

// Times since the start of the drive.
struct Fix {
  TrueTime measured{};
  TrueTime available{};
  ObjectId object{};
  double x = 0, y = 0;    // [m]
  double vx = 0, vy = 0;  // [m/s]
};

class Reference {
 public:
  Reference(const ReferenceConfig& config, const WorldConfig& world, std::uint64_t seed, std::uint32_t replication);
  // Returns when the index-th fix is available.
  TrueTime available(std::uint32_t index) const { return TrueTime{} + config_.period * index + config_.latency; }
  // Returns the index-th fix; a pure function of `index`, in any order of calls.
  Fix fix(std::uint32_t index, const World& world) const;
  double sigma() const { return config_.sigma_m; }
  double velocity_sigma() const { return config_.velocity_sigma_mps; }
  double alignment_error_rad() const { return alignment_; }

 private:
  ReferenceConfig config_;
  ObjectId object_{};
  std::uint64_t seed_;
  std::uint32_t replication_;
  double alignment_ = 0;
};

}  // namespace ttf::sim::world
