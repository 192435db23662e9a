// A 77 GHz radar that lists returns by range, azimuth and range rate.
//
// An object reflects at several points of its visible outline. Each measurement draws them anew: evenly over the azimuths of
// the outline, so that their mean is the middle of the silhouette. A real car has lasting ones (corners, wheel houses), which
// move along it as the aspect changes. All points of an object share its cross-section evenly.
//
// A point's echo fluctuates from list to list (Swerling 1). Its power, in units of the noise's, is exponential:
//   P_d = P_fa^(1 / (1 + SNR)),   SNR = S0 (sigma / 1 m^2) (100 m / R)^4 g^2 10^(-2 a R / 10 km)
// with the SNR S0 of 1 m^2 at 100 m on the axis, the antenna's gain g and the weather's attenuation a [dB/km]. (Skolnik:
// "Introduction to Radar Systems", 3rd ed., 2001, sections 1.2 and 2.8; one pulse.) The gain is a Gaussian beam.
//
// Echoes in one cell of range, azimuth and range rate are one return: the mean of their points by power. Cells lie on a grid.
// The range rate is that of the reflecting point relative to the antenna, over ground, and is folded into its
// ambiguity-free span about zero.
//
// Nothing hides an object by default: below cars and from the road, echoes reach a radar from vehicles that others hide. With
// a `shadow` an object is hidden as for a camera (occlusion.h).
//
// The defaults are assumed. Their class is that of 77 GHz long-range radars, such as the far range of Continental's ARS 408: 250 m
// of range, and cells of 1.8 m and 1.6 degrees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "sensors/device.h"
#include "sensors/occlusion.h"
#include "sim/world/ego.h"
#include "sim/world/weather.h"
#include "sim/world/world.h"

namespace ttf::sensors::radar {

struct RadarConfig {
  static constexpr int kMostPoints = 8;  // points of an object, with draws of their own
  double half_field_rad = 0.35;          // 20 degrees to either side
  double max_range_m = 250.0;
  double beam_width_rad = 0.5;  // between the azimuths of half the gain
  double range_sigma_m = 0.15;
  double azimuth_sigma_rad = 0.003;
  double rate_sigma_mps = 0.05;
  double range_cell_m = 1.8;
  double azimuth_cell_rad = 0.028;
  double rate_cell_mps = 0.1;
  double rate_span_mps = 160.0;           // the unambiguous range rates lie evenly about zero
  int most_returns = 4;                   // points of an object
  double snr_at_100m_db = 20.0;           // S0; 30 dB for a car of 10 m^2
  double false_alarm_probability = 1e-6;  // P_fa, of a cell
  double attenuation_db_per_km = 0.0;     // one way
  double shadow = 0.0;
  double clutter_per_list = 0.2;  // mean number of false returns, even over field, ranges and range rates
  DriveError range_bias;          // systematic errors, zero by default: [m]
  DriveError azimuth_bias;        // [rad]
  DriveError rate_bias;           // [m/s]
  Device device;
  int max_returns = 64;  // capacity of a raw list; the nearest are kept
};
RadarConfig load_radar(YamlMap& yaml);
// Returns the sensor in this weather.
RadarConfig in_weather(RadarConfig config, const sim::world::Weather& weather);
// Returns the configuration with the systematic errors of one drive.
RadarConfig in_drive(RadarConfig config, const DriveKey& key);

struct RadarReturn {
  double range = 0;       // [m]
  double azimuth = 0;     // [rad]
  double range_rate = 0;  // [m/s], positive for a receding point
  double power_db = 0;    // over the noise
};

// Returns SNR and P_d of a point, as above.
double snr_of(const RadarConfig& config, double cross_section, double range, double azimuth);
double detection_probability(const RadarConfig& config, double snr);
// Returns the range rate as the radar measures it, in -span / 2 .. span / 2.
double folded(double range_rate, double span);

// The velocity of a mounted antenna over ground [m/s], in the sensor's axes.
struct AntennaVelocity {
  double x = 0.0, y = 0.0;
};
AntennaVelocity antenna_velocity(const EgoState& ego, const Placement& placement);

// Room for as many objects, so that measuring allocates nothing.
class RadarRoom {
 public:
  explicit RadarRoom(std::size_t most_objects);

 private:
  friend void measure_radar(const RadarConfig&, std::span<const ObjectState>, const AntennaVelocity&,
                            const MeasurementKey&, RadarRoom&, std::vector<RadarReturn>&, std::vector<ObjectId>&);
  struct Echo {
    std::int64_t range_cell = 0, azimuth_cell = 0, rate_cell = 0;
    double power = 0.0;                             // in units of the noise's
    double range = 0.0, azimuth = 0.0, rate = 0.0;  // without noise
    double range_noise = 0.0, azimuth_noise = 0.0, rate_noise = 0.0;
    ObjectId object{};
    int point = 0;
  };
  Occlusion occlusion_;
  std::vector<Sight> sights_;
  std::vector<Echo> echoes_;
};

// Replaces `returns` by those of `objects`, which are in the sensor's axes, by range; false ones are last. `truth` has the
// object of each one's strongest echo, 0xffff for a false return. An object's draws depend on its id, not on other objects.
void measure_radar(const RadarConfig& config, std::span<const ObjectState> objects, const AntennaVelocity& antenna,
                   const MeasurementKey& key, RadarRoom& room, std::vector<RadarReturn>& returns,
                   std::vector<ObjectId>& truth);

}  // namespace ttf::sensors::radar
