#include "sensors/recorded/recorded.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "nodes/host/signals.h"
#include "sensors/observation_codec.h"

namespace ttf::sensors::recorded {
namespace {

using recording::rows::RecordedObservation;

// The recording lacks the tracked vehicle's size. This is a passenger car's (the paper's Touran: 4.39 m x 1.79 m).
constexpr double kCarLength = 4.39, kCarWidth = 1.79;

bool is_radar(const schedules::model::PduLayout& layout) {
  return schedules::model::find_signal(layout.element, "range").has_value();
}

std::vector<std::size_t> bind_raw(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout) {
  return is_radar(layout) ? nodes::host::bind_elements<3>(cluster, layout, {"range", "bearing", "range_rate"})
                          : nodes::host::bind_elements<2>(cluster, layout, {"x", "y"});
}

std::size_t signals_of(const RecordedObservation& row) {
  return row.kind == RecordedObservation::Kind::kRangeBearingRate ? 3 : 2;
}

// Keys that are absent have the values of `usual`.
RecordedNoise load_noise(YamlMap& yaml, const RecordedNoise& usual) {
  RecordedNoise noise;
  noise.position_m = yaml.number_or("position", usual.position_m, {0.001, 4.0}, "m");
  noise.range_m = yaml.number_or("range", usual.range_m, {0.001, 4.0}, "m");
  noise.bearing_rad = yaml.number_or("bearing", usual.bearing_rad, {0.0001, 0.5}, "rad");
  noise.range_rate_mps = yaml.number_or("range_rate", usual.range_rate_mps, {0.001, 4.0}, "m/s");
  return noise;
}

}  // namespace

bool is_recorded(const schedules::model::Cluster& cluster) {
  return schedules::model::has_step(cluster, "recorded_source");
}

const RecordedNoise& RecordedNoises::of(std::string_view sensor) const {
  for (const OfSensor& one : own)
    if (one.sensor == sensor) return one.noise;
  return usual;
}

RecordedNoises load_recorded_noises(YamlMap& yaml) {
  RecordedNoises noises;
  noises.usual = load_noise(yaml, {});
  if (!yaml.has("sensors")) return noises;
  for (auto& [name, map] : yaml.named_maps("sensors")) {
    noises.own.push_back({name, load_noise(map, noises.usual), map.line()});
    map.finish();
  }
  return noises;
}

RecordedScene::RecordedScene(const recording::rows::RecordedInput& input, TrueTime start)
    : rows_(input.truth), start_(start) {
  TTF_CHECK(!rows_.empty(), "a recording without ground truth");
}

void RecordedScene::states_at(TrueTime at, std::vector<sim::world::ObjectState>& out) const {
  const double t = static_cast<double>((at - start_).ns) * 1e-3;  // microseconds into the recording
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), t, [](double time, const auto& row) {
    return time < static_cast<double>(row.time_us_from_start);
  });
  out.clear();
  // The last row's own instant belongs to the recording; before the first row and after the last the truth is unknown.
  const std::int64_t ns = (at - start_).ns;
  const bool at_the_end = after == rows_.end() && ns % 1000 == 0 && ns / 1000 == rows_.back().time_us_from_start;
  if (after == rows_.begin() || (after == rows_.end() && !at_the_end)) return;
  const auto& a = *(after - 1);
  const auto& b = after == rows_.end() ? rows_.back() : *after;
  const double h = static_cast<double>(b.time_us_from_start - a.time_us_from_start) * 1e-6;
  double x = a.x, y = a.y, vx = a.vx, vy = a.vy;
  if (h > 0.0) {
    const double s = (t - static_cast<double>(a.time_us_from_start)) * 1e-6 / h;
    const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s);
    const double h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
    x = h00 * a.x + h10 * h * a.vx + h01 * b.x + h11 * h * b.vx;
    y = h00 * a.y + h10 * h * a.vy + h01 * b.y + h11 * h * b.vy;
    vx = a.vx + s * (b.vx - a.vx);
    vy = a.vy + s * (b.vy - a.vy);
  }
  sim::world::ObjectState state{};
  state.id = ObjectId{0};
  state.x = x;
  state.y = y;
  state.speed = std::hypot(vx, vy);
  state.heading = std::atan2(vy, vx);
  state.yaw_rate = a.yaw_rate;
  state.length = kCarLength;
  state.width = kCarWidth;
  out.push_back(state);
}

