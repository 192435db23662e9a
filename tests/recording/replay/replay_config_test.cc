// The configuration of a replay: defaults, the tracker's keys untouched, and every mistake a sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/replay/config.h"

namespace ttf::recording::replay {
namespace {

using testing::ElementsAre;

std::vector<std::string> mistakes(const std::string& text) {
  std::vector<std::string> sentences;
  try {
    parse_replay_config(text, "c.yaml", {});
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings()) sentences.push_back(finding.sentence());
  }
  return sentences;
}

TEST(ReplayConfig, EveryKeyHasADefault) {
  SensorSetup usual;
  usual.noise.position = 0.15;
  const ReplayConfig config = parse_replay_config("sensors: {laser: {}}\n", "c.yaml", usual);
  EXPECT_EQ(config.strategy, fusion::strategies::StrategyKind::kAdva);
  EXPECT_EQ(config.tracker.process_noise, fusion::config::TrackerConfig{}.process_noise);
  ASSERT_EQ(config.sensors.size(), 1u);
  EXPECT_EQ(config.sensors[0].second.noise.position, 0.15) << "of a sensor, what is not said is as usual";
  EXPECT_FALSE(config.sensors[0].second.worst_delay);
  EXPECT_TRUE(parse_replay_config("strategy: buff\n", "c.yaml", usual).sensors.empty());
}

TEST(ReplayConfig, ReadsEveryKey) {
  const ReplayConfig config = parse_replay_config(
      "strategy: tt\n"
      "tracker: {process_noise: 4.0, confirm_hits: 1}\n"
      "sensors:\n"
      "  radar: {range: 0.3, bearing: 0.02, range_rate: 0.4, period: 100 ms, first: 50 ms, worst_delay: 70 ms}\n"
      "  lidar: {position: 0.1, heading: 0.05, length: 0.2, width: 0.3}\n",
      "c.yaml", {});
  EXPECT_EQ(config.strategy, fusion::strategies::StrategyKind::kTt);
  EXPECT_EQ(config.tracker.process_noise, 4.0);
  EXPECT_EQ(config.tracker.confirm_hits, 1);
  ASSERT_EQ(config.sensors.size(), 2u);
  EXPECT_EQ(config.sensors[0].first, "radar") << "in the order of the file";
  const SensorSetup& radar = config.sensors[0].second;
  EXPECT_EQ(radar.noise.range, 0.3);
  EXPECT_EQ(radar.noise.bearing, 0.02);
  EXPECT_EQ(radar.noise.range_rate, 0.4);
  EXPECT_EQ(radar.period, Duration::milliseconds(100));
  EXPECT_EQ(radar.first, GlobalTime{50'000'000});
  EXPECT_EQ(radar.worst_delay, Duration::milliseconds(70));
  const SensorNoise& lidar = config.sensors[1].second.noise;
  EXPECT_EQ(lidar.position, 0.1);
  EXPECT_EQ(lidar.heading, 0.05);
  EXPECT_EQ(lidar.length, 0.2);
  EXPECT_EQ(lidar.width, 0.3);
}

TEST(ReplayConfig, EveryMistakeIsASentence) {
  EXPECT_THAT(mistakes("strategy: best\ntracker: {proces_noise: 1}\nsensors: {a: {position: 0, x: 1, first: 1 s}}\n"),
              testing::UnorderedElementsAre(
                  testing::StartsWith("c.yaml:1: strategy = best: must be"),
                  testing::StartsWith("c.yaml:2: tracker.proces_noise: is not a known key"),
                  testing::StartsWith("c.yaml:3: sensors.a.position = 0: must be a number 0.001..100 m"),
                  testing::StartsWith("c.yaml:3: sensors.a.x: is not a known key"),
                  testing::StartsWith("c.yaml:3: sensors.a.first = 1 s: must not be given without period")));
  EXPECT_THAT(mistakes("sensors: {}\n"), ElementsAre("c.yaml:1: sensors: must name 1..100 sensors"));
  EXPECT_THAT(mistakes("sensors: {a: {period: 0 ms}}\n").size(), 1u);
  EXPECT_THAT(mistakes("smoothing: yes\n"),
              ElementsAre(testing::StartsWith("c.yaml:1: smoothing: is not a known key")));
}

TEST(ReplayConfig, PlacesAndBiasesStandWithTheSensors) {
  const ReplayConfig config = parse_replay_config(
      "tracker: {systematic: consider}\n"
      "sensors:\n"
      "  radar: {range: 0.3, mounting: {x: -1.0, heading: 3.14}, bias_sigma: {bearing: 0.02, time: 5 ms}}\n"
      "  lidar: {bias: {x: 0.1}}\n",
      "c.yaml", {});
  ASSERT_EQ(config.tracker.sensors.size(), 2u) << "in the order of the sensors";
  EXPECT_EQ(config.tracker.sensors[0].mounting.position.x(), -1.0);
  EXPECT_EQ(config.tracker.sensors[0].errors.sigma(3), 0.005);
  EXPECT_EQ(config.tracker.sensors[1].errors.known(0), 0.1);
  EXPECT_EQ(config.sensors[0].second.noise.range, 0.3);
  EXPECT_THAT(mistakes("tracker: {sensors: {a: {}}}\n"),
              ElementsAre(testing::StartsWith("c.yaml:1: tracker.sensors: must not be given here")));
  EXPECT_THAT(mistakes("sensors:\n  a: {bias: {colour: 1}, mounting: 3}\n").size(), 2u);
  const std::string three = ": {bias_sigma: {range: 1, bearing: 0.1, time: 1 ms}}\n";
  EXPECT_THAT(mistakes("sensors:\n  a" + three + "  b" + three + "  c" + three),
              ElementsAre(testing::StartsWith("c.yaml:2: sensors: must have at most 8 biases")));
}

TEST(ReplayConfig, SigmasAreKnownByName) {
  SensorNoise noise;
  const NamedSigma range = sigma_of(noise, "range");
  ASSERT_EQ(range.value, &noise.range);
  EXPECT_EQ(range.allowed.high, kSigmaAllowed.high);
  EXPECT_EQ(sigma_of(noise, "colour").value, nullptr);
  EXPECT_EQ(sigma_names(), "position, range, bearing, range_rate, heading, length, width");
}

}  // namespace
}  // namespace ttf::recording::replay
