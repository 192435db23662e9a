#include <algorithm>
#include <array>

#include "keys/descriptions.h"
#include "schedules/model/cluster.h"

namespace ttf::keys {
namespace {

using schedules::model::kSensorKinds;
using schedules::model::SensorKindRow;

// Every sensor has these, whatever its kind.
constexpr Description kSensor[] = {
    {"kind", "The entry is of this kind, as its name says."},
    {"enabled",
     "The sensor measures; false switches it off: its lists are empty, and the fusion expects nothing of it."},
    {"mounting", "The sensor sits here on the vehicle; absent, at its origin."},
    {"time_bias", "The sensor measures this long after the instant of its time stamp."},
    {"time_bias_sigma", "Each drive draws a further bias of the time stamp with this standard deviation."},
    {"blind", "The sensor's own vehicle hides these sectors, at most four; absent, none."},
    {"blind[].from", "The sector begins at this azimuth, in the sensor's axes.", "0.3"},
    {"blind[].to", "It ends at this one, counter-clockwise.", "0.5"},
    {"preprocessing",
     "The sensor's host makes observations with these parameters of its kind; absent, with those of `preprocessing`."},
    {"period", "The sensor measures once in this time; the schedule says when, and must have the same period.",
     "80 ms"},
    {"colour", "Pictures show the sensor in this colour; absent, in that of its kind.", "green"},
    {"marker", "Pictures show the sensor's observations by this marker; absent, by that of its kind.", "plus"},
};

constexpr Description kLaser[] = {
    {"layers", "A scan has so many layers."},
    {"azimuth_step", "Neighbouring beams are this far apart."},
    {"azimuth_phase", "Beams lie at multiples of the step, or each scan shifts all of them by a drawn part of it."},
    {"half_field", "The scan reaches this far to either side."},
    {"range_sigma", "A range has this standard deviation."},
    {"max_range", "The laser sees no further than this."},
    {"miss_at_100m", "An echo from 100 m is lost with this probability, which grows with the range squared."},
    {"range_bias", "All ranges are too long by this."},
    {"range_bias_sigma", "Each drive draws a further bias of the range with this standard deviation."},
    {"azimuth_bias", "All azimuths are too large by this."},
    {"azimuth_bias_sigma", "Each drive draws a further bias of the azimuth with this standard deviation."},
};

constexpr Description kCamera[] = {
    {"baseline", "The two cameras of the pair are this far apart."},
    {"focal", "The cameras have this focal length."},
    {"disparity_sigma", "A disparity has this standard deviation."},
    {"bearing_sigma", "A bearing has this standard deviation."},
    {"width_sigma", "The width of a silhouette has this standard deviation."},
    {"half_field", "The camera sees this far to either side."},
    {"max_range", "The camera sees no further than this."},
    {"miss_probability", "An object in view is missed with this probability."},
    {"shadow", "An object hides others behind it up to this share of its own distance; absent, all that are behind it.",
     "0.5"},
    {"clutter_per_frame", "A list has so many false detections on the average."},
    {"bearing_bias", "All bearings are too large by this."},
    {"bearing_bias_sigma", "Each drive draws a further bias of the bearing with this standard deviation."},
    {"disparity_bias", "All disparities are too large by this."},
    {"disparity_bias_sigma", "Each drive draws a further bias of the disparity with this standard deviation."},
};

constexpr Description kRadar[] = {
    {"half_field", "The radar sees this far to either side."},
    {"max_range", "The radar sees no further than this."},
    {"beam_width", "The antenna has half of its gain at the edges of a beam this wide."},
    {"range_sigma", "A range has this standard deviation."},
    {"azimuth_sigma", "An azimuth has this standard deviation."},
    {"range_rate_sigma", "A range rate has this standard deviation."},
    {"range_cell", "Echoes in one cell are one return: cells are this long."},
    {"azimuth_cell", "Cells are this wide."},
    {"range_rate_cell", "Cells hold range rates this far apart."},
    {"range_rate_span", "Range rates are known up to multiples of this, and lie within half of it about zero."},
    {"most_returns", "An object reflects at so many points, which share its cross-section."},
    {"snr_at_100m", "One square metre 100 m ahead has this ratio of signal to noise."},
    {"false_alarm_probability", "The detection threshold lets the noise of one cell through with this probability."},
    {"attenuation", "The air weakens the signal by this, each way."},
    {"shadow",
     "An object hides others behind it up to this share of its own distance; 0: none, since echoes pass below."},
    {"clutter_per_list", "A list has so many false returns on the average."},
    {"range_bias", "All ranges are too long by this."},
    {"range_bias_sigma", "Each drive draws a further bias of the range with this standard deviation."},
    {"azimuth_bias", "All azimuths are too large by this."},
    {"azimuth_bias_sigma", "Each drive draws a further bias of the azimuth with this standard deviation."},
    {"range_rate_bias", "All range rates are too large by this."},
    {"range_rate_bias_sigma", "Each drive draws a further bias of the range rate with this standard deviation."},
};

constexpr Description kRadarPreprocessing[] = {
    {"range_sigma", "A range is assumed to have this standard deviation."},
    {"azimuth_sigma", "An azimuth is assumed to have this standard deviation."},
    {"range_rate_sigma", "A range rate is assumed to have this standard deviation."},
    {"range_rate_span", "Range rates are taken to be known up to multiples of this."},
    {"range_gate", "Returns of one object differ in range by no more than this from the next one of it."},
    {"across_gate",
     "They differ across the line of sight by no more than this, and three standard deviations of their azimuths."},
    {"range_rate_gate", "They differ in range rate by no more than this."},
    {"transverse_speed",
     "Objects pass the sensor across the line of sight this fast at most: by as much for each radian between them, "
     "returns of "
     "one object may differ more in range rate."},
};

constexpr Description kMonoCamera[] = {
    {"height", "The camera sits this high over ground."},
    {"focal", "The camera has this focal length."},
    {"half_field", "The camera sees this far to either side."},
    {"half_height", "The picture has so many rows above its middle, and as many below."},
    {"max_range", "Objects further away than this have no box."},
    {"column_sigma", "The left and the right edge of a box each have this standard deviation."},
    {"row_sigma", "The upper and the lower edge of a box each have this standard deviation."},
    {"detection_probability", "A large box is detected with this probability."},
    {"half_detected", "A box of this height is detected with half of that probability."},
    {"detection_slope", "The probability grows from a quarter to three quarters of that over 2.2 times this height."},
    {"class_confusion", "A box has a wrong class with this probability."},
    {"clutter_per_frame", "A list has so many false boxes on the average."},
    {"regions",
     "The camera looks for boxes in these rectangles of the picture, by their middle; absent, in all of it."},
    {"regions[].left", "The rectangle begins at this column, counted to the right from the picture's middle.", "-200"},
    {"regions[].right", "The rectangle ends at this column.", "200"},
    {"regions[].top", "The rectangle begins at this row, counted downwards from the picture's middle.", "-100"},
    {"regions[].bottom", "The rectangle ends at this row.", "100"},
    {"marks", "The camera measures marks of lanes like this, if the cluster has a list for them."},
    {"marks.ahead", "Marks are measured this far ahead of the vehicle's origin."},
    {"marks.widest", "Marks further aside are not seen."},
    {"marks.offset_sigma", "The offset of a mark has this standard deviation."},
    {"marks.heading_sigma", "The heading of a mark has this standard deviation."},
    {"marks.curvature_sigma", "The curvature of a mark has this standard deviation."},
    {"marks.miss_probability", "A mark is missed with this probability."},
    {"marks.false_per_list", "A list has so many false marks on the average."},
    {"bearing_bias", "All bearings are too large by this."},
    {"bearing_bias_sigma", "Each drive draws a further bias of the bearing with this standard deviation."},
    {"pitch", "The camera looks down by this, beyond its known mounting."},
    {"pitch_sigma", "Each drive draws a further pitch with this standard deviation."},
};

constexpr Description kMonoCameraPreprocessing[] = {
    {"height", "The camera is taken to sit this high over ground."},
    {"focal", "The camera is taken to have this focal length."},
    {"pitch", "The camera is taken to look down by this."},
    {"pitch_sigma", "The pitch is assumed to have this standard deviation, as noise of each box."},
    {"column_sigma", "The left and the right edge of a box are each assumed to have this standard deviation."},
    {"row_sigma", "The lower edge of a box is assumed to have this standard deviation."},
    {"marks", "Marks of lanes are assumed to have these standard deviations."},
    {"marks.offset_sigma", "The offset of a mark is assumed to have this standard deviation."},
    {"marks.heading_sigma", "The heading of a mark is assumed to have this standard deviation."},
    {"marks.curvature_sigma", "The curvature of a mark is assumed to have this standard deviation."},
};

constexpr Description kOdometry[] = {
    {"speed_sigma", "A speed has this standard deviation."},
    {"yaw_rate_sigma", "A yaw rate has this standard deviation."},
    {"speed_scale", "All speeds are too large by this share."},
    {"speed_scale_sigma", "Each drive draws a further share of the speed with this standard deviation."},
    {"yaw_rate_bias", "All yaw rates are too large by this."},
    {"yaw_rate_bias_sigma", "Each drive draws a further bias of the yaw rate with this standard deviation."},
};

constexpr Description kOdometryPreprocessing[] = {
    {"speed_sigma", "A speed is assumed to have this standard deviation."},
    {"yaw_rate_sigma", "A yaw rate is assumed to have this standard deviation."},
};

constexpr Description kLaserPreprocessing[] = {
    {"range_noise", "A range is assumed to have this standard deviation."},
    {"azimuth_step", "Neighbouring beams are assumed to be this far apart."},
    {"smallest_gap", "Returns no further apart than this belong to one object."},
    {"incidence", "A surface seen more flatly than at this angle is cut in pieces."},
    {"largest_gap", "Returns further apart than this belong to different objects."},
    {"half_field", "The scan is assumed to reach this far to either side; an object's size is not taken there."},
    {"fewest_points", "Fewer returns than this are no object."},
    {"longest_extent", "A longer group of returns is no vehicle."},
    {"join_gap", "Pieces of one outline are joined across missing returns up to this far apart; 0: never."},
    {"split_step",
     "A group of returns is split at a step this deep, if two outlines fit it and one does not; 0: never."},
    {"thinnest", "A group of returns that is all in view and thinner is no vehicle; 0: none is too thin."},
    {"roughest", "A group of returns is no vehicle if its best outline leaves more than this, root mean square."},
    {"cut_silhouettes",
     "An object of which something nearer hides an end, and that shows no face or corner, is reported as a "
     "silhouette."},
    {"free_ends", "An outline that the field's edge cuts is reported by its free end; otherwise it is left out."},
};

constexpr Description kCameraPreprocessing[] = {
    {"baseline", "The two cameras of the pair are taken to be this far apart."},
    {"focal", "The cameras are taken to have this focal length."},
    {"disparity_sigma", "A disparity is assumed to have this standard deviation."},
    {"bearing_sigma", "A bearing is assumed to have this standard deviation."},
    {"width_sigma", "The width of a silhouette is assumed to have this standard deviation."},
};

constexpr Description kKnownSensor[] = {
    {"mounting", "The sensor sits here on the vehicle; absent, at its origin."},
    {"field",
     "The sensor sees this much, so that its lists count for no object elsewhere; absent, the field of the scenario's "
     "own "
     "sensor, or everything."},
    {"field.half_angle", "It sees this far to either side of its axis; absent, all around.", "1.05"},
    {"field.min_range", "It sees nothing nearer than this."},
    {"field.max_range", "It sees nothing further than this; absent, any range.", "120"},
    {"field.shadow",
     "An object hides others behind it up to this share of its own distance; absent, all that are behind it.", "0.5"},
    {"field.blind", "The sensor's own vehicle hides these sectors, at most four; absent, none."},
    {"field.blind[].from", "The sector begins at this azimuth, in the sensor's axes.", "0.3"},
    {"field.blind[].to", "It ends at this one, counter-clockwise.", "0.5"},
    {"range_rate_span",
     "The sensor's range rates are known up to multiples of this; absent, as those of the scenario's radar, or "
     "unambiguous.",
     "60"},
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

constexpr std::array<KindDescriptions, kSensorKinds.size()> kKinds{
    {{"camera", kCamera, kCameraPreprocessing},
     {"laser", kLaser, kLaserPreprocessing},
     {"radar", kRadar, kRadarPreprocessing},
     {"mono_camera", kMonoCamera, kMonoCameraPreprocessing},
     {"odometry", kOdometry, kOdometryPreprocessing}}};
static_assert(std::ranges::is_permutation(kKinds, kSensorKinds, {}, &KindDescriptions::word, &SensorKindRow::word),
              "each kind of sensors has its descriptions");

}  // namespace

Descriptions sensor_descriptions() { return kSensor; }
std::span<const KindDescriptions> kind_descriptions() { return kKinds; }
Descriptions laser_preprocessing_descriptions() { return kLaserPreprocessing; }
Descriptions known_sensor_descriptions() { return kKnownSensor; }

}  // namespace ttf::keys
