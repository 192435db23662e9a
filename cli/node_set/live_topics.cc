#include "cli/node_set/live_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "bus/dds/ros/publisher.h"
#include "recording/records/enumerations.h"
#include "sim/drives/observer.h"
#include "sim/drives/step_catalog.h"

namespace ttf::cli::node_set {
namespace {

using sim::drives::StepRole;

constexpr Duration kHealthPeriod = Duration::milliseconds(1000);

// Returns the period of the first task of that role that time activates, in real time; zero without one.
Duration period_of(const NodeSet& set, StepRole role, const nodes::runner::DriveClock& clock) {
  for (const auto& [node, task] : tasks_with(set.cluster, role))
    if (task->activation.kind == schedules::model::ActivationKind::kTime)
      return clock.in_real(set.cluster.cycle() * task->activation.at.repetition);
  return {};
}

Duration period_of(const NodeSet& set, const schedules::model::Sensor& sensor, const nodes::runner::DriveClock& clock) {
  return clock.in_real(sensor.scheduled ? set.cluster.cycle() * sensor.at.repetition : sensor.longest_period());
}

std::int64_t utc_ns(bus::ports::MachineTime at) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() + (at - bus::ports::host_now()).ns;
}

bool publishes_truth(const NodeSet& set, NodeId node) {
  return !set.cluster.sensors.empty() && set.cluster.sensors.front().device == node;
}

bus::dds::ros::RosOptions options_of(const NodeSet& set, const nodes::runner::DriveClock& clock, NodeId node) {
  bus::dds::ros::RosOptions options;
  options.domain = bus::dds::ros::domain_of_environment();
  options.origin_realtime_ns = utc_ns(clock.origin());
  options.time_scale_ppm = clock.scale_ppm();
  options.image_period = period_of(set, StepRole::kImageOutput, clock);
  options.step_period = period_of(set, StepRole::kFusion, clock);
  options.health_period = kHealthPeriod;
  options.images = has_role(set.cluster.node(node), StepRole::kImageOutput);
  options.tracks = has_role(set.cluster.node(node), StepRole::kFusion);
  if (publishes_truth(set, node)) {
    const sim::drives::Scenario& scenario = set.scenario;
    options.truth_objects =
        static_cast<std::uint16_t>(scenario.truth ? scenario.truth->objects.size() : scenario.world.objects.size());
    options.truth_period = period_of(set, set.cluster.sensors.front(), clock);
  }
  return options;
}

std::string us(Duration duration) { return fmt::format("{:.1f}", in_us(duration)); }

class DdsTopics final : public LiveTopics {
 public:
  DdsTopics(const NodeSet& set, NodeId node, const nodes::runner::DriveClock& clock,
            const sim::drives::Surroundings& around)
      : name_(set.cluster.node(node).name), publisher_(options_of(set, clock, node)) {
    if (publishes_truth(set, node)) truth_.emplace(*around.scene, set.cluster.nodes.size(), publisher_);
  }

  std::vector<recording::records::Sink*> sinks() override {
    std::vector<recording::records::Sink*> sinks{&publisher_};
    if (truth_) sinks.push_back(&*truth_);
    return sinks;
  }
  void health(const nodes::runner::Health& health, TrueTime at) override;

 private:
  std::string name_;
  bus::dds::ros::RosPublisher publisher_;
  std::optional<sim::drives::Observer> truth_;
};

void DdsTopics::health(const nodes::runner::Health& health, TrueTime at) {
  const std::array values{fmt::format("{}", health.timing.late_wakeups),
                          fmt::format("{}", health.timing.slots_missed),
                          fmt::format("{}", health.timing.late_frames),
                          fmt::format("{}", health.timing.frames_lost),
                          us(health.wakeup_p50),
                          us(health.wakeup_p99),
                          us(health.wakeup_longest),
                          us(health.largest_offset)};
  const std::array<bus::dds::ros::HealthValue, 8> entries{{{"late wake-ups", values[0]},
                                                           {"slots missed", values[1]},
                                                           {"late frames", values[2]},
                                                           {"frames lost", values[3]},
                                                           {"wake-up lateness p50 [us]", values[4]},
                                                           {"wake-up lateness p99 [us]", values[5]},
                                                           {"wake-up lateness max [us]", values[6]},
                                                           {"largest offset correction [us]", values[7]}}};
  using recording::records::CanState;
  const CanState can = health.can_state.value_or(CanState::kActive);
  std::string words(health.state ? to_text(*health.state) : "running");
  if (can != CanState::kActive) words += fmt::format(", CAN {}", to_text(can));
  const bool good =
      (!health.state || *health.state == recording::records::PocKind::kNormalActive) && can == CanState::kActive;
  publisher_.health(
      {at, good ? bus::dds::ros::HealthLevel::kOk : bus::dds::ros::HealthLevel::kWarn, name_, words, entries});
}

}  // namespace

void check_topics(const NodeSet& set) {
  const nodes::runner::DriveClock any({}, set.time_scale_ppm);
  for (std::size_t node = 0; node < set.cluster.nodes.size(); ++node)
    bus::dds::ros::validate(options_of(set, any, static_cast<NodeId>(node)));
}

void try_topics(const NodeSet& set) {
  const nodes::runner::DriveClock any({}, set.time_scale_ppm);
  bus::dds::ros::try_domain(options_of(set, any, NodeId{0}));
}

std::unique_ptr<LiveTopics> make_topics(const NodeSet& set, NodeId node, const nodes::runner::DriveClock& clock,
                                        const sim::drives::Surroundings& around) {
  return std::make_unique<DdsTopics>(set, node, clock, around);
}

}  // namespace ttf::cli::node_set
