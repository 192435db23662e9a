// The tracker's configuration is read strictly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.h"
#include "fusion/loading/tracker.h"

namespace ttf::fusion::loading {

using namespace config;

namespace {

TrackerConfig load(const std::string& text, std::vector<std::string>* sentences = nullptr) {
  Findings findings;
  YamlMap root = StrictYaml::parse(text, "t.yaml").root(findings);
  const TrackerConfig config = load_tracker(root);
  root.finish();
  if (sentences)
    for (const Finding& finding : findings.list()) sentences->push_back(finding.sentence());
  else
    EXPECT_TRUE(findings.empty());
  return config;
}

TEST(TrackerConfig, EverythingHasADefault) {
  const TrackerConfig config = load("{}"), defaults;
  EXPECT_EQ(config.process_noise, defaults.process_noise);
  EXPECT_EQ(config.noise_across(), defaults.process_noise);
  EXPECT_EQ(config.max_objects, 25);
  EXPECT_EQ(config.confirm_hits, 3);
  EXPECT_EQ(config.confirm_window, 5);
  EXPECT_EQ(config.history_scans, 64u);
}

TEST(TrackerConfig, ReadsEveryKey) {
  const TrackerConfig c = load(
      "motion: constant_acceleration\nprocess_noise: 2.5\ncross_noise: 0.25\ninitial_velocity_sigma: 11\n"
      "initial_acceleration_sigma: 3\ngate_probability: 0.99\nconfirm_hits: 2\nconfirm_window: 4\n"
      "delete_misses: 6\ndelete_position_sigma: 7\nmax_objects: 12\nhistory_scans: 16\nheading_noise: 0.5\n"
      "filter: unscented\nturn_noise: 0.4\ninitial_turn_rate_sigma: 0.7\nmode_seconds: 9\n"
      "extent_noise: 0.25\n"
      "sizes: {length: 4.65, length_sigma: 0.37, width: 1.76, width_sigma: 0.1, correlation: 0.82}\n"
      "coast_after: 120 ms\ndelete_after: 2 s\n"
      "max_observations: 200\nbuff_waits: fixed_lag\nfixed_lag: 70 ms\n"
      "association: jpda\nbirth: existence\ndetection_probability: 0.7\nclutter_density: 0.02\n"
      "initial_existence: 0.2\nsurvival_seconds: 30\nconfirm_existence: 0.9\ndelete_existence: 0.02\n"
      "merge_probability: 0.95\nmerge_scans: 7\n");
  EXPECT_EQ(c.association, Association::kJpda);
  EXPECT_EQ(c.birth, Birth::kExistence);
  EXPECT_EQ(c.detection_probability, 0.7);
  EXPECT_EQ(c.clutter_density, 0.02);
  EXPECT_EQ(c.initial_existence, 0.2);
  EXPECT_EQ(c.survival_seconds, 30.0);
  EXPECT_EQ(c.confirm_existence, 0.9);
  EXPECT_EQ(c.delete_existence, 0.02);
  EXPECT_EQ(c.merge_probability, 0.95);
  EXPECT_EQ(c.merge_scans, 7);
  EXPECT_EQ(c.max_observations, 200u);
  EXPECT_EQ(c.buff_waits, BuffWaiting::kFixedLag);
  EXPECT_EQ(c.fixed_lag, Duration::milliseconds(70));
  EXPECT_EQ(c.motion, MotionModel::kConstantAcceleration);
  EXPECT_EQ(c.filter, FilterKind::kUnscented);
  EXPECT_EQ(c.turn_noise, 0.4);
  EXPECT_EQ(c.initial_turn_rate_sigma, 0.7);
  EXPECT_EQ(c.mode_seconds, 9.0);
  EXPECT_EQ(c.process_noise, 2.5);
  EXPECT_EQ(c.noise_across(), 0.25);
  EXPECT_EQ(c.initial_velocity_sigma, 11.0);
  EXPECT_EQ(c.initial_acceleration_sigma, 3.0);
  EXPECT_EQ(c.gate_probability, 0.99);
  EXPECT_EQ(c.confirm_hits, 2);
  EXPECT_EQ(c.confirm_window, 4);
  EXPECT_EQ(c.delete_misses, 6);
  EXPECT_EQ(c.delete_position_sigma, 7.0);
  EXPECT_EQ(c.max_objects, 12);
  EXPECT_EQ(c.history_scans, 16u);
  EXPECT_EQ(c.heading_noise, 0.5);
  EXPECT_EQ(c.extent_noise, 0.25);
  EXPECT_EQ(c.sizes.length, 4.65);
  EXPECT_EQ(c.sizes.length_sigma, 0.37);
  EXPECT_EQ(c.sizes.width, 1.76);
  EXPECT_EQ(c.sizes.width_sigma, 0.1);
  EXPECT_EQ(c.sizes.correlation, 0.82);
  EXPECT_EQ(c.coast_after, Duration::milliseconds(120));
  EXPECT_EQ(c.delete_after, Duration::milliseconds(2'000));
}

TEST(TrackerConfig, AllMistakesAtOnce) {
  std::vector<std::string> sentences;
  load(
      "motion: sideways\nprocess_noise: -1\ngate_probability: 1.0\nconfirm_window: 3\nconfirm_hits: "
      "4\nspeed: 1\n",
      &sentences);
  ASSERT_EQ(sentences.size(), 5u);
  EXPECT_NE(sentences[0].find("t.yaml:1: motion = sideways"), std::string::npos) << sentences[0];
  EXPECT_NE(sentences[1].find("t.yaml:2: process_noise = -1"), std::string::npos) << sentences[1];
  EXPECT_NE(sentences[2].find("t.yaml:3: gate_probability"), std::string::npos) << sentences[2];
  EXPECT_NE(sentences[3].find("t.yaml:5: confirm_hits = 4"), std::string::npos) << sentences[3];
  EXPECT_NE(sentences[4].find("t.yaml:6: speed"), std::string::npos) << sentences[4];
}

TEST(TrackerConfig, NamesEveryMotionModelAndFilter) {
  const std::pair<const char*, MotionModel> models[] = {{"constant_velocity", MotionModel::kConstantVelocity},
                                                        {"constant_acceleration", MotionModel::kConstantAcceleration},
                                                        {"ctrv", MotionModel::kCtrv},
                                                        {"ctra", MotionModel::kCtra},
                                                        {"interacting", MotionModel::kInteracting}};
  for (const auto& model : models) EXPECT_EQ(load(std::string("motion: ") + model.first).motion, model.second);
  EXPECT_EQ(load("filter: extended").filter, FilterKind::kExtended);

  std::vector<std::string> sentences;
  load("motion: coordinated\nfilter: particle\nturn_noise: 0\nmode_seconds: never\ninitial_turn_rate_sigma: 11\n",
       &sentences);
  ASSERT_EQ(sentences.size(), 5u);
  EXPECT_NE(sentences[0].find("t.yaml:1: motion = coordinated"), std::string::npos) << sentences[0];
  for (const auto& model : models)
    EXPECT_NE(sentences[0].find(model.first), std::string::npos) << sentences[0] << " names " << model.first;
  EXPECT_NE(sentences[1].find("t.yaml:2: filter = particle"), std::string::npos) << sentences[1];
  EXPECT_NE(sentences[1].find("extended, unscented"), std::string::npos) << sentences[1];
  EXPECT_NE(sentences[2].find("t.yaml:3: turn_noise = 0"), std::string::npos) << sentences[2];
  EXPECT_NE(sentences[3].find("t.yaml:4: mode_seconds"), std::string::npos) << sentences[3];
  EXPECT_NE(sentences[4].find("t.yaml:5: initial_turn_rate_sigma"), std::string::npos) << sentences[4];
}

// The sentences of a text that is refused.
std::vector<std::string> refusals(const std::string& text) {
  std::vector<std::string> sentences;
  load(text, &sentences);
  return sentences;
}

TEST(TrackerConfig, ClassesAreThoseOfTheTableUnlessSaid) {
  EXPECT_TRUE(load("{}").classes.empty());
  std::string all = "classes:\n";
  for (const ClassPrior& usual : kClassPriors) all += "  " + std::string(usual.name) + ": {}\n";
  const TrackerConfig c = load(all);
  ASSERT_EQ(c.classes.size(), kClassCount);
  EXPECT_EQ(c.class_confusion, 0.05);
  for (std::size_t k = 0; k < kClassCount; ++k) {
    const ClassPrior &read = c.classes[k], &usual = kClassPriors[k];
    EXPECT_EQ(read.name, usual.name);
    EXPECT_EQ(static_cast<std::size_t>(read.id), k);
    EXPECT_EQ(read.share, usual.share);
    EXPECT_EQ(read.speed_sigma, usual.speed_sigma);
    EXPECT_EQ(read.sizes.length, usual.sizes.length);
    EXPECT_EQ(read.sizes.length_sigma, usual.sizes.length_sigma);
    EXPECT_EQ(read.sizes.width, usual.sizes.width);
    EXPECT_EQ(read.sizes.width_sigma, usual.sizes.width_sigma);
    EXPECT_EQ(read.sizes.correlation, usual.sizes.correlation);
  }
}

TEST(TrackerConfig, AClassHasItsOwnValuesAndTheOrderIsTheTables) {
  const TrackerConfig c = load(
      "classes:\n  pedestrian: {speed_sigma: 2, share: 1}\n"
      "  truck: {length: 16.5, length_sigma: 0.25, width: 2.55, width_sigma: 0.05, correlation: -0.5}\n"
      "  car: {width: 1.75}\nclass_confusion: 0.1\n");
  ASSERT_EQ(c.classes.size(), 3u);
  EXPECT_EQ(c.class_confusion, 0.1);
  const ClassPrior &car = c.classes[0], &truck = c.classes[1], &pedestrian = c.classes[2];
  EXPECT_EQ(car.name, "car");
  EXPECT_EQ(car.sizes.length, 4.4);
  EXPECT_EQ(car.sizes.width, 1.75);
  EXPECT_EQ(car.share, 0.72);
  EXPECT_EQ(truck.name, "truck");
  EXPECT_EQ(truck.id, sensors::ClassId{1});
  EXPECT_EQ(truck.sizes.length, 16.5);
  EXPECT_EQ(truck.sizes.length_sigma, 0.25);
  EXPECT_EQ(truck.sizes.width, 2.55);
  EXPECT_EQ(truck.sizes.width_sigma, 0.05);
  EXPECT_EQ(truck.sizes.correlation, -0.5);
  EXPECT_EQ(truck.speed_sigma, 20.0);
  EXPECT_EQ(pedestrian.name, "pedestrian");
  EXPECT_EQ(pedestrian.id, sensors::ClassId{5});
  EXPECT_EQ(pedestrian.speed_sigma, 2.0);
  EXPECT_EQ(pedestrian.share, 1.0);
  EXPECT_EQ(pedestrian.sizes.length, 0.5);
}

TEST(TrackerConfig, RefusesWhatClassesCannotBe) {
  using testing::ElementsAre;
  EXPECT_THAT(refusals("classes:\n  car: {}\n  lorry: {length: 21}\n"),
              ElementsAre("t.yaml:3: classes.lorry: must be one of car, truck, van, motorbike, cyclist, pedestrian",
                          "t.yaml:3: classes.lorry.length = 21: must be a number 0.1..20 m"));
  EXPECT_THAT(refusals("classes:\n  car: {share: 1.5}\n  van: {speed_sigma: 0, weight: 1}\n  truck: big\n"),
              ElementsAre("t.yaml:4: classes.truck: must be a mapping",
                          "t.yaml:2: classes.car.share = 1.5: must be a number 0..1",
                          "t.yaml:3: classes.van.speed_sigma = 0: must be a number 0.1..100 m/s",
                          testing::StartsWith("t.yaml:3: classes.van.weight: is not a known key here")));
  EXPECT_THAT(refusals("classes: {car: {}}\nsizes: {length: 4.5}\n"),
              ElementsAre("t.yaml:2: sizes: must be absent with classes: each class has its own"));
  EXPECT_THAT(refusals("classes: {car: {}}\nclass_confusion: 0\n"),
              ElementsAre("t.yaml:2: class_confusion = 0: must be a number 1e-06..0.8"));
  EXPECT_THAT(refusals("classes:\n  car: {share: 0}\n"),
              ElementsAre(testing::HasSubstr("classes: must have one with a share above zero")));
  EXPECT_THAT(refusals("class_confusion: 0.1\n"),
              ElementsAre("t.yaml:1: class_confusion = 0.1: must be absent without classes: no report of a class "
                          "counts"));
  for (const oosm::NamedKind& named : oosm::kKinds) {
    const std::vector<std::string> sentences = refusals("classes: {car: {}}\nlate: " + std::string(named.name) + "\n");
    if (named.kind == oosm::Kind::kRewind)
      EXPECT_THAT(sentences, ElementsAre());
    else
      EXPECT_THAT(sentences, ElementsAre("t.yaml:2: late = " + std::string(named.name) +
                                         ": must be rewind with classes: the other methods do not reverse a choice "
                                         "among them"));
  }
}

TEST(TrackerConfig, OdometryHasErrors) {
  EXPECT_FALSE(load("{}").odometry);
  EXPECT_EQ(load("{}").drift_density(), 0.0);
  const TrackerConfig c = load(
      "odometry: {speed_sigma: 0.1, yaw_rate_sigma: 0.01, speed_scale: 0.02, speed_scale_sigma: 0.03, "
      "yaw_rate_bias: -0.1,\n  yaw_rate_bias_sigma: 0.2, acceleration_sigma: 4, yaw_acceleration_sigma: 5, lever: 20, "
      "longest_age: 70 ms}\n");
  ASSERT_TRUE(c.odometry);
  EXPECT_EQ(c.odometry->speed_scale, 0.02);
  EXPECT_EQ(c.odometry->speed_scale_sigma, 0.03);
  EXPECT_EQ(c.odometry->yaw_rate_bias, -0.1);
  EXPECT_EQ(c.odometry->yaw_rate_bias_sigma, 0.2);
  EXPECT_EQ(c.odometry->acceleration_sigma, 4.0);
  EXPECT_EQ(c.odometry->yaw_acceleration_sigma, 5.0);
  EXPECT_EQ(c.odometry->longest_age, Duration::milliseconds(70));
  EXPECT_NEAR(c.drift_density(), (0.01 + 0.04) * 0.02, 1e-12) << "samples every 20 ms, unless a schedule says another";
  std::vector<std::string> sentences;
  load("cross_noise: 0.1\nodometry: {}\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0], "t.yaml:1: cross_noise = 0.1: must be absent with odometry: the vehicle's axes turn");
}

TEST(TrackerConfig, SystematicErrorsAreIgnoredUnlessSaid) {
  EXPECT_EQ(load("{}").systematic, SystematicErrorsAre::kIgnored);
  EXPECT_TRUE(load("{}").sensors.empty());
  const TrackerConfig c = load(
      "systematic: consider\nsensors:\n  laser: {bias_sigma: {range: 0.1, bearing: 0.01}}\n"
      "  camera: {mounting: {x: 1.5}}\n");
  EXPECT_EQ(c.systematic, SystematicErrorsAre::kConsidered);
  ASSERT_EQ(c.sensors.size(), 2u);
  EXPECT_EQ(c.sensors[0].name, "laser");
  EXPECT_EQ(c.sensors[0].line, 3);
  EXPECT_EQ(c.sensors[0].errors.sigma(1), 0.01);
  EXPECT_EQ(c.sensors[1].mounting.position.x(), 1.5);
}

TEST(TrackerConfig, BiasesThatNoFilterConsidersAreRefused) {
  for (const std::string rest : {"motion: ctrv\n", "motion: ctra\n", "motion: interacting\n", "filter: unscented\n"}) {
    std::vector<std::string> sentences;
    load(rest + "systematic: consider\n", &sentences);
    ASSERT_EQ(sentences.size(), 1u) << rest;
    EXPECT_EQ(sentences[0],
              "t.yaml:2: systematic = consider: must be ignore unless motion is constant_velocity or "
              "constant_acceleration and filter is extended");
  }
  EXPECT_EQ(load("motion: constant_acceleration\nsystematic: consider\n").systematic, SystematicErrorsAre::kConsidered);
  std::vector<std::string> sentences;
  load("systematic: estimate\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("t.yaml:1: systematic = estimate: must be one of ignore, consider"), std::string::npos)
      << sentences[0];
  sentences.clear();
  const std::string four = "bias_sigma: {range: 0.1, bearing: 0.1, range_rate: 0.1, time: 1 ms}";
  load("sensors:\n  a: {" + four + "}\n  b: {" + four + "}\n  c: {bias_sigma: {x: 0.1, y: 0}}\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("sensors: must have at most 8 biases with a sigma above 0, of all sensors together, "
                              "not 9"),
            std::string::npos)
      << sentences[0];
}

TEST(TrackerConfig, NamesEveryMethodForLateLists) {
  EXPECT_EQ(load("{}").late, oosm::Kind::kRewind);
  for (const oosm::NamedKind& named : oosm::kKinds)
    for (const char* motion : {"constant_velocity", "constant_acceleration"})
      EXPECT_EQ(load("late: " + std::string(named.name) + "\nmotion: " + motion).late, named.kind);
  std::vector<std::string> sentences;
  load("late: never\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "t.yaml:1: late = never: must be one of rewind, augmented, clone, adjoint, al1, bl1, a, b, c");
}

TEST(TrackerConfig, OnlyStraightMotionIsTakenInOtherThanByRewinding) {
  for (const std::string other : {"motion: ctrv", "motion: ctra", "motion: interacting", "filter: unscented"}) {
    EXPECT_EQ(load(other + "\nlate: rewind\n").late, oosm::Kind::kRewind);
    std::vector<std::string> sentences;
    load(other + "\nlate: al1\n", &sentences);
    ASSERT_EQ(sentences.size(), 1u) << other;
    EXPECT_EQ(sentences[0],
              "t.yaml:2: late = al1: must be rewind unless motion is constant_velocity or "
              "constant_acceleration and filter is extended: the other methods support only those estimates");
  }
}

TEST(TrackerConfig, OtherMethodsThanRewindingHaveOneWayToAssociate) {
  for (const std::string other : {"association: jpda", "birth: existence", "merge_probability: 0.9"}) {
    EXPECT_EQ(load(other + "\nlate: rewind\n").late, oosm::Kind::kRewind);
    std::vector<std::string> sentences;
    load(other + "\nlate: al1\n", &sentences);
    ASSERT_EQ(sentences.size(), 1u) << other;
    EXPECT_EQ(sentences[0],
              "t.yaml:2: late = al1: must be rewind unless association is nearest, birth is m_of_n and "
              "merge_probability is 0: the other methods do not reverse later decisions");
  }
}

TEST(TrackerConfig, RefusesWhatAssociationAndBirthCannotBe) {
  std::vector<std::string> sentences;
  load(
      "association: global\nbirth: twice\ndetection_probability: 1\nclutter_density: 0\nsurvival_seconds: -1\n"
      "initial_existence: 0\nconfirm_existence: 1\nmerge_probability: 1\nmerge_scans: 0\ndelete_existence: 1e-9\n",
      &sentences);
  const char* const expected[] = {
      "t.yaml:1: association = global",  "t.yaml:2: birth = twice",         "t.yaml:3: detection_probability = 1",
      "t.yaml:4: clutter_density = 0",   "t.yaml:5: survival_seconds = -1", "t.yaml:6: initial_existence = 0",
      "t.yaml:7: confirm_existence = 1", "t.yaml:8: merge_probability = 1", "t.yaml:9: merge_scans = 0"};
  ASSERT_EQ(sentences.size(), std::size(expected));
  for (std::size_t i = 0; i < sentences.size(); ++i)
    EXPECT_NE(sentences[i].find(expected[i]), std::string::npos) << sentences[i];
  EXPECT_NE(sentences[0].find("nearest, jpda"), std::string::npos) << sentences[0];
  EXPECT_NE(sentences[1].find("m_of_n, existence"), std::string::npos) << sentences[1];
  sentences.clear();
  load("delete_existence: 0.1\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("t.yaml:1: delete_existence = 0.1"), std::string::npos) << sentences[0];
  EXPECT_NE(sentences[0].find("must be below initial_existence"), std::string::npos) << sentences[0];
  sentences.clear();
  load("delete_existence: 0.05\nconfirm_existence: 0.05\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("must be below confirm_existence"), std::string::npos) << sentences[0];
}

// The examples of docs/fusion/tracker.md, verbatim.
TEST(TrackerConfig, TheDocumentedExamplesLoad) {
  std::ostringstream page;
  page << std::ifstream(TTF_SOURCE_DIR "/docs/fusion/tracker.md").rdbuf();
  const std::string begin = "```yaml\n", all = page.str();
  std::vector<TrackerConfig> configs;
  for (std::size_t from = all.find(begin); from != std::string::npos; from = all.find(begin, from + 1)) {
    const std::size_t first = from + begin.size();
    Findings findings;
    YamlMap root = StrictYaml::parse(all.substr(first, all.find("```", first) - first), "tracker.md").root(findings);
    YamlMap tracker = root.map("tracker");
    configs.push_back(load_tracker(tracker));
    tracker.finish();
    root.finish();
    EXPECT_TRUE(findings.empty());
  }
  ASSERT_EQ(configs.size(), 5u);
  EXPECT_EQ(configs[0].motion, MotionModel::kCtrv);
  EXPECT_EQ(configs[0].filter, FilterKind::kUnscented);
  const Sizes defaults;  // as the page calls them
  EXPECT_EQ(configs[1].sizes.length, defaults.length);
  EXPECT_EQ(configs[1].sizes.length_sigma, defaults.length_sigma);
  EXPECT_EQ(configs[1].sizes.width, defaults.width);
  EXPECT_EQ(configs[1].sizes.width_sigma, defaults.width_sigma);
  EXPECT_EQ(configs[1].sizes.correlation, defaults.correlation);
  ASSERT_EQ(configs[2].classes.size(), 3u);
  EXPECT_EQ(configs[2].classes[1].sizes.length, 16.5);
  EXPECT_EQ(configs[2].classes[2].share, 0.3);
  ASSERT_EQ(configs[3].sensors.size(), 1u);
  EXPECT_EQ(configs[3].sensors[0].name, "camera");
  ASSERT_TRUE(configs[3].sensors[0].field.has_value());
  EXPECT_EQ(configs[3].sensors[0].field->max_range, 90.0);
  EXPECT_EQ(configs[4].association, Association::kJpda);
  EXPECT_EQ(configs[4].birth, Birth::kExistence);
}

// A track that ends before it coasts would never be marked as coasting.
TEST(TrackerConfig, CoastingComesBeforeTheEnd) {
  std::vector<std::string> sentences;
  load("coast_after: 1001 ms\n", &sentences);
  ASSERT_EQ(sentences.size(), 1u) << "delete_after is 1 s unless said";
  EXPECT_NE(sentences[0].find("t.yaml:1: coast_after"), std::string::npos) << sentences[0];
  sentences.clear();
  load("coast_after: 1001 ms\ndelete_after: 1001 ms\n", &sentences);
  EXPECT_TRUE(sentences.empty());
}

}  // namespace
}  // namespace ttf::fusion::loading
