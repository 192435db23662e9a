// Sensors that follow their hosts: their rate, and the load of the hosts' tasks.
#include "schedules/analysis/sensor_loop.h"
#include "schedules/exchange/cluster_yaml.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "core/random.h"
#include "schedules/analysis/responses.h"
#include "tests/schedules/check/mutation.h"

namespace ttf::schedules::analysis {
namespace {

constexpr Duration microseconds(std::int64_t n) { return Duration::microseconds(n); }

model::Cluster following_cluster() { return check::load_checked_cluster(shipped_path("paper_free_running")); }

// Camera: classic CAN at 1 Mbit/s. A frame of 8 bytes takes 107 us at best until its acceptance, 40 of
// them 5.4 ms at worst, less the 4 us behind the last. Oscillators are off by at most 1500 ppm, so two of them give 0.3 % of every time; 101
// ns of rounding each way.
TEST(SensorLoop, ARoundIsExecutionTransferAndPreprocessing) {
  const model::Cluster cluster = following_cluster();
  const SensorId camera = *cluster.find_sensor("camera");
  const auto loop = loop_of(cluster, camera);
  ASSERT_TRUE(loop.has_value());
  EXPECT_EQ(loop->after->name, "preprocess");
  const auto near = [](Duration found, double expected_us) {
    EXPECT_NEAR(static_cast<double>(found.ns), expected_us * 1e3, 300);
  };
  near(shortest_return(cluster, *loop), (400 + 107) * 0.997);
  near(shortest_round(cluster, *loop), (400 + 107 + 12'000) * 0.997);
  near(*longest_round(cluster, *loop), (500 + 40 * 135 - 4 + 26'000) * 1.003);
  EXPECT_LT(*longest_round(cluster, *loop), cluster.sensor(camera).longest);
  EXPECT_FALSE(loop_of(file::load_cluster(shipped_path("paper_unsynchronised")), camera).has_value());
}

// Alone on its processor, the host's task ends after its execution, though the shortest period is shorter.
// Its ends, and with them the lists, are a round apart.
TEST(SensorLoop, TheHostsTaskNeverOverlapsItself) {
  const model::Cluster cluster = following_cluster();
  const auto found = worst_responses(cluster, *cluster.find_node("laser_pre"));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(cluster.sensor(*cluster.find_sensor("laser")).period, (*found)[0].worst);
  EXPECT_EQ((*found)[0].worst, Duration::milliseconds(34));
  EXPECT_FALSE((*found)[0].gap.has_value());
  EXPECT_NEAR(static_cast<double>((*found)[0].written->ns), (400 + 136 + 18'000) * 1e3 * 0.997, 60e3);
}

TEST(Mutations, OfFollowingSensors) {
  // The whole file has a sensor on a line.
  check::expect_named_in(
      exchange::cluster_yaml(file::load_cluster(shipped_path("paper_free_running")), ""),
      {
          {"after_nobody",
           "host: camera_pre, measurement: completion, after: preprocess",
           "host: camera_pre, measurement: completion, after: process",
           {"after: process,", "sensors.camera.after", "process", "must be a task of camera_pre"}},
          {"after_another_list",
           "host: camera_pre, measurement: completion, after: preprocess",
           "host: laser_pre, measurement: completion, after: preprocess",
           {"host: laser_pre, measurement: completion", "sensors.camera.after", "preprocess",
            "from the measuring task of camera"}},
          {"after_followed",
           "(camera_pre:[^~]*?)(  gateway:)",
           "$1      more:\n        step: gateway\n        activation: {kind: completion, after: preprocess}\n"
           "        best_case: 1 ms\n        worst_case: 1 ms\n        draw: uniform\n        deadline: 9 ms\n$2",
           {"measurement: completion, after: preprocess, shortest_period: 16 ms", "sensors.camera.after", "preprocess",
            "followed by no other task"}},
          {"longest_too_short",
           "longest_period: 33 ms",
           "longest_period: 31 ms",
           {"longest_period: 31 ms", "sensors.camera.longest_period", "31 ms", "must be at least 31.9"}},
          {"longest_below_shortest",
           "longest_period: 33 ms",
           "longest_period: 15 ms",
           {"longest_period: 15 ms", "sensors.camera.longest_period", "15 ms", "16 ms"}},
          {"a_period_of_its_own",
           "longest_period: 33 ms",
           "longest_period: 33 ms, period: 20 ms",
           {"period: 20 ms", "sensors.camera.period", "", "not a known key"}},
          {"lists_more_often",
           "sender: camera_pre, shortest_period: 12 ms",
           "sender: camera_pre, shortest_period: 13 ms",
           {"shortest_period: 13 ms", "can.observation_can.messages[1].shortest_period", "13 ms",
            "must be at most 12.4"}},
          {"raw_more_often",
           "sender: camera, shortest_period: 15 ms",
           "sender: camera, shortest_period: 16 ms",
           {"shortest_period: 16 ms", "can.camera_can.messages[0].shortest_period", "16 ms", "must be at most 15.8"}},
      });
}

// An oracle: a queue with one task followed by a sensor, and one that comes at least 20 ms apart.
struct FollowedQueue {
  const model::Task &followed, &other;
  Duration pause;  // from an end of `followed` to its next activation
  RandomStream& draws;
  Duration worst_followed{}, worst_other{};

  std::int64_t execution(const model::Task& task) {
    return draws.integer(0, 2) == 0 ? draws.integer(task.best_case.ns, task.worst_case.ns) : task.worst_case.ns;
  }
  void run(std::int64_t end) {
    struct Job {
      bool followed;
      std::int64_t activated;
    };
    std::deque<Job> ready;
    std::int64_t now = 0, next_followed = draws.integer(0, 40'000'000), next_other = draws.integer(0, 20'000'000);
    while (now < end) {
      const auto take = [&] {
        while (std::min(next_followed, next_other) <= now) {
          const bool is_followed = next_followed <= next_other;
          ready.push_back({is_followed, std::min(next_followed, next_other)});
          if (is_followed)
            next_followed = INT64_MAX;
          else
            next_other += 20'000'000 + (draws.integer(0, 2) == 0 ? draws.integer(0, 20'000'000) : 0);
        }
      };
      take();
      if (ready.empty()) {
        now = std::min(next_followed, next_other);
        continue;
      }
      const Job job = ready.front();
      ready.pop_front();
      now += execution(job.followed ? followed : other);
      if (job.followed) next_followed = now + pause.ns + (draws.integer(0, 2) == 0 ? draws.integer(0, 1'000'000) : 0);
      Duration& worst = job.followed ? worst_followed : worst_other;
      worst = std::max(worst, Duration{now - job.activated});
    }
  }
};

TEST(SensorLoop, NoDrawnQueueIsSlowerThanItsBounds) {
  model::Cluster cluster = following_cluster();
  const NodeId host = *cluster.find_node("camera_pre");
  model::Task other;
  other.name = "other";
  other.activation.kind = model::ActivationKind::kSensor;  // as if it were a device as well
  other.activation.sensor = static_cast<SensorId>(cluster.sensors.size());
  model::Sensor sensor;
  sensor.period = Duration::milliseconds(20);
  cluster.sensors.push_back(sensor);
  cluster.nodes[index_of(host)].tasks.push_back(other);
  model::Task& added = cluster.nodes[index_of(host)].tasks[1];
  RandomStream draws({5, 0, Purpose::kTest, 0, 0});
  double closest = 0;
  for (const std::int64_t execution : {100, 300, 1'000}) {
    // A pause of a tenth of the execution leaves the processor idle now and then.
    cluster.nodes[index_of(host)].tasks[0].best_case = microseconds(4'000);
    cluster.nodes[index_of(host)].tasks[0].worst_case = microseconds(5'000);
    added.best_case = microseconds(execution / 2);
    added.worst_case = microseconds(execution);
    const auto bounds = worst_responses(cluster, host);
    ASSERT_TRUE(bounds.has_value());
    const SensorLoop loop = *loop_of(cluster, *cluster.find_sensor("camera"));
    FollowedQueue queue{*loop.after, added, shortest_return(cluster, loop), draws};
    for (int run = 0; run < 50; ++run) queue.run(2'000'000'000);
    EXPECT_LE(queue.worst_followed, (*bounds)[0].worst);
    EXPECT_LE(queue.worst_other, (*bounds)[1].worst);
    EXPECT_GE((*bounds)[0].worst, microseconds(5'000 + execution));
    closest = std::max(closest, queue.worst_other.seconds() / (*bounds)[1].worst.seconds());
  }
  EXPECT_GT(closest, 0.9);
}

}  // namespace
}  // namespace ttf::schedules::analysis
