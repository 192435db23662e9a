// A publisher as a process: ros_talker DOMAIN NAME PERIOD_MS. Every period it publishes the drawn records of
// one image, one step, one truth and one health. Its deadlines follow from that period. It runs until it is ended.
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "bus/dds/ros/publisher.h"
#include "tests/bus/dds/ros/drawn.h"

int main(int count, char** arguments) {
  using namespace ttf;
  if (count != 4) return 2;
  const std::int64_t period = std::stoll(arguments[3]) * 1'000'000;
  bus::dds::ros::RosOptions options = bus::dds::ros::options_of_its_own();
  options.domain = static_cast<std::uint32_t>(std::stoul(arguments[1]));
  options.node_name = arguments[2];
  options.image_period = options.step_period = options.truth_period = options.health_period = Duration{period};
  options.deadline_slack = 4;  // the machine has other work, too
  options.truth_objects = 1;
  bus::dds::ros::RosPublisher publisher(options);
  const auto start = std::chrono::steady_clock::now();
  for (std::uint32_t i = 0;; ++i) {
    const std::int64_t at = i * period;
    publisher.on(bus::dds::ros::DrawnImage(at, i, 2).record);
    publisher.on(bus::dds::ros::DrawnTrack(at, i, 31).record);
    publisher.on(recording::records::FusionStep{bus::dds::ros::stamp_at(at), i, 1, 2});
    publisher.on(bus::dds::ros::truth_at(at, 0));
    const bus::dds::ros::HealthValue values[] = {{"says", "\"quoted\"\n"}};
    publisher.health({TrueTime{at}, bus::dds::ros::HealthLevel::kWarn, "talker", "talks", values});
    std::this_thread::sleep_until(start + std::chrono::nanoseconds(at + period));
  }
}
