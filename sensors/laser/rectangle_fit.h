// Says what was seen of a vehicle, from the returns of one object: its near end, its near side, the near corner of
// both, one end of its outline, or only a silhouette. Sizes are stated where they were measured; the rest is left to the tracker.
//
// The likelihoods of both fits decide between one face and two (outline_fit.h). Twice the logarithm of their ratio is the
// drop t of the squared range errors, in units of the range's variance. Take returns of one face, and one place of the
// corner. Every other time the corner would bend the outline away from the sensor. Then t is the square of a standard
// normal number. So it exceeds t with a probability below exp(-t / 2) / 2. The corner may lie at any of n beams. A corner
// is taken if t > 2 log(n / 2p): a face is taken for a corner with a probability below p.
//
// Then, with the face's width of 1.3 m to 2.6 m:
//   - A face longer than any width is a side, one of a vehicle's width an end. The upper limit holds for all lengths within the
//     face's margin, half a beam's step at either end: a truck's rear of 2.5 m may look 2.8 m long at 46 m. The lower limit holds
//     for the value alone, so that a small car's rear stays an end at 60 m. A face that may be either is a silhouette: a wrong axis
//     is off by a quarter turn at a stated error of a hundredth of a radian. Objects narrower than vehicles break this: a
//     motorcycle's side of 2.2 m is an end by its length.
//   - At a corner one face decides for both.
//   - The outline ends up to one beam's step after its last beam, anywhere in between. An end is known only if the
//     next beam would have met the same face near enough to be held together with it (segmentation.h), and if nothing
//     nearer hides it.
//   - Where nothing of this is known, and the field's edge cuts one end of the outline, the other end is stated: a corner of the
//     vehicle, though not which one. Its heading is the direction into the face that ends there. The middle of such an outline would
//     err by half of the cut part, to the same side in scan after scan.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "fusion/sensors/observation.h"
#include "fusion/sensors/plane_position.h"
#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {

struct RectangleConfig {
  double range_noise_m = 0.06;
  double azimuth_step_rad = 0.00436;
  double widest_rear_m = 2.6;      // a longer extent is a side
  double narrowest_width_m = 1.3;  // a shorter face is only part of a width
};

// The first or the last beam of an object.
struct OutlineEnd {
  bool hidden = false;      // something nearer begins there, or the field ends
  bool by_field = false;    // the field ends there, or the list does
  double held_gap_m = 0.6;  // returns up to this far apart would have been held together there
};
using OutlineEnds = std::array<OutlineEnd, 2>;  // at the smallest and at the largest azimuth

// The shape of a segment (sensors/laser/preprocessor.h):
//   kVehicle  An end, a side or a corner was measured: the object has an axis and at least one side of its own.
//   kPart     A silhouette: part of a vehicle, far or half hidden, or of something else. Alone it shows no vehicle.
//   kThin     All of it is in view, and it is thinner than any vehicle: a pole, a trunk, a person.
//   kRough    Neither a face nor a corner fits: a bush, or a front with bays. A real car leaves 0.05 m to 0.2 m.
enum class VehicleShape : std::uint8_t { kVehicle, kPart, kThin, kRough };

// Position of the seen point and its covariance. Heading [rad] of the vehicle's own axis, up to half a turn: known
// unless it is a silhouette or the end of a cut outline. Length and width [m]. A value whose has_ flag is clear is 0, except the heading of a free end: the
// direction into its face.
struct LaserObject : ttf::fusion::sensors::PlanePosition {
  ttf::fusion::sensors::SeenPoint seen = ttf::fusion::sensors::SeenPoint::kSilhouette;
  double heading = 0, length = 0, width = 0;
  double sigma_heading = 0, sigma_length = 0, sigma_width = 0;
  bool has_heading = false, has_length = false, has_width = false;
  int points = 0;
  VehicleShape shape = VehicleShape::kVehicle;  // the preprocessor says
  double residual_m = 0.0;  // root mean square of the range errors that the likelier of both outlines leaves
};

// Expects at least one return, by azimuth. The covariance is always positive definite.
LaserObject fit_rectangle(const RectangleConfig& config, std::span<const PlanePoint> points,
                          const OutlineEnds& ends = {});

}  // namespace ttf::sensors::laser