RecordedSource::RecordedSource(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                               SensorId sensor, PlayedRows rows, TrueTime start)
    : sensor_(sensor), rows_(std::move(rows)), start_(start), period_(cluster.sensor(sensor).period),
      signals_(bind_raw(cluster, cluster.pdu(nodes::host::binding_of(task.writes, "raw").pdu))) {
  TTF_CHECK(rows_.at.size() == rows_.times.size(), "{} rows at {} times", rows_.at.size(), rows_.times.size());
  if (std::none_of(rows_.at.begin(), rows_.at.end(), [](const auto& row) { return row.has_value(); }))
    throw InputError(cluster.finding(cluster.sensor(sensor).line, "sensors." + cluster.sensor(sensor).name, "",
                                     "the recording has no row of this sensor within the drive"));
  for (const auto& row : rows_.at)
    if (row && signals_of(*row) != signals_.size()) {
      const schedules::model::PduLayout& raw = cluster.pdu(nodes::host::binding_of(task.writes, "raw").pdu);
      throw InputError(
          cluster.finding(raw.line, "pdus." + raw.name, "",
                          "must have the signals of the recording's rows of this sensor: x and y of a laser, range, "
                          "bearing and range_rate of a radar"));
    }
}

// Returns null if nothing was measured then.
const RecordedObservation* RecordedSource::row_at(TrueTime now) {
  const std::vector<Duration>& times = rows_.times;
  const Duration since = now - start_;
  auto nearest = std::lower_bound(times.begin(), times.end(), since);
  if (nearest == times.end() || (nearest != times.begin() && since - *(nearest - 1) <= *nearest - since)) --nearest;
  const auto n = static_cast<std::size_t>(nearest - times.begin());
  const Duration off = std::max(since - *nearest, *nearest - since);
  if (off * 2 >= period_ || n == last_ || !rows_.at[n]) return nullptr;
  last_ = n;
  return &*rows_.at[n];
}

void RecordedSource::run(nodes::host::StepContext& context) {
  const RecordedObservation* const played = row_at(context.stamp.true_time);
  if (played == nullptr) return;
  const RecordedObservation& row = *played;
  nodes::host::Output& raw = context.outputs[0];
  raw.begin(context.measurement, 1, GlobalTime{});
  const bool radar = signals_of(row) == 3;
  const double radar_values[] = {row.range, row.bearing, row.range_rate};
  const double position[] = {row.x, row.y};
  for (std::size_t s = 0; s < signals_.size(); ++s) raw.set(0, signals_[s], radar ? radar_values[s] : position[s]);
  const ObjectId truth[] = {ObjectId{0}};
  recording::records::Measured measured;
  measured.stamp = context.stamp;
  measured.id = {sensor_, context.measurement};
  measured.truth_ids = truth;
  context.sink->on(measured);
}

RecordedPreprocessing::RecordedPreprocessing(const schedules::model::Cluster& cluster,
                                             const schedules::model::Task& task, const RecordedNoise& noise)
    : sensor_(cluster.pdu(nodes::host::binding_of(task.reads, "raw").pdu).sensor), noise_(noise) {
  const schedules::model::PduLayout& raw = cluster.pdu(nodes::host::binding_of(task.reads, "raw").pdu);
  const schedules::model::PduLayout& objects = cluster.pdu(nodes::host::binding_of(task.writes, "objects").pdu);
  radar_ = is_radar(raw);
  raw_ = bind_raw(cluster, raw);
  signals_ =
      radar_ ? nodes::host::bind_elements<6>(
                   cluster, objects,
                   {"range", "bearing", "range_rate", "sigma_range", "sigma_bearing", "sigma_range_rate"})
             : nodes::host::bind_elements<12>(cluster, objects,
                                              {"x", "y", "sigma_x", "sigma_y", "heading", "length", "width",
                                               "correlation", "sigma_heading", "sigma_length", "sigma_width", "valid"});
}

void RecordedPreprocessing::run(nodes::host::StepContext& context) {
  const auto measurement = measurement_of(context, sensor_);
  if (!measurement) return;
  const nodes::host::Input& raw = context.inputs[0];
  nodes::host::Output& out = context.outputs[0];
  const int count = std::min(nodes::host::element_count(*raw.layout, *raw.list), out.layout().max_elements);
  out.begin(measurement->sequence, count, measurement->at);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) { return nodes::host::element_value(*raw.layout, *raw.list, i, raw_[s]); };
    const auto set = [&](std::size_t s, double physical) { out.set(i, signals_[s], physical); };
    for (std::size_t s = 0; s < raw_.size(); ++s) set(s, value(s));
    if (radar_) {
      set(3, noise_.range_m);
      set(4, noise_.bearing_rad);
      set(5, noise_.range_rate_mps);
    } else {
      set(2, noise_.position_m);
      set(3, noise_.position_m);
      // The recording lacks heading and extent: their valid bits stay clear. Its positions are the object's.
      for (const std::size_t s : {4u, 5u, 6u, 7u, 8u, 9u, 10u}) set(s, 0.0);
      set(11, kValidCorner);
    }
  }
}

}  // namespace ttf::sensors::recorded
