#include "fusion/loading/tracker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "fusion/loading/known_sensor.h"

namespace ttf::fusion::loading {

using config::Association, config::Birth, config::BuffWaiting, config::FilterKind, config::MotionModel;
using config::ClassPrior, config::Sizes, config::SystematicErrorsAre, config::TrackerConfig;

namespace {

// Returns whether everything is linear except a radar's measurement. Considered errors and methods for late
// measurements need that.
bool is_straight_and_extended(const TrackerConfig& c) {
  return (c.motion == MotionModel::kConstantVelocity || c.motion == MotionModel::kConstantAcceleration) &&
         c.filter == FilterKind::kExtended;
}

void load_systematic(YamlMap& yaml, TrackerConfig& c, SensorsAre sensors_are) {
  c.systematic = yaml.choice_or<SystematicErrorsAre>(
      "systematic", c.systematic,
      {{"ignore", SystematicErrorsAre::kIgnored}, {"consider", SystematicErrorsAre::kConsidered}});
  if (c.systematic == SystematicErrorsAre::kConsidered && !is_straight_and_extended(c))
    yaml.fail("systematic",
              "must be ignore unless motion is constant_velocity or constant_acceleration and filter "
              "is extended");
  if (sensors_are == SensorsAre::kElsewhere || !yaml.has("sensors")) return;
  for (auto& [name, map] : yaml.named_maps("sensors")) {
    sensors::KnownSensor sensor = load_known_sensor(map);
    sensor.name = name;
    sensor.line = map.line();
    map.finish();
    c.sensors.push_back(std::move(sensor));
  }
  check_biases(c.sensors, yaml, "sensors");
}

void load_association(YamlMap& yaml, TrackerConfig& c) {
  c.association = yaml.choice_or<Association>("association", c.association,
                                              {{"nearest", Association::kNearest}, {"jpda", Association::kJpda}});
  c.birth = yaml.choice_or<Birth>("birth", c.birth, {{"m_of_n", Birth::kMOfN}, {"existence", Birth::kExistence}});
  c.detection_probability = yaml.number_or("detection_probability", c.detection_probability, {0.01, 0.999999});
  c.clutter_density = yaml.number_or("clutter_density", c.clutter_density, {1e-9, 100.0}, "1/m^2");
  c.survival_seconds = yaml.number_or("survival_seconds", c.survival_seconds, {0.01, 1e6}, "s");
  c.initial_existence = yaml.number_or("initial_existence", c.initial_existence, {1e-6, 0.999});
  c.confirm_existence = yaml.number_or("confirm_existence", c.confirm_existence, {1e-5, 0.999999});
  c.delete_existence = yaml.number_or("delete_existence", c.delete_existence, {1e-9, 0.99});
  if (c.delete_existence >= c.initial_existence)
    yaml.fail("delete_existence", "must be below initial_existence: otherwise a track ends as it begins");
  if (c.delete_existence >= c.confirm_existence) yaml.fail("delete_existence", "must be below confirm_existence");
  c.merge_probability = yaml.number_or("merge_probability", c.merge_probability, {0.0, 0.999999});
  if (yaml.has("overlaps")) c.end_overlaps = yaml.choice<bool>("overlaps", {{"keep", false}, {"end", true}});
  c.merge_scans = static_cast<int>(yaml.integer_or("merge_scans", c.merge_scans, {1, 255}, "lists"));
}

// Reads a number, or takes the usual one.
using ReadNumber = double(YamlMap& yaml, std::string_view key, double usual, Range<double> allowed,
                          std::string_view unit);

double usual_or_given(YamlMap& yaml, std::string_view key, double usual, Range<double> allowed, std::string_view unit) {
  return yaml.number_or(key, usual, allowed, unit);
}

// For classes: each has its own usual value, so that the key has no default.
double own_or_given(YamlMap& yaml, std::string_view key, double own, Range<double> allowed, std::string_view unit) {
  return yaml.has(key) ? yaml.number(key, allowed, unit) : own;
}

// As YAML: {length: 4.4, length_sigma: 0.5, width: 1.8, width_sigma: 0.15, correlation: 0}
Sizes load_sizes(YamlMap& yaml, Sizes s, ReadNumber& number) {
  s.length = number(yaml, "length", s.length, {0.1, 20.0}, "m");
  s.length_sigma = number(yaml, "length_sigma", s.length_sigma, {0.01, 5.0}, "m");
  s.width = number(yaml, "width", s.width, {0.1, 5.0}, "m");
  s.width_sigma = number(yaml, "width_sigma", s.width_sigma, {0.01, 2.0}, "m");
  s.correlation = number(yaml, "correlation", s.correlation, {-0.99, 0.99}, "");
  return s;
}

// Returns the class of this name. A class of another name is a finding, and reads as the first one.
ClassPrior class_of(const std::string& name, YamlMap& entry) {
  std::vector<std::string_view> names;
  for (const ClassPrior& one : config::kClassPriors) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  entry.fail("", fmt::format("must be one of {}", fmt::join(names, ", ")));
  return config::kClassPriors.front();
}

// As YAML: {car: {share: 0.9}, truck: {length: 16.5, length_sigma: 0.5}}. A class keeps its own values where an
// entry has none. A share of zero leaves the class out. The order is that of the table, whatever the file's.
std::vector<ClassPrior> load_classes(YamlMap& yaml) {
  std::vector<ClassPrior> classes;
  for (auto& [name, entry] : yaml.named_maps("classes")) {
    ClassPrior prior = class_of(name, entry);
    prior.sizes = load_sizes(entry, prior.sizes, own_or_given);
    prior.speed_sigma = own_or_given(entry, "speed_sigma", prior.speed_sigma, {0.1, 100.0}, "m/s");
    prior.share = own_or_given(entry, "share", prior.share, {0.0, 1.0}, "");
    entry.finish();
    if (prior.share > 0.0) classes.push_back(prior);
  }
  if (classes.empty()) yaml.fail("classes", "must have one with a share above zero");
  std::sort(classes.begin(), classes.end(), [](const ClassPrior& a, const ClassPrior& b) { return a.id < b.id; });
  return classes;
}

// The noise is that of the samples, and the constant errors are those of a drive (fusion/ego/odometry.h).
ego::OdometryErrors load_odometry(YamlMap yaml) {
  ego::OdometryErrors e;
  e.speed_sigma = yaml.number_or("speed_sigma", e.speed_sigma, {0.0, 5.0}, "m/s");
  e.yaw_rate_sigma = yaml.number_or("yaw_rate_sigma", e.yaw_rate_sigma, {0.0, 1.0}, "rad/s");
  e.speed_scale = yaml.number_or("speed_scale", e.speed_scale, {-0.2, 0.2});
  e.speed_scale_sigma = yaml.number_or("speed_scale_sigma", e.speed_scale_sigma, {0.0, 0.2});
  e.yaw_rate_bias = yaml.number_or("yaw_rate_bias", e.yaw_rate_bias, {-0.5, 0.5}, "rad/s");
  e.yaw_rate_bias_sigma = yaml.number_or("yaw_rate_bias_sigma", e.yaw_rate_bias_sigma, {0.0, 0.5}, "rad/s");
  e.acceleration_sigma = yaml.number_or("acceleration_sigma", e.acceleration_sigma, {0.0, 50.0}, "m/s^2");
  e.yaw_acceleration_sigma = yaml.number_or("yaw_acceleration_sigma", e.yaw_acceleration_sigma, {0.0, 50.0}, "rad/s^2");
  e.slip = yaml.number_or("slip", e.slip, {0.0, 0.1}, "rad s^2/m");
  e.lever = yaml.number_or("lever", e.lever, {0.0, 1000.0}, "m");
  e.longest_age =
      yaml.duration_or("longest_age", e.longest_age, {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  yaml.finish();
  return e;
}

// Runs last: the allowed methods depend on the other keys.
void load_late(YamlMap& yaml, TrackerConfig& c) {
  Choices<oosm::Kind> methods;
  for (const oosm::NamedKind& named : oosm::kKinds) methods.emplace_back(named.name, named.kind);
  c.late = yaml.choice_or<oosm::Kind>("late", c.late, methods);
  if (c.late == oosm::Kind::kRewind) return;
  if (!is_straight_and_extended(c))
    yaml.fail("late",
              "must be rewind unless motion is constant_velocity or constant_acceleration and filter is extended: "
              "the other methods support only those estimates");
  if (c.systematic == SystematicErrorsAre::kConsidered)
    yaml.fail("late", "must be rewind if systematic is consider: the other methods carry no biases of sensors");
  if (c.association != Association::kNearest || c.birth != Birth::kMOfN || c.merge_probability != 0.0)
    yaml.fail("late",
              "must be rewind unless association is nearest, birth is m_of_n and merge_probability is 0: the other "
              "methods do not reverse later decisions");
  if (!c.classes.empty())
    yaml.fail("late", "must be rewind with classes: the other methods do not reverse a choice among them");
  if (c.end_overlaps.value_or(false))
    yaml.fail("late", "must be rewind if overlaps is end: the other methods do not bring an ended track back");
}

}  // namespace

TrackerConfig load_tracker(YamlMap& yaml, SensorsAre sensors) {
  TrackerConfig c;
  c.motion = yaml.choice_or<MotionModel>("motion", c.motion,
                                         {{"constant_velocity", MotionModel::kConstantVelocity},
                                          {"constant_acceleration", MotionModel::kConstantAcceleration},
                                          {"ctrv", MotionModel::kCtrv},
                                          {"ctra", MotionModel::kCtra},
                                          {"interacting", MotionModel::kInteracting}});
  c.filter = yaml.choice_or<FilterKind>("filter", c.filter,
                                        {{"extended", FilterKind::kExtended}, {"unscented", FilterKind::kUnscented}});
  c.process_noise = yaml.number_or("process_noise", c.process_noise, {1e-6, 1e4});
  if (yaml.has("cross_noise")) c.cross_noise_line = yaml.line("cross_noise");
  if (yaml.has("cross_noise")) c.cross_noise = yaml.number("cross_noise", {1e-6, 1e4});
  c.turn_noise = yaml.number_or("turn_noise", c.turn_noise, {1e-6, 100.0}, "rad^2/s^3");
  c.mode_seconds = yaml.number_or("mode_seconds", c.mode_seconds, {0.01, 1e4}, "s");
  c.initial_velocity_sigma = yaml.number_or("initial_velocity_sigma", c.initial_velocity_sigma, {0.01, 100.0}, "m/s");
  c.initial_acceleration_sigma =
      yaml.number_or("initial_acceleration_sigma", c.initial_acceleration_sigma, {0.01, 100.0}, "m/s^2");
  c.initial_turn_rate_sigma =
      yaml.number_or("initial_turn_rate_sigma", c.initial_turn_rate_sigma, {0.001, 10.0}, "rad/s");
  c.gate_probability = yaml.number_or("gate_probability", c.gate_probability, {0.5, 0.999999});
  c.confirm_window = static_cast<int>(yaml.integer_or("confirm_window", c.confirm_window, {1, 32}, "lists"));
  c.confirm_hits = static_cast<int>(yaml.integer_or("confirm_hits", c.confirm_hits, {1, c.confirm_window}, "lists"));
  c.coast_misses = static_cast<int>(yaml.integer_or("coast_misses", c.coast_misses, {1, 1000}, "lists"));
  c.delete_misses = static_cast<int>(yaml.integer_or("delete_misses", c.delete_misses, {1, 1000}, "lists"));
  c.delete_position_sigma = yaml.number_or("delete_position_sigma", c.delete_position_sigma, {0.1, 100.0}, "m");
  constexpr Range<Duration> kSilence{Duration::milliseconds(1), Duration::milliseconds(100'000)};
  c.coast_after = yaml.duration_or("coast_after", c.coast_after, kSilence);
  c.delete_after = yaml.duration_or("delete_after", c.delete_after, kSilence);
  if (c.coast_after > c.delete_after) yaml.fail("coast_after", "must not be longer than delete_after");
  c.max_objects = static_cast<int>(yaml.integer_or("max_objects", c.max_objects, {1, 1000}));
  c.buff_waits = yaml.choice_or<BuffWaiting>("buff_waits", c.buff_waits,
                                             {{"schedule", BuffWaiting::kSchedule},
                                              {"measured", BuffWaiting::kMeasured},
                                              {"fixed_lag", BuffWaiting::kFixedLag}});
  c.fixed_lag = yaml.duration_or("fixed_lag", c.fixed_lag, {Duration{}, Duration::milliseconds(10'000)});
  c.max_observations = static_cast<std::size_t>(
      yaml.integer_or("max_observations", static_cast<std::int64_t>(c.max_observations), {1, 4096}));
  c.history_scans = static_cast<std::size_t>(
      yaml.integer_or("history_scans", static_cast<std::int64_t>(c.history_scans), {2, 4096}, "lists"));
  // The storage is reserved beforehand: lists times the tracks that each may have, confirmed and tentative.
  constexpr std::size_t kMostRemembered = 1'000'000;
  const std::size_t tracks = static_cast<std::size_t>(c.max_objects) + 3 * c.max_observations;
  if ((c.history_scans + 1) * tracks > kMostRemembered)
    yaml.fail(
        "history_scans",
        "must keep (history_scans + 1) x (max_objects + 3 max_observations) at most 1000000: the tracker reserves "
        "memory for it");
  c.heading_noise = yaml.number_or("heading_noise", c.heading_noise, {0.0, 100.0}, "rad^2/s");
  c.extent_noise = yaml.number_or("extent_noise", c.extent_noise, {0.0, 100.0}, "m^2/s");
  if (auto sizes = yaml.map_if("sizes")) {
    c.sizes = load_sizes(*sizes, c.sizes, usual_or_given);
    sizes->finish();
  }
  if (yaml.has("classes")) {
    if (yaml.has("sizes")) yaml.fail("sizes", "must be absent with classes: each class has its own");
    c.classes = load_classes(yaml);
    if (c.extent_noise > 0.0) yaml.fail("extent_noise", "must be 0 with classes: sizes that wander are no evidence");
  }
  c.class_confusion = yaml.number_or("class_confusion", c.class_confusion, {1e-6, 0.8});
  if (!yaml.has("classes") && yaml.has("class_confusion"))
    yaml.fail("class_confusion", "must be absent without classes: no report of a class counts");
  if (yaml.has("odometry")) c.odometry_line = yaml.line("odometry");
  if (yaml.has("odometry")) c.odometry = load_odometry(yaml.map("odometry"));
  if (c.odometry && c.cross_noise) yaml.fail("cross_noise", "must be absent with odometry: the vehicle's axes turn");
  load_systematic(yaml, c, sensors);
  load_association(yaml, c);
  load_late(yaml, c);
  return c;
}

metrics::CutOff load_cut_off(YamlMap& yaml) {
  metrics::CutOff cut_off;
  cut_off.distance_m = yaml.number_or("cut_off", cut_off.distance_m, {0.1, 1000.0}, "m");
  cut_off.order = yaml.number_or("order", cut_off.order, {1.0, 16.0}, "");
  return cut_off;
}

}  // namespace ttf::fusion::loading
