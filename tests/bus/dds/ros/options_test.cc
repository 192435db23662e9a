#include "bus/dds/ros/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bus/dds/ros/publisher.h"
#include "core/errors.h"

namespace ttf::bus::dds::ros {
namespace {

TEST(RosOptions, AreFineAsTheyAre) { EXPECT_NO_THROW(validate(RosOptions{})); }

TEST(RosOptions, EachValueOutOfRangeIsNamed) {
  struct Wrong {
    const char* key;
    std::function<void(ttf::bus::dds::ros::RosOptions&)> make;
  };
  const Wrong wrongs[] = {
      {"domain", [](RosOptions& o) { o.domain = 232; }},
      {"node_name", [](RosOptions& o) { o.node_name = ""; }},
      {"node_name", [](RosOptions& o) { o.node_name = "3rd"; }},
      {"node_name", [](RosOptions& o) { o.node_name = "a/b"; }},
      {"node_name", [](RosOptions& o) { o.node_name = "a__b"; }},
      {"node_name", [](RosOptions& o) { o.node_name = "_hidden"; }},
      {"node_name", [](RosOptions& o) { o.node_name = std::string(65, 'a'); }},
      {"time_scale_ppm", [](RosOptions& o) { o.time_scale_ppm = 0; }},
      {"time_scale_ppm", [](RosOptions& o) { o.time_scale_ppm = 1'000'000'001; }},
      {"frame_id", [](RosOptions& o) { o.frame_id = "sensor car"; }},
      {"image_period", [](RosOptions& o) { o.image_period = Duration{-1}; }},
      {"step_period", [](RosOptions& o) { o.step_period = Duration::milliseconds(3'600'001); }},
      {"truth_period", [](RosOptions& o) { o.truth_period = Duration{-1}; }},
      {"health_period", [](RosOptions& o) { o.health_period = Duration{-1}; }},
      {"deadline_slack", [](RosOptions& o) { o.deadline_slack = 0.99; }},
      {"deadline_slack", [](RosOptions& o) { o.deadline_slack = std::numeric_limits<double>::quiet_NaN(); }},
      {"liveliness_lease", [](RosOptions& o) { o.liveliness_lease = std::chrono::milliseconds{99}; }},
      {"truth_objects", [](RosOptions& o) { o.truth_objects = 1025; }},
      {"most_objects", [](RosOptions& o) { o.most_objects = 0; }},
      {"most_tracks", [](RosOptions& o) { o.most_tracks = 1025; }},
      {"queue", [](RosOptions& o) { o.queue = 0; }}};
  for (const Wrong& wrong : wrongs) {
    RosOptions options;
    wrong.make(options);
    try {
      RosPublisher publisher(options);
      ADD_FAILURE() << wrong.key << " was taken";
    } catch (const InputError& error) {
      ASSERT_EQ(error.findings().size(), 1u);
      EXPECT_EQ(error.findings()[0].key, wrong.key);
    }
  }
}

class Environment : public testing::Test {
 protected:
  // For as long as the test runs.
  void set(const char* name, const char* value) {
    const char* const before = std::getenv(name);
    before_.emplace_back(name, before == nullptr ? std::nullopt : std::optional<std::string>(before));
    setenv(name, value, 1);
  }
  ~Environment() override {
    for (auto one = before_.rbegin(); one != before_.rend(); ++one)
      one->second ? setenv(one->first.c_str(), one->second->c_str(), 1) : unsetenv(one->first.c_str());
  }

 private:
  std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

TEST_F(Environment, SaysWhichDomain) {
  for (const auto& [text, domain] :
       {std::pair{"", 0u}, std::pair{"0", 0u}, std::pair{"7", 7u}, std::pair{"231", 231u}}) {
    set("ROS_DOMAIN_ID", text);
    EXPECT_EQ(domain_of_environment(), domain) << text;
  }
  for (const char* const wrong : {"232", "-1", "1.5", "x", " 1", "99999999999999999999"}) {
    set("ROS_DOMAIN_ID", wrong);
    try {
      domain_of_environment();
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_EQ(error.findings().front().sentence(),
                std::string("environment: ROS_DOMAIN_ID = ") + wrong + ": must be a whole number 0..231");
    }
  }
}

TEST_F(Environment, ADomainThatCannotBeJoinedIsFoundOutBefore) {
  RosOptions options;
  options.domain = 97;
  EXPECT_NO_THROW(try_domain(options));
  set("CYCLONEDDS_URI",
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='no_such_one'/></Interfaces></General></Domain>"
      "</CycloneDDS>");
  EXPECT_THROW(try_domain(options), std::runtime_error);
}

}  // namespace
}  // namespace ttf::bus::dds::ros
