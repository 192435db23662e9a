#include "nodes/fusion/fusion_host.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/counted.h"
#include "fusion/sensors/converted_position.h"
#include "fusion/tracks/own_axes.h"
#include "nodes/host/signals.h"
#include "schedules/analysis/ages.h"
#include "schedules/analysis/settled.h"

namespace ttf::nodes::fusion {
namespace {

// Returns the start of the task that reads the image.
schedules::model::CycleInstant image_use(const schedules::model::Cluster& cluster, PduId image) {
  for (const schedules::model::Node& node : cluster.nodes)
    for (const schedules::model::Task& task : node.tasks)
      for (const schedules::model::PortBinding& binding : task.reads)
        if (binding.pdu == image && task.activation.kind == schedules::model::ActivationKind::kTime)
          return task.activation.at;
  throw InputError(cluster.finding(cluster.pdu(image).line, "pdus." + cluster.pdu(image).name, "",
                                   "needs a reader that is activated by time: the image is predicted to that instant"));
}

// Returns the schedule's fusion instants. A fusing task that time does not activate has none. Then the worst
// delay limits the wait, until the sensor's own task, which may wait for others, hands a list to the strategy.
ttf::fusion::strategies::Settling settling(const schedules::model::Cluster& cluster,
                                           const schedules::analysis::AgePath& path) {
  const auto round = schedules::analysis::settled_round(cluster, path.sensor);
  if (!round) return ttf::fusion::strategies::Settling::after(path.fused_worst);
  std::vector<ttf::fusion::strategies::Settling::Step> steps;
  for (const schedules::analysis::Settled& settled : round->instants) steps.push_back({settled.at, settled.measured});
  return {std::move(steps), round->round};
}

recording::records::BelievedBox box_of(const ttf::fusion::tracks::TrackView& view) {
  return {{view.heading, view.sigma_heading},
          {view.speed, view.sigma_speed},
          {view.acceleration, view.sigma_acceleration},
          {view.length, view.sigma_length},
          {view.width, view.sigma_width}};
}

// Returns the period at which a sensor measures.
Duration period_of(const schedules::model::Cluster& cluster, const schedules::model::Sensor& sensor) {
  return sensor.scheduled ? cluster.cycle() * sensor.at.repetition : sensor.period;
}

// Gives the tracker the odometry that the fusion reads.
void set_odometry(const schedules::model::Cluster& cluster, ttf::fusion::config::TrackerConfig& tracker,
                  const std::string& scenario_file) {
  const SensorId id = fused_odometry(cluster);
  if (id == kNoSensor) {
    if (tracker.odometry)
      throw InputError({scenario_file, tracker.odometry_line, "tracker.odometry", "",
                        "must be absent: no fusion task of " + cluster.file + " reads odometry"});
    return;
  }
  if (tracker.cross_noise)
    throw InputError({scenario_file, tracker.cross_noise_line, "tracker.cross_noise",
                      fmt::format("{:g}", *tracker.cross_noise),
                      "must be absent with the odometry of " + cluster.file + ": the vehicle's axes turn"});
  const schedules::model::Sensor& odometry = cluster.sensor(id);
  if (!tracker.odometry) tracker.odometry.emplace();
  tracker.odometry->period = std::max(period_of(cluster, odometry), odometry.longest);
}

// Returns the number of rounds between the sender's stamp and `measured`.
std::int64_t rounds_between(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, GlobalTime near,
                            GlobalTime measured, Duration round) {
  constexpr Duration kNoRounds{std::numeric_limits<std::int64_t>::max()};
  const std::int64_t apart = (measured - host::time_stamp(layout, list, near, kNoRounds)).ns;
  return (apart + (apart < 0 ? -round.ns : round.ns) / 2) / round.ns;
}

}  // namespace

SensorId odometry_of(const schedules::model::Cluster& cluster, const schedules::model::Task& task) {
  for (const schedules::model::PortBinding& binding : task.reads)
    if (const SensorId sensor = cluster.pdu(binding.pdu).sensor;
        sensor != kNoSensor && !schedules::model::row_of(cluster.sensor(sensor).kind).observes)
      return sensor;
  return kNoSensor;
}

SensorId fused_odometry(const schedules::model::Cluster& cluster) {
  for (const schedules::model::Node& node : cluster.nodes)
    for (const schedules::model::Task& task : node.tasks)
      if (task.step == FusionStep::kName)
        if (const SensorId sensor = odometry_of(cluster, task); sensor != kNoSensor) return sensor;
  return kNoSensor;
}

std::vector<ttf::fusion::strategies::SensorTiming> sensor_timings(const schedules::model::Cluster& cluster) {
  std::vector<ttf::fusion::strategies::SensorTiming> timings;
  for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(cluster)) {
    const schedules::model::Sensor& sensor = cluster.sensor(path.sensor);
    // A detector chooses among its pictures: the instants of its lists are not known beforehand.
    const bool scheduled = sensor.scheduled && !path.chosen;
    const GlobalTime first =
        scheduled ? schedules::model::next_occurrence(cluster.flexray, sensor.at, GlobalTime{}).time : GlobalTime{};
    timings.push_back({path.sensor, settling(cluster, path), scheduled, first, period_of(cluster, sensor),
                       schedules::model::row_of(sensor.kind).rates});
  }
  return timings;
}

