// Publishing never delays recording, regardless of listeners and of DDS' speed.
#include "bus/dds/ros/publisher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "tests/bus/dds/ros/drawn.h"
#include "tests/bus/dds/ros/processes.h"

namespace ttf::bus::dds::ros {
namespace {

using namespace std::chrono_literals;

// The thread's voluntary context switches: each is a wait.
long waits() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

template <class Holds> bool soon(Holds holds) {
  for (int i = 0; i < 1000; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return holds();
}

TEST(RosPublisher, NeverWaitsAlsoWhenItIsFlooded) {
  RosOptions options = options_of_its_own();
  options.truth_objects = 1;
  RosPublisher publisher(options);
  const DrawnImage image(1'000'000'000, 1, 64);
  const DrawnTrack track(1'000'000'000, 1, 3);
  constexpr std::uint64_t kRounds = 20'000;
  const long before = waits();
  for (std::uint64_t i = 0; i < kRounds; ++i) {
    publisher.on(image.record);
    publisher.on(track.record);
    publisher.on(recording::records::FusionStep{image.record.stamp, 1, 1, 0});
    publisher.on(truth_at(static_cast<std::int64_t>(i), 0));
    publisher.health({TrueTime{1}, HealthLevel::kOk, "flood", "fine", {}});
  }
  EXPECT_EQ(waits(), before);
  const auto settled = [&](const TopicCounts& counts) { return counts.written + counts.dropped == kRounds; };
  EXPECT_TRUE(soon([&] {
    const RosCounts counts = publisher.counts();
    return settled(counts.images) && settled(counts.tracks) && settled(counts.health) && settled(counts.truth);
  }));
  const RosCounts counts = publisher.counts();
  EXPECT_GT(counts.images.dropped, 0u) << "the flood was none";
  EXPECT_GE(counts.images.written, options.queue);
  EXPECT_EQ(counts.boxes.written, counts.images.written);
  EXPECT_EQ(counts.images.refused + counts.boxes.refused + counts.tracks.refused + counts.truth.refused +
                counts.health.refused,
            0u);
  EXPECT_EQ(counts.cut, 0u);
}

TEST(RosPublisher, AListenerThatStandsStillHoldsNobodyUp) {
  const RosOptions options = options_of_its_own();
  RosPublisher publisher(options);
  Listener listener;
  const std::string topic = "rt/" + options.node_name + "/image";
  const auto sequence_of = [](const nlohmann::json& line) { return line.at("sequence_number").get<std::uint32_t>(); };
  std::uint32_t sequence = 0;
  const auto next_image = [&] {
    ++sequence;
    return DrawnImage(1'000'000 * std::int64_t{sequence}, sequence, 64);
  };
  ASSERT_TRUE(soon([&] {  // until it receives us
    publisher.on(next_image().record);
    return listener.find([&](const nlohmann::json& line) { return is_sample_of(line, topic); }, 0ms).has_value();
  }));

  listener.signal(SIGSTOP);
  constexpr std::uint32_t kImages = 3000;
  const std::uint64_t written_before = publisher.counts().images.written;
  long waited = 0;
  for (std::uint32_t i = 0; i < kImages; ++i) {
    const DrawnImage next = next_image();
    const long before = waits();
    publisher.on(next.record);
    waited += waits() - before;
    std::this_thread::sleep_for(500us);
  }
  EXPECT_EQ(waited, 0);
  EXPECT_TRUE(soon([&] {
    const TopicCounts counts = publisher.counts().images;
    return counts.written + counts.dropped >= written_before + kImages;
  })) << "the writing thread stood still, too";
  EXPECT_EQ(publisher.counts().images.refused, 0u);

  listener.signal(SIGCONT);  // and it receives the newest
  const std::uint32_t newest = sequence;
  EXPECT_TRUE(listener
                  .find(
                      [&](const nlohmann::json& line) {
                        return is_sample_of(line, topic) && sequence_of(line) + options.queue >= newest;
                      },
                      20s)
                  .has_value());
}

}  // namespace
}  // namespace ttf::bus::dds::ros
