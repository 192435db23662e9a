// The loop closed in real time, by a clock that the test turns: the vehicle that each sensor sees is that of the
// actuator's log.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "nodes/runner/vehicle/line.h"
#include "tests/nodes/runner/live_node_set.h"
#include "tests/nodes/runner/turned_host.h"

namespace ttf::nodes::runner::vehicle {
namespace {

using sim::world::vehicle::Actuation;
using sim::world::vehicle::Driven;

// The commands that an actuator applied, and how a sensor saw the vehicle as it measured.
struct LoopRecords final : recording::records::Sink {
  struct Seen {
    TrueTime at{};
    sim::world::EgoState ego;
  };
  using recording::records::Sink::on;
  void on(const recording::records::CommandTaken& taken) override {
    if (taken.verdict == recording::records::CommandVerdict::kApplied)
      applied.push_back({TrueTime{} + (taken.from - sim::engine::kFirstCycle), taken.acceleration, taken.steering});
  }
  void on(const recording::records::Measured& measured) override {
    const TrueTime at = measured.stamp.true_time;
    if (device) seen.push_back({TrueTime{} + (at - sim::engine::kFirstCycle), around.scene->ego_at(at)});
  }
  sim::drives::Surroundings around;
  bool device = false;
  std::vector<Actuation> applied;
  std::vector<Seen> seen;
};

class LiveLoop : public testing::Test {
 protected:
  LiveLoop() { schedules::model::bind_ports(cluster_, sim::drives::step_ports()); }
  // Each process wakes up late, by a draw up to `late`.
  void drive(Duration lasts, Duration late) {
    TurnedHost host(kOrigin - ms(50));
    const DriveClock clock(kOrigin, 1'000'000);
    test::MemoryLiveBusOptions options;
    for (const schedules::model::CanBus& can : cluster_.can_buses) options.can_buses.push_back(can.flexible_data_rate);
    options.now = [&host] { return host.now(); };
    test::MemoryLiveBus bus(options);
    const std::vector<std::size_t> on_the_line = processes_of(cluster_);
    records_ = std::vector<LoopRecords>(cluster_.nodes.size());
    counts_.assign(cluster_.nodes.size(), std::nullopt);
    std::vector<std::unique_ptr<bus::ports::LiveMedium>> media;
    std::vector<std::unique_ptr<Line>> lines(cluster_.nodes.size());
    std::vector<std::function<void()>> bodies;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      media.push_back(bus.join());
      LoopRecords& records = records_[n];
      records.around = sim::drives::surroundings_of(scenario_, cluster_, 1, 0, nullptr);
      if (std::find(on_the_line.begin(), on_the_line.end(), n) != on_the_line.end())
        lines[n] = std::make_unique<Line>(
            LinePlan{"loop-test-" + std::to_string(getpid()), n, others(on_the_line, n), sim::engine::kFirstCycle},
            *records.around.world->world().driven());
      records.device = lines[n] != nullptr;
      auto& process = host.process(drawn_late(late, static_cast<std::uint16_t>(n)));
      bodies.emplace_back([&, n] {
        RunnerConfig config;
        config.cluster = &cluster_;
        config.node = static_cast<NodeId>(n);
        config.clock = clock;
        config.seed = 1;
        config.first_cycle = sim::engine::kFirstCycle;
        config.end = sim::engine::kFirstCycle + lasts;
        config.vehicle = lines[n].get();
        Runner runner(config,
                      sim::drives::make_steps({&scenario_, &cluster_, ttf::fusion::strategies::StrategyKind::kTt, 1, 0,
                                               records_[n].around.scene, nullptr},
                                              config.node),
                      *media[n], process, records_[n]);
        EXPECT_EQ(runner.run(), RunnerEnd::kDone);
        counts_[n] = runner.health().vehicle;
      });
    }
    host.run(bodies);
  }
  static std::vector<std::size_t> others(std::vector<std::size_t> all, std::size_t self) {
    std::erase(all, self);
    return all;
  }

  const sim::drives::Scenario scenario_ = sim::drives::load_scenario(TTF_SOURCE_DIR "/scenarios/acc_braking_lead.yaml");
  schedules::model::Cluster cluster_ =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/closed_loop_synchronised.yaml");
  std::vector<LoopRecords> records_;           // by node
  std::vector<std::optional<Counts>> counts_;  // by node
};

TEST_F(LiveLoop, EverySensorSeesTheVehicleOfTheActuatorsLogToTheBit) {
  drive(ms(1'000), us(300));
  const LoopRecords& actuator = records_[index_of(*cluster_.find_node("actuator"))];
  ASSERT_GT(actuator.applied.size(), 10u);
  std::size_t compared = 0;
  for (const char* name : {"laser", "camera", "odometry"}) {
    const std::size_t n = index_of(*cluster_.find_node(name));
    Driven replayed(*scenario_.world.ego, records_[n].around.world->road(), scenario_.world.duration);
    for (const Actuation& one : actuator.applied) replayed.actuate(one);
    for (const LoopRecords::Seen& seen : records_[n].seen) {
      const sim::world::vehicle::RearAxleMotion motion = replayed.at(seen.at);
      const double expected[] = {motion.x, motion.vx, motion.acceleration},
                   found[] = {seen.ego.x, seen.ego.vx, seen.ego.acceleration};
      EXPECT_EQ(std::memcmp(expected, found, sizeof found), 0) << name << " at " << seen.at.ns;
      ++compared;
    }
    ASSERT_TRUE(counts_[n]);
    EXPECT_TRUE(counts_[n]->whole);
    EXPECT_EQ(counts_[n]->received, actuator.applied.size()) << name;
    EXPECT_EQ(counts_[n]->late + counts_[n]->gaps + counts_[n]->malformed, 0u) << name;
  }
  EXPECT_GT(compared, 80u);
}

// The line alone, without a drive.
TEST(VehicleLine, AProcessThatBeginsLaterCatchesUp) {
  const std::string session = "line-test-" + std::to_string(getpid());
  sim::world::vehicle::EgoConfig config;
  config.actuator.emplace();
  Driven of_actuator(config, nullptr, ms(60'000)), of_sensor(config, nullptr, ms(60'000)),
      of_late(config, nullptr, ms(60'000));
  Line actuator({session, 0, {1, 2}, TrueTime{}}, of_actuator), sensor({session, 1, {0, 2}, TrueTime{}}, of_sensor);
  for (std::int64_t k = 1; k <= 5; ++k) actuator.report({TrueTime{} + ms(40 * k), -1.0, 0.0});
  sensor.take_in();
  EXPECT_EQ(of_sensor.actuations().size(), 5u);
  {
    Line late({session, 2, {0, 1}, TrueTime{}}, of_late);
    EXPECT_FALSE(late.catch_up(std::chrono::milliseconds(0)));
    actuator.report({TrueTime{} + ms(240), -1.0, 0.0});
    late.take_in();    // asks
    sensor.take_in();  // answers
    late.take_in();
    EXPECT_EQ(of_late.actuations().size(), 6u);
    EXPECT_THROW(Line({session, 2, {}, TrueTime{}}, of_late), std::runtime_error) << "its name is in use";
  }
  actuator.report({TrueTime{} + ms(280), -1.0, 0.0});
  Line again({session, 2, {0, 1}, TrueTime{}}, of_late);  // its name is free
}

}  // namespace
}  // namespace ttf::nodes::runner::vehicle