ttf::fusion::config::TrackerConfig tracker_in(const schedules::model::Cluster& cluster,
                                              ttf::fusion::config::TrackerConfig tracker,
                                              const std::string& scenario_file) {
  set_odometry(cluster, tracker, scenario_file);
  if (tracker.sensors.empty()) return tracker;
  std::vector<ttf::fusion::sensors::KnownSensor> by_id(cluster.sensors.size());
  std::vector<std::string> names;
  for (const schedules::model::Sensor& sensor : cluster.sensors) names.push_back(sensor.name);
  for (ttf::fusion::sensors::KnownSensor& sensor : tracker.sensors) {
    const auto found = std::find(names.begin(), names.end(), sensor.name);
    if (found == names.end())
      throw InputError({scenario_file, sensor.line, "tracker.sensors." + sensor.name, "",
                        "must be a sensor of " + cluster.file + ": " + joined(names, " or ")});
    by_id[static_cast<std::size_t>(found - names.begin())] = std::move(sensor);
  }
  tracker.sensors = std::move(by_id);
  return tracker;
}

FusionHost::FusionHost(const schedules::model::Cluster& cluster, ttf::fusion::strategies::StrategyKind kind,
                       const ttf::fusion::config::TrackerConfig& tracker)
    : strategy(ttf::fusion::strategies::make_strategy(kind, tracker, sensor_timings(cluster))),
      sensors(tracker.sensors), most_objects(static_cast<std::size_t>(tracker.max_objects)),
      most_observations(tracker.max_observations) {
  if (tracker.odometry) ego.emplace(*tracker.odometry);
}

void FusionHost::to_own_axes(ttf::fusion::tracks::TrackView& view) const {
  if (!ego) return;
  if (const auto state = ego->at(view.valid_at)) ttf::fusion::tracks::to_own_axes(view, *state, ego->errors());
}

bool RoundsBelieved::believed(std::int64_t rounds) {
  if (rounds != rounds_ && claimed_ != rounds) {
    claimed_ = rounds;
    return false;
  }
  rounds_ = rounds;
  claimed_.reset();
  return true;
}

