// Joins a radar's returns to objects, one observation each.
//
// Returns are joined if their range, distance across the line of sight and range rate differ by no more than their gates. The gates hold
// for pairs. So a chain of returns is one object. A vehicle may drive past. Then the range rates of one object differ by its
// velocity across the line of sight times the difference of azimuths. The gate of the range rate grows by as much.
//
// So wide a gate also joins two cars side by side whose speeds differ. Their range rates show two bodies. A rigid body has the range rates
// a cos(t) + b sin(t), whether it turns or not. Azimuths t are from the first return's. The velocity is a along that line of sight
// and b across. Three or more returns that do not fit are joined anew. Each time the gates of the range rate are half as wide.
// Wheels do not fit, but the radar's model has none. Without `transverse_speed_mps` the gates are narrow, and stay.
//
// Kellner, Barjenbruch, Dietmayer, Klappstein, Dickmann: "Instantaneous lateral velocity estimation of a vehicle using Doppler radar",
// FUSION 2013, pages 877 to 884.
//
// An object is at the mean of its n returns, with the standard deviations of the sensor over sqrt(n). Where the
// returns lie on the object is the tracker's matter, which has its size and heading (fusion/tracks/body/returns.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/strict_yaml.h"
#include "fusion/sensors/resolution.h"

namespace ttf::sensors::radar {

struct RadarPreprocessingConfig {
  double range_sigma_m = 0.15;
  double azimuth_sigma_rad = 0.003;
  double rate_sigma_mps = 0.05;
  double rate_span_mps = 160.0;  // range rates are known up to multiples of this
  double range_gate_m = 5.0;     // a car's length
  double across_gate_m = 2.5;    // and three standard deviations of the azimuths' difference
  double rate_gate_mps = 1.0;
  double transverse_speed_mps = 0.0;  // objects pass the sensor this fast, at most
};
RadarPreprocessingConfig load_radar_preprocessing(YamlMap& yaml);
// Returns which returns are joined.
fusion::sensors::Resolution resolution_of(const RadarPreprocessingConfig& config);

struct Return {
  double range = 0.0, azimuth = 0.0, range_rate = 0.0;
};

struct RadarObject {
  double range = 0.0, bearing = 0.0, range_rate = 0.0;  // [m], [rad], [m/s]
  double sigma_range = 0.0, sigma_bearing = 0.0, sigma_range_rate = 0.0;
  int returns = 0;
};

class ReturnJoiner {
 public:
  ReturnJoiner(const RadarPreprocessingConfig& config, std::size_t most_returns);
  // Replaces `objects` by those of the returns, by range. Allocates nothing if `objects` has room.
  void join(const std::vector<Return>& returns, std::vector<RadarObject>& objects);

 private:
  using Resolution = fusion::sensors::Resolution;
  bool together(const Return& a, const Return& b, const Resolution& resolution) const;
  void take_chain(const std::vector<Return>& returns, std::size_t first, const Resolution& resolution);
  bool is_one_body(const std::vector<Return>& returns) const;
  double chi_squared(const std::vector<Return>& returns, double fold) const;
  RadarObject object_of(const std::vector<Return>& returns) const;

  RadarPreprocessingConfig config_;
  fusion::sensors::Resolution resolution_;
  std::vector<char> taken_;           // by return
  std::vector<std::size_t> members_;  // the present object's
};

}  // namespace ttf::sensors::radar
