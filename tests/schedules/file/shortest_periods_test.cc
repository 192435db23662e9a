#include "schedules/file/shortest_periods.h"

#include <gtest/gtest.h>

#include <string>

#include "schedules/check/checker.h"
#include "schedules/file/loader.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

// The text without the shortest periods of messages; those of sensors stay.
std::string without_periods(const std::string& text) {
  static const support::Pattern kPeriod(R"((identifier: [^}\n]*), shortest_period: [^,}\n]*)");
  return support::replaced(text, kPeriod, "$1");
}

TEST(ShortestPeriods, AreTheLargestThatTheCheckAccepts) {
  int derived = 0;
  for (const std::string& name : shipped_clusters()) {
    const std::string text = shipped_text(name);
    const model::Cluster said = parse_cluster(text, name);
    model::Cluster left_out = parse_cluster(without_periods(text), name);
    EXPECT_EQ(sentences(check::check(left_out)), "") << name;
    for (std::size_t c = 0; c < said.can_buses.size(); ++c)
      for (std::size_t m = 0; m < said.can_buses[c].messages.size(); ++m, ++derived) {
        model::CanMessage& message = left_out.can_buses[c].messages[m];
        EXPECT_GE(message.shortest_period, said.can_buses[c].messages[m].shortest_period) << name << " " << m;
        message.shortest_period = message.shortest_period + Duration::microseconds(10);
        EXPECT_NE(sentences(check::check(left_out)), "") << name << " " << m;
        message.shortest_period = message.shortest_period - Duration::microseconds(10);
      }
  }
  EXPECT_GE(derived, 60);
}

TEST(ShortestPeriods, FollowTheListsThatActivateTheirSenders) {
  // 80 ms of the laser, less what its transfer and its preprocessing vary by.
  const std::string text = without_periods(shipped_text("paper_unsynchronised"));
  const model::Cluster cluster = parse_cluster(text, "paper");
  const auto period = [&](const char* bus, std::size_t message) {
    for (const model::CanBus& can : cluster.can_buses)
      if (can.name == bus) return can.messages[message].shortest_period;
    return Duration{};
  };
  EXPECT_LT(period("laser_can", 0), Duration::milliseconds(80));
  EXPECT_GT(period("laser_can", 0), Duration::milliseconds(79));
  EXPECT_LT(period("observation_can", 0), period("laser_can", 0) - Duration::milliseconds(16));
}

TEST(ShortestPeriods, WithoutATaskThatWritesTheListTheFileMustHaveThem) {
  std::string text = without_periods(shipped_text("paper_unsynchronised"));
  const std::string writes = "writes: {raw: laser_scan on laser_can}";
  ASSERT_NE(text.find(writes), std::string::npos);
  text.replace(text.find(writes), writes.size(), "writes: {}");
  try {
    parse_cluster(text, "paper");
    FAIL() << "it loads";
  } catch (const InputError& error) {
    EXPECT_NE(
        std::string(error.what()).find("shortest_period: must be in the file: the tasks of its sender do not bound"),
        std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace ttf::schedules::file