FusionStep::FusionStep(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                       std::shared_ptr<FusionHost> host)
    : host_(std::move(host)), round_(cluster.round()) {
  std::size_t most = 0;
  for (const schedules::model::PortBinding& binding : task.reads) {
    const schedules::model::PduLayout& layout = cluster.pdu(binding.pdu);
    if (static_cast<std::size_t>(layout.max_elements) > host_->most_observations)
      throw InputError(cluster.finding(layout.line, "pdus." + layout.name + ".max_elements",
                                       std::to_string(layout.max_elements),
                                       "must be at most " + std::to_string(host_->most_observations) +
                                           " for a list that is fused (max_observations of the scenario's tracker)"));
    std::optional<sensors::ObservationCodec>& codec = codecs_.emplace_back();
    if (layout.sensor != kNoSensor && !schedules::model::row_of(cluster.sensor(layout.sensor).kind).observes)
      odometry_ = host::bind_element<4>(cluster, layout, {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"});
    else
      codec.emplace(cluster, binding.pdu);
    most = std::max(most, static_cast<std::size_t>(cluster.pdu(binding.pdu).max_elements));
  }
  observations_.reserve(most);
  rounds_.resize(task.reads.size());
}

void FusionStep::run(host::StepContext& context) {
  // Before the node has integrated, a list may arrive and activate this task. Such a list has no age.
  if (!context.global_time) {
    for (host::Input& input : context.inputs) input.discarded = input.fresh;
    return;
  }
  ++host_->step;
  const GlobalTime now = context.stamp.global;
  for (const bool objects : {false, true})
    for (std::size_t i = 0; i < context.inputs.size(); ++i) {
      host::Input& input = context.inputs[i];
      if (!input.fresh || !input.list || codecs_[i].has_value() != objects)
        continue;  // each list is taken exactly once
      const std::optional<GlobalTime> measured = instant_of(i, input, now);
      input.discarded = !measured || !(objects ? take_objects(context, i, input, *measured)
                                               : take_odometry(context, input, *measured));
    }
  record_stop(context);
  host_->strategy->fuse(now);
  context.unlisted = host_->strategy->unlisted() - host_->unlisted;
  host_->unlisted += context.unlisted;
  record_result(context);
}

std::optional<GlobalTime> FusionStep::instant_of(std::size_t port, host::Input& input, GlobalTime now) {
  // Measurements lie in the past: up to seven eighths of a round, the rest allows for clocks ahead of this one.
  const GlobalTime about = now - Duration{round_.ns / 8 * 3};
  const GlobalTime measured = host::time_stamp(*input.layout, *input.list, about, round_);
  if (!rounds_[port].believed(rounds_between(*input.layout, *input.list, about, measured, round_))) return std::nullopt;
  return measured;
}

bool FusionStep::take_odometry(const host::StepContext& context, const host::Input& input, GlobalTime measured) {
  if (!host_->ego || measured > context.stamp.global || host::element_count(*input.layout, *input.list) == 0)
    return false;
  const auto value = [&](std::size_t s) { return host::element_value(*input.layout, *input.list, 0, odometry_[s]); };
  const ttf::fusion::ego::OdometrySample sample{measured, value(0), value(1), value(2), value(3)};
  if (!host_->ego->accept(sample)) return false;
  host_->odometry_stopped = false;
  host_->odometry = {input.layout->sensor, input.list->sequence};
  context.sink->on(recording::records::OdometryTaken{context.stamp, host_->step, host_->odometry, measured,
                                                     sample.speed, sample.yaw_rate, sample.speed_sigma,
                                                     sample.yaw_rate_sigma});
  return true;
}

// Says once that the odometry has stopped. Before its first sample it has not begun.
void FusionStep::record_stop(const host::StepContext& context) const {
  if (!host_->ego || !host_->ego->started() || host_->odometry_stopped) return;
  if (!host_->ego->has_stopped(context.stamp.global)) return;
  host_->odometry_stopped = true;
  recording::records::OdometryTaken said;
  said.stamp = context.stamp;
  said.step = host_->step;
  said.id = host_->odometry;
  said.measured = host_->ego->newest().at;
  said.stopped = true;
  context.sink->on(said);
}

bool FusionStep::take_objects(const host::StepContext& context, std::size_t port, const host::Input& input,
                              GlobalTime measured) {
  const std::optional<ttf::fusion::ego::EgoState> then = host_->ego ? host_->ego->at(measured) : std::nullopt;
  if (host_->ego && !then) return false;
  codecs_[port]->decode(*input.list, observations_);
  const SensorId id = input.layout->sensor;
  if (const ttf::fusion::sensors::KnownSensor* sensor = ttf::fusion::sensors::known(host_->sensors, id))
    for (ttf::fusion::sensors::Observation& observation : observations_)
      ttf::fusion::sensors::place(observation, id, *sensor);
  record(context, input, measured);
  if (!then) {
    host_->strategy->accept({{id, input.list->sequence}, measured, observations_});
    return true;
  }
  for (ttf::fusion::sensors::Observation& observation : observations_) {
    observation.sensor = id;
    ttf::fusion::ego::carry(observation, *then);
  }
  host_->strategy->accept({{id, input.list->sequence}, measured, observations_, then->vehicle});
  return true;
}

void FusionStep::record(const host::StepContext& context, const host::Input& input, GlobalTime measured) const {
  recording::records::FusionInput in;
  in.stamp = context.stamp;
  in.step = host_->step;
  in.pdu = input.pdu;
  in.sensor = input.layout->sensor;
  in.sequence = input.list->sequence;
  in.measured = measured;
  in.count = static_cast<std::uint16_t>(observations_.size());
  in.fragments = input.list->bytes;
  context.sink->on(in);
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const ttf::fusion::sensors::Observation& observation = observations_[i];
    recording::records::ObservationSeen seen;
    seen.stamp = context.stamp;
    seen.id = {input.layout->sensor, input.list->sequence};
    seen.measured = measured;
    seen.index = static_cast<std::uint16_t>(i);
    const ttf::fusion::sensors::PlanePosition plane = plane_position(observation, observation.from);
    seen.x = plane.x;
    seen.y = plane.y;
    seen.sxx = plane.sxx;
    seen.sxy = plane.sxy;
    seen.syy = plane.syy;
    context.sink->on(seen);
  }
}

void FusionStep::record_result(const host::StepContext& context) const {
  const ttf::fusion::strategies::Strategy& strategy = *host_->strategy;
  for (const ttf::fusion::strategies::FusedList& list : strategy.last_fused())
    context.sink->on(recording::records::ListFused{context.stamp, host_->step, list.id, list.measured,
                                                   static_cast<recording::records::Disposition>(list.disposition),
                                                   list.innovations.squares, list.innovations.degrees});
  for (ttf::fusion::tracks::TrackView track : strategy.tracks()) {
    if (!track.confirmed) continue;
    host_->to_own_axes(track);
    recording::records::TrackState state{context.stamp,
                                         host_->step,
                                         track.id,
                                         track.valid_at,
                                         std::span<const double, 6>(track.state.data(), 6),
                                         std::span<const double, 36>(track.covariance.data(), 36),
                                         false,
                                         std::nullopt};
    context.sink->on(state);
  }
  context.sink->on(recording::records::FusionStep{context.stamp, host_->step,
                                                  static_cast<std::uint16_t>(strategy.confirmed_count()),
                                                  static_cast<std::uint16_t>(strategy.tentative_count())});
}

ImageOutput::ImageOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                         std::shared_ptr<FusionHost> host)
    : cluster_(cluster), host_(std::move(host)) {
  const PduId pdu = host::binding_of(task.writes, "image").pdu;
  use_ = image_use(cluster, pdu);
  signals_ = bind_image(cluster, cluster.pdu(pdu));
  views_.reserve(host_->most_objects);
  objects_.reserve(static_cast<std::size_t>(cluster.pdu(pdu).max_elements));
}

