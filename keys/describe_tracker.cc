#include "keys/descriptions.h"

namespace ttf::keys {
namespace {

constexpr Description kTracker[] = {
    {"motion", "Objects are assumed to move like this; `interacting` weighs straight motion and bends."},
    {"filter", "The filter linearises to first order, or uses sigma points."},
    {"process_noise",
     "The white noise that drives each axis has this density: of acceleration [m^2/s^3], or of jerk [m^2/s^5] for "
     "`constant_acceleration` and `ctra`."},
    {"cross_noise",
     "The noise across the vehicle's x axis has this density, if it differs; for `constant_velocity` and "
     "`constant_acceleration`.",
     "0.001"},
    {"turn_noise", "The white noise that drives the turn rate has this density; for bends and measured headings."},
    {"mode_seconds", "An object keeps to one model this long on the average; for `interacting`."},
    {"initial_velocity_sigma", "The velocity of a new track has this standard deviation on each axis."},
    {"initial_acceleration_sigma", "The acceleration of a new track has this standard deviation."},
    {"initial_turn_rate_sigma", "The turn rate of a new track has this standard deviation."},
    {"gate_probability", "The right observation is in its gate with this probability."},
    {"confirm_window", "A track is confirmed by its hits among the last so many lists; with `birth: m_of_n`."},
    {"confirm_hits", "So many hits confirm a track; with `birth: m_of_n`."},
    {"coast_misses", "A track is coasting after so many lists in a row without an observation."},
    {"delete_misses", "A confirmed track ends after so many lists in a row without an observation."},
    {"delete_position_sigma", "A track ends when the standard deviation of its position is above this."},
    {"coast_after", "A track is coasting this long after its newest observation."},
    {"delete_after", "A track ends this long after its newest observation."},
    {"max_objects", "The tracker has room for so many confirmed tracks."},
    {"buff_waits",
     "BUFF holds a list until the schedule excludes an older one, until the longest delay measured so far is over, or "
     "for a fixed lag."},
    {"fixed_lag", "BUFF fuses a list this long after its measurement; with `buff_waits: fixed_lag`."},
    {"max_observations", "A list has at most so many observations."},
    {"history_scans", "A late list is taken in up to so many lists back."},
    {"heading_noise", "The heading of an object wanders with this spectral density."},
    {"sizes", "Objects are assumed to be so long and wide, until sensors have seen it; without `classes`."},
    {"sizes.length", "Lengths have this mean."},
    {"sizes.length_sigma", "Lengths have this standard deviation."},
    {"sizes.width", "Widths have this mean."},
    {"sizes.width_sigma", "Widths have this standard deviation."},
    {"sizes.correlation", "Length and width have this correlation."},
    {"classes",
     "An object is the most probable of these classes: `car`, `truck`, `van`, `motorbike`, `cyclist`, `pedestrian`; "
     "absent, all objects have `sizes`; needs `late: rewind` and no `extent_noise`."},
    {"classes.NAME.length", "Lengths of the class have this mean; absent, its own.", "16.5"},
    {"classes.NAME.length_sigma", "Lengths of the class have this standard deviation; absent, its own.", "0.5"},
    {"classes.NAME.width", "Widths of the class have this mean; absent, its own.", "2.55"},
    {"classes.NAME.width_sigma", "Widths of the class have this standard deviation; absent, its own.", "0.05"},
    {"classes.NAME.correlation", "Length and width of the class have this correlation; absent, none.", "0.5"},
    {"classes.NAME.speed_sigma",
     "Speeds of the class have this standard deviation about standing; absent, its own; for clusters with `odometry`.",
     "5"},
    {"classes.NAME.share", "The class is so frequent, relative to the others; absent, its own; 0 leaves the class out.",
     "0.1"},
    {"class_confusion", "A sensor reports any other class than the right one with this probability; for `classes`."},
    {"odometry",
     "The odometry of the sensors' vehicle has these errors; for clusters that have a sensor of the kind `odometry`."},
    {"odometry.speed_sigma", "The noise of a sample's speed has this standard deviation."},
    {"odometry.yaw_rate_sigma", "The noise of a sample's yaw rate has this standard deviation."},
    {"odometry.speed_scale", "The measured speed is too large by this known share of it."},
    {"odometry.speed_scale_sigma", "The unknown rest of that share has this standard deviation."},
    {"odometry.yaw_rate_bias", "The measured yaw rate is too large by this known value."},
    {"odometry.yaw_rate_bias_sigma", "The unknown rest of that bias has this standard deviation."},
    {"odometry.acceleration_sigma", "The vehicle's acceleration after the newest sample has this standard deviation."},
    {"odometry.yaw_acceleration_sigma",
     "The vehicle's yaw acceleration after the newest sample has this standard deviation."},
    {"odometry.slip", "In a bend, the rear tyres slip by this angle for each m/s^2 of lateral acceleration."},
    {"odometry.lever", "The noise of the yaw rate moves objects at this distance; nearer ones move less."},
    {"odometry.longest_age", "The odometry has stopped when its newest sample is older than this."},
    {"extent_noise", "The length and width of an object wander with this spectral density."},
    {"systematic",
     "Unknown biases of the sensors are ignored, or considered in the covariance of every track; `consider` needs "
     "straight motion and the extended filter."},
    {"sensors", "The tracker knows this of the cluster's sensors, by their names."},
    {"association", "A track takes the most probable observation, or all in its gate with their probabilities."},
    {"birth", "A track is confirmed by M hits in N lists, or by the probability that its object exists."},
    {"detection_probability",
     "A list shows a tracked object that its sensor can see with this probability; for `jpda` and `existence`."},
    {"clutter_density", "A list has so many observations of nothing to the square metre; for `jpda` and `existence`."},
    {"survival_seconds", "An object is there this long on the average; for `existence`."},
    {"initial_existence", "The object of a new track exists with this probability; for `existence`."},
    {"confirm_existence", "A track is confirmed from this probability of existence; for `existence`."},
    {"delete_existence", "A track ends below this probability of existence; for `existence`."},
    {"overlaps",
     "Of two confirmed tracks in one place, the less certain one ends, or both are kept; absent, it ends if the lists "
     "are recorded scans.",
     "end"},
    {"merge_probability", "Two confirmed tracks within this quantile of each other become one; 0: never."},
    {"merge_scans", "Two tracks become one after so many lists in a row that leave them so close."},
    {"late",
     "ADVA takes a late list in by this method, TT only if it is `clone`; but for `rewind` it needs straight motion, "
     "the "
     "extended filter, default association, birth and `systematic`, and no `classes`."},
};

}  // namespace

Descriptions tracker_descriptions() { return kTracker; }

}  // namespace ttf::keys
