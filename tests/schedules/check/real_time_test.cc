// Rules W1..W7 of schedules/check/real_time_rules.h, at their exact thresholds; and the section of the file.
#include "schedules/check/real_time_rules.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "schedules/exchange/cluster_text.h"
#include "tests/schedules/check/mutation.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/small_cluster.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::check {
namespace {

constexpr Duration micros(std::int64_t n) { return Duration::microseconds(n); }

// 40 slots of 84 us, the first 34 in use, 7 us to the action point: 7 x 84 - 7 = 581 us of room. A cycle of 5
// ms.
model::Cluster paper(Duration early, Duration late) {
  model::Cluster cluster = load_checked_cluster(shipped_path("paper_synchronised"));
  cluster.arrival_window = {early, late};
  return cluster;
}

TEST(RealTime, TheRoomIsWhatIsLeftOfTheStaticSegment) {
  const model::Cluster cluster = paper({}, micros(1));
  EXPECT_EQ(last_static_slot(cluster), 34);
  EXPECT_EQ(arrival_room(cluster, kTimeScaleOne), micros(581));
  EXPECT_EQ(arrival_room(cluster, 2'500'000), Duration{1'452'500});
  EXPECT_EQ(arrival_room(cluster, 100'000), Duration{58'100});
  EXPECT_EQ(arrival_room(cluster, 1'000'001), Duration{581'000});  // 581000.581 ns
}

// A macrotick with a fraction of a nanosecond: 20 slots of 84, 4 in use, 17 x 84 - 7 = 1421 macroticks.
TEST(RealTime, TheRoomIsExactInPicoseconds) {
  model::Cluster cluster = small(true);
  cluster.flexray.gdMacrotick_ps = 1'375'001;
  EXPECT_EQ(arrival_room(cluster, kTimeScaleOne), Duration{1'953'876});  // 1953876.421
  EXPECT_EQ(arrival_room(cluster, kLargestTimeScale), Duration{1'953'876'421});
  cluster.frames.clear();
  EXPECT_EQ(arrival_room(cluster, kTimeScaleOne), Duration{2'300'376});  // 1673 macroticks: 2300376.673
}

TEST(RealTime, DynamicSlotsTakeNoneOfTheRoom) {
  model::Cluster cluster = paper({}, micros(1));
  model::FrameSlot dynamic = cluster.frames.back();
  dynamic.slot = 41;
  cluster.frames.push_back(dynamic);
  EXPECT_EQ(arrival_room(cluster, kTimeScaleOne), micros(581));
}

TEST(RealTime, LateMayBeAsLongAsTheRoom) {
  EXPECT_TRUE(check_real_time(paper({}, micros(581)), kTimeScaleOne).empty());
  const model::Cluster cluster = paper({}, Duration{581'001});
  const auto findings = check_real_time(cluster, kTimeScaleOne);
  ASSERT_EQ(findings.size(), 1u) << sentences(findings);
  EXPECT_EQ(findings[0].key, "real_time.late");
  EXPECT_EQ(findings[0].value, "581.001 us");
  EXPECT_EQ(line_of(cluster.text, findings[0].line), "real_time: {early: 100 us, late: 500 us}");
  EXPECT_EQ(findings[0].expected,
            "must be at most 581 us at time scale 1: the time from the action point of slot 34, the last one in "
            "use, to the end of the static segment; --time-scale 1.000002 or more suffices");
}

TEST(RealTime, TheWindowsOfASlotInTwoCyclesMustNotOverlap) {
  EXPECT_TRUE(check_real_time(paper(Duration{4'499'999}, micros(500)), kTimeScaleOne).empty());
  const auto findings = check_real_time(paper(micros(4'500), micros(500)), kTimeScaleOne);
  ASSERT_EQ(findings.size(), 1u) << sentences(findings);
  EXPECT_EQ(findings[0].key, "real_time.early");
  EXPECT_EQ(findings[0].value, "4500 us");
  EXPECT_EQ(findings[0].expected,
            "must be less than a cycle together with late (500 us), 5000 us at time scale 1: otherwise the "
            "arrival windows of a slot in two cycles overlap; --time-scale 1.000001 or more suffices");
}

// For any window: the named scale suffices, and the one before does not.
TEST(RealTime, TheTimeScaleNamedIsTheSmallest) {
  const std::pair<Duration, Duration> windows[] = {{{}, micros(582)},
                                                   {micros(100), micros(2'000)},
                                                   {micros(100), Duration{123'456'789}},
                                                   {micros(9'000), micros(1)},
                                                   {micros(4'500), micros(500)},
                                                   {micros(1'000'000), micros(1)},
                                                   {micros(300'000), micros(581)},
                                                   {Duration{1}, micros(580'999)},
                                                   {micros(1'000'000), micros(580'000)}};
  for (const auto& [early, late] : windows) {
    const model::Cluster cluster = paper(early, late);
    const std::int64_t smallest = smallest_time_scale(cluster, *cluster.arrival_window);
    EXPECT_TRUE(check_real_time(cluster, smallest).empty()) << smallest;
    EXPECT_FALSE(check_real_time(cluster, smallest - 1).empty()) << smallest;
  }
  EXPECT_EQ(smallest_time_scale(paper({}, micros(1'162)), {{}, micros(1'162)}), 2'000'000);  // 2 x 581
  EXPECT_EQ(smallest_time_scale(paper({}, micros(1)), {{}, micros(1)}), kSmallestTimeScale);
}

TEST(RealTime, WhereNoTimeScaleDoesItSaysSo) {
  const auto findings = check_real_time(paper({}, Duration{581'000'001}), kLargestTimeScale);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].expected.find("at most 581000 us at time scale 1000:"), std::string::npos)
      << findings[0].expected;
  EXPECT_TRUE(findings[0].expected.ends_with("; no --time-scale up to 1000 suffices")) << findings[0].expected;
}

TEST(RealTime, EachObstacleIsNamedAtItsLine) {
  const model::Cluster cluster = load_checked_cluster(shipped_path("flexray_demo"));
  const auto findings = check_real_time(cluster, kTimeScaleOne);
  ASSERT_EQ(findings.size(), 3u) << sentences(findings);
  EXPECT_EQ(findings[0].key, "real_time");
  EXPECT_GT(findings[0].line, 0);
  EXPECT_EQ(findings[0].expected,
            "is missing: without an arrival window {early, late} a cluster is for virtual time only");
  EXPECT_EQ(findings[1].key, "frames[7] (slot 21)");
  EXPECT_NE(line_of(cluster.text, findings[1].line).find("{slot: 21,"), std::string::npos);
  EXPECT_NE(findings[1].expected.find("must be a static slot, 1..20, in real time"), std::string::npos);
  EXPECT_NE(findings[1].expected.find("minislots of 7 us"), std::string::npos);
  EXPECT_EQ(findings[2].key, "topology");
  EXPECT_EQ(line_of(cluster.text, findings[2].line), "topology: star");
  EXPECT_EQ(findings[2].expected,
            "must be bus in real time: stars, and guardians in them, are simulated in virtual time only");
}

// Laser and camera have 1 to 4, each on its own CAN: the other's identifiers are free there.
TEST(RealTime, ASensorsLinesHaveTheirIdentifiersToThemselves) {
  const auto found = [](std::size_t can, std::uint32_t identifier) {
    model::Cluster cluster = paper({}, micros(500));
    cluster.can_buses[can].messages[0].identifier = identifier;
    return check_real_time(cluster, kTimeScaleOne);
  };
  const auto strobe = found(0, 1), trigger = found(1, 4);
  ASSERT_EQ(strobe.size(), 1u) << sentences(strobe);
  EXPECT_EQ(strobe[0].key, "can.laser_can.messages[0]");
  EXPECT_EQ(strobe[0].value, "identifier 1");
  EXPECT_EQ(strobe[0].expected,
            "must be another identifier in real time: laser uses 1 for its strobe and 2 for its trigger");
  EXPECT_NE(line_of(paper({}, micros(500)).text, strobe[0].line).find("laser_scan"), std::string::npos);
  ASSERT_EQ(trigger.size(), 1u) << sentences(trigger);
  EXPECT_EQ(trigger[0].key, "can.camera_can.messages[0]");
  EXPECT_EQ(found(0, 2).size(), 1u);
  EXPECT_EQ(found(1, 3).size(), 1u);
  for (const std::uint32_t free : {0u, 3u, 4u, 5u}) EXPECT_TRUE(found(0, free).empty()) << free;
  for (const std::uint32_t free : {0u, 1u, 2u, 5u}) EXPECT_TRUE(found(1, free).empty()) << free;
  for (std::uint32_t free = 0; free < 6; ++free) EXPECT_TRUE(found(2, free).empty()) << free;  // no sensor's
}

// A device that keeps its raw data, or whose task begins by the schedule instead of with its sensor.
TEST(RealTime, ASensorsLinesNeedACan) {
  const model::Cluster whole = paper({}, micros(500));
  const NodeId device = whole.sensors[1].device;
  const auto found = [&](const auto& edit) {
    model::Cluster cluster = whole;
    for (model::Task& task : cluster.nodes[index_of(device)].tasks) edit(task);
    return check_real_time(cluster, kTimeScaleOne);
  };
  for (const auto& findings : {found([](model::Task& task) { task.writes.clear(); }),
                               found([](model::Task& task) { task.activation.kind = model::ActivationKind::kTime; })}) {
    ASSERT_EQ(findings.size(), 1u) << sentences(findings);
    EXPECT_EQ(findings[0].key, "sensors.camera.device");
    EXPECT_EQ(findings[0].value, "camera");
    EXPECT_EQ(findings[0].expected,
              "must write to a CAN in a task that the sensor activates: in real time trigger and strobe use the CAN "
              "of camera's raw data");
    EXPECT_EQ(findings[0].line, whole.sensors[1].line);
    EXPECT_NE(line_of(whole.text, findings[0].line).find("camera"), std::string::npos);
  }
}

TEST(RealTime, ShippedClustersHoldAtTimeScaleOne) {
  for (const std::string& name : shipped_clusters()) {
    const model::Cluster cluster = load_checked_cluster(shipped_path(name));
    const bool dynamic = std::any_of(cluster.frames.begin(), cluster.frames.end(),
                                     [&](const model::FrameSlot& frame) { return is_dynamic(cluster.flexray, frame); });
    EXPECT_EQ(cluster.arrival_window.has_value(),
              (name.starts_with("paper") || name.starts_with("two_lasers") || name.starts_with("moving") ||
               name.starts_with("closed_loop") || name.starts_with("adaptive_loop") ||
               name.starts_with("laser_and_radar") || name.starts_with("four_kinds")) &&
                  !dynamic)
        << name;
    if (!cluster.arrival_window) continue;
    EXPECT_TRUE(check_real_time(cluster, kTimeScaleOne).empty()) << sentences(check_real_time(cluster, kTimeScaleOne));
    EXPECT_EQ(cluster.arrival_window->early, micros(100));
    // One slot more leaves less room. Plans begin from the paper's.
    const bool more = name.starts_with("moving") || name.find("_loop_") != std::string::npos;
    EXPECT_EQ(cluster.arrival_window->late, micros(more && name.find("_planned") == std::string::npos ? 400 : 500));
  }
}

TEST(RealTime, TheSectionIsReadStrictly) {
  const std::string early = "early: 100 us", late = "late: 500 us", line = "real_time:";
  const std::string a_time = "must be a time with its unit (ns, us, ms or s), ";
  expect_named({
      {"late_0", late, "late: 0 us", {line, "real_time.late", "0 us", a_time + "1 ns..1000 ms"}},
      {"late_long", late, "late: 1.000000001 s", {line, "real_time.late", "1.000000001 s", a_time + "1 ns..1000 ms"}},
      {"late_unitless", late, "late: 500", {line, "real_time.late", "500", a_time}},
      {"early_negative", early, "early: -1 ns", {line, "real_time.early", "-1 ns", a_time + "0 ms..1000 ms"}},
      {"early_long", early, "early: 1001 ms", {line, "real_time.early", "1001 ms", a_time + "0 ms..1000 ms"}},
      {"no_early", early + ", ", "", {line, "real_time.early", "", "missing"}},
      {"no_late", ", " + late, "", {line, "real_time.late", "", "missing"}},
      {"unknown",
       late,
       late + ", later: 1 us",
       {line, "real_time.later", "", "is not a known key here (known: early, late)"}},
      {"no_mapping", "real_time: .*", "real_time: 500 us", {line, "real_time", "500 us", "must be a mapping"}},
  });
  const auto with = [](const std::string& section) {
    return file::parse_cluster(support::replaced(shipped_text("paper_synchronised"), "\nreal_time: .*", section),
                               "c.yaml");
  };
  EXPECT_FALSE(with("").arrival_window.has_value());
  const model::Cluster widest = with("\nreal_time: {early: 0 ns, late: 1 s}");
  EXPECT_EQ(widest.arrival_window->early, Duration{});
  EXPECT_EQ(widest.arrival_window->late, Duration::milliseconds(1'000));
}

TEST(RealTime, IsShown) {
  EXPECT_NE(exchange::show_text(paper(micros(100), micros(400)))
                .find("\nreal time\n  frames may arrive from 100 us before to 400 us after their action point; time "
                      "scale 1 has room for\n      581 us\n"),
            std::string::npos);
  EXPECT_NE(exchange::show_text(paper(micros(100), micros(1'162)))
                .find("\n  not at time scale 1: real_time.late = 1162 us must be at most 581 us"),
            std::string::npos);
  EXPECT_NE(exchange::show_text(file::load_cluster(shipped_path("laser_radar")))
                .find("\nreal time\n  not at time scale 1: real_time is missing"),
            std::string::npos);
}

}  // namespace
}  // namespace ttf::schedules::check
