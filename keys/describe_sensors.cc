#include "keys/descriptions.h"

namespace ttf::keys {
namespace {

constexpr Description kSensors[] = {
    {"laser.layers", "A scan has so many layers."},
    {"laser.azimuth_step", "Neighbouring beams are this far apart."},
    {"laser.half_field", "The scan reaches this far to either side."},
    {"laser.range_sigma", "A range has this standard deviation."},
    {"laser.max_range", "The laser sees no further than this."},
    {"laser.miss_at_100m", "An echo from 100 m is lost with this probability, which grows with the range squared."},
    {"laser.range_bias", "All ranges are too long by this."},
    {"laser.range_bias_sigma", "Each drive draws a further bias of the range with this standard deviation."},
    {"laser.azimuth_bias", "All azimuths are too large by this."},
    {"laser.azimuth_bias_sigma", "Each drive draws a further bias of the azimuth with this standard deviation."},
    {"laser.mounting", "The laser sits here on the vehicle; absent, at its origin."},
    {"laser.time_bias", "The laser measures this long after the instant of its time stamp."},
    {"laser.time_bias_sigma", "Each drive draws a further bias of the time stamp with this standard deviation."},
    {"camera.baseline", "The two cameras of the pair are this far apart."},
    {"camera.focal", "The cameras have this focal length."},
    {"camera.disparity_sigma", "A disparity has this standard deviation."},
    {"camera.bearing_sigma", "A bearing has this standard deviation."},
    {"camera.width_sigma", "The width of a silhouette has this standard deviation."},
    {"camera.half_field", "The camera sees this far to either side."},
    {"camera.max_range", "The camera sees no further than this."},
    {"camera.miss_probability", "An object in view is missed with this probability."},
    {"camera.shadow",
     "An object hides others behind it up to this share of its own distance; absent, all that are behind it.", "0.5"},
    {"camera.clutter_per_frame", "A list has so many false detections on the average."},
    {"camera.bearing_bias", "All bearings are too large by this."},
    {"camera.bearing_bias_sigma", "Each drive draws a further bias of the bearing with this standard deviation."},
    {"camera.disparity_bias", "All disparities are too large by this."},
    {"camera.disparity_bias_sigma", "Each drive draws a further bias of the disparity with this standard deviation."},
    {"camera.mounting", "The camera sits here on the vehicle; absent, at its origin."},
    {"camera.time_bias", "The camera measures this long after the instant of its time stamp."},
    {"camera.time_bias_sigma", "Each drive draws a further bias of the time stamp with this standard deviation."},
};

constexpr Description kPreprocessing[] = {
    {"laser.range_noise", "A range is assumed to have this standard deviation."},
    {"laser.azimuth_step", "Neighbouring beams are assumed to be this far apart."},
    {"laser.smallest_gap", "Returns no further apart than this belong to one object."},
    {"laser.incidence", "A surface seen more flatly than at this angle is cut in pieces."},
    {"laser.largest_gap", "Returns further apart than this belong to different objects."},
    {"laser.nominal_length", "A vehicle whose length is not seen is taken to be this long."},
    {"laser.length_sigma", "The length of vehicles spreads by this standard deviation."},
    {"laser.nominal_width", "A vehicle whose width is not seen is taken to be this wide."},
    {"laser.width_sigma", "The width of vehicles spreads by this standard deviation."},
    {"laser.fewest_points", "Fewer returns than this are no object."},
    {"laser.longest_extent", "A longer group of returns is no vehicle."},
    {"camera.baseline", "The two cameras of the pair are taken to be this far apart."},
    {"camera.focal", "The cameras are taken to have this focal length."},
    {"camera.disparity_sigma", "A disparity is assumed to have this standard deviation."},
    {"camera.bearing_sigma", "A bearing is assumed to have this standard deviation."},
    {"camera.width_sigma", "The width of a silhouette is assumed to have this standard deviation."},
    {"camera.half_length",
     "A vehicle is taken to be twice this long; its centre lies this far beyond a rear that is seen."},
    {"camera.half_length_sigma", "That distance spreads by this standard deviation."},
    {"camera.nominal_width", "A vehicle is taken to be this wide."},
};

constexpr Description kKnownSensor[] = {
    {"mounting", "The sensor sits here on the vehicle; absent, at its origin."},
    {"bias", "The sensor is known to measure too much by these; the tracker corrects it."},
    {"bias.range", "Its ranges are too long by this.", "0.2"},
    {"bias.bearing", "Its bearings are too large by this.", "0.01"},
    {"bias.range_rate", "Its range rates are too large by this.", "0.1"},
    {"bias.x", "Its positions are too far ahead by this; not together with polar biases.", "0.2"},
    {"bias.y", "Its positions are too far to the left by this; not together with polar biases.", "-0.1"},
    {"bias_sigma", "The sensor has unknown biases of these standard deviations; `systematic` says how they count."},
    {"bias_sigma.range", "The unknown bias of its ranges has this standard deviation.", "0.1"},
    {"bias_sigma.bearing", "The unknown bias of its bearings has this standard deviation.", "0.005"},
    {"bias_sigma.range_rate", "The unknown bias of its range rates has this standard deviation.", "0.1"},
    {"bias_sigma.x", "The unknown bias of its x has this standard deviation; not together with polar biases.", "0.1"},
    {"bias_sigma.y", "The unknown bias of its y has this standard deviation; not together with polar biases.", "0.1"},
    {"bias_sigma.time", "The unknown bias of its time stamps has this standard deviation."},
};

}  // namespace

Descriptions sensor_descriptions() { return kSensors; }
Descriptions preprocessing_descriptions() { return kPreprocessing; }
Descriptions known_sensor_descriptions() { return kKnownSensor; }

}  // namespace ttf::keys