void ImageOutput::run(host::StepContext& context) {
  const GlobalTime use = schedules::model::next_occurrence(cluster_.flexray, use_, context.stamp.global).time;
  host_->strategy->image(use, views_);
  for (ttf::fusion::tracks::TrackView& view : views_) host_->to_own_axes(view);
  // The list holds the nearest objects, in the order of their distance: it never depends on how tracks are stored.
  std::sort(views_.begin(), views_.end(),
            [](const ttf::fusion::tracks::TrackView& a, const ttf::fusion::tracks::TrackView& b) {
              const double ra = a.state.head<2>().squaredNorm(), rb = b.state.head<2>().squaredNorm();
              return ra != rb ? ra < rb : a.id < b.id;
            });
  host::Output& out = context.outputs[0];
  const int count = std::min(static_cast<int>(views_.size()), out.layout().max_elements);
  out.begin(sequence_, count, use);
  objects_.clear();
  for (int i = 0; i < count; ++i) {
    const ttf::fusion::tracks::TrackView& view = views_[static_cast<std::size_t>(i)];
    encode_image_object(view, out, i, signals_);
    objects_.push_back(decode_image_object(out.layout(), out.view(), i, signals_));
    context.sink->on(recording::records::TrackState{
        context.stamp, host_->step, view.id, use, std::span<const double, 6>(view.state.data(), 6),
        std::span<const double, 36>(view.covariance.data(), 36), true, box_of(view)});
  }
  recording::records::ImageWritten written;
  written.stamp = context.stamp;
  written.sequence = sequence_;
  written.valid_at = use;
  written.objects = objects_;
  written.newest = host_->strategy->newest();
  written.newest_measurement = host_->strategy->newest_measured();
  context.sink->on(written);
  ++sequence_;
}

}  // namespace ttf::nodes::fusion
