// Runs in real time, made by hand: late and lost frames, and the clocks' distance.
#include "evaluation/lateness/lateness_account.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include "core/random.h"
#include "evaluation/accuracy/drive_measures.h"
#include "recording/log/writer.h"
#include "tests/evaluation/accuracy/synthetic_uses.h"

namespace ttf::evaluation::lateness {
namespace {

constexpr std::int64_t kCycleNs = 5'000'000;
constexpr std::int64_t kRoundNs = 64 * kCycleNs;

// A node's clock of the cluster by its host's.
struct HandClock {
  NodeId node{};
  std::function<std::int64_t(std::int64_t)> ahead_ns;

  recording::records::Stamp at(std::int64_t host_ns) const {
    return {TrueTime{host_ns}, LocalTime{-1}, GlobalTime{host_ns + ahead_ns(host_ns)}, node};
  }
};
std::function<std::int64_t(std::int64_t)> always(std::int64_t ns) {
  return [ns](std::int64_t) { return ns; };
}

// A stamp of each in every double cycle, one node after the other, in order of the host's clock.
std::vector<recording::records::Stamp> stamps_of(const std::vector<HandClock>& clocks, int double_cycles,
                                                 const std::function<bool(ttf::NodeId, int)>& there = {}) {
  std::vector<recording::records::Stamp> stamps;
  for (int k = 0; k < double_cycles; ++k)
    for (std::size_t c = 0; c < clocks.size(); ++c)
      if (!there || there(clocks[c].node, k))
        stamps.push_back(clocks[c].at(2 * kCycleNs * k + static_cast<std::int64_t>(c) * 300'000));
  return stamps;
}
recording::records::BinnedDurations apart(const std::vector<recording::records::Stamp>& stamps) {
  AchievedPrecision precision(Duration{kCycleNs});
  for (const recording::records::Stamp& stamp : stamps) precision.add(stamp);
  return precision.finish();
}

TEST(AchievedPrecision, IsTheLargestDifferenceOfAnyTwoNodes) {
  const auto found =
      apart(stamps_of({{NodeId{0}, always(4'000)}, {NodeId{1}, always(-9'000)}, {NodeId{2}, always(1'000)}}, 10));
  EXPECT_EQ(found.longest(), Duration{13'000});
  EXPECT_EQ(found.quantile(500), Duration{13'000});
  // 30 instants. At the first, only one node has shown its time; at the last two, only those still to come.
  EXPECT_EQ(found.count(), 28u);
}

TEST(AchievedPrecision, BetweenStampsAClockGoesStraight) {
  // Node 1 gains 50 ppm, and is 300 us after node 0: at node 0's stamps it shows 0.05 us per ms.
  const auto gaining = [](std::int64_t host_ns) { return host_ns / 20'000; };
  const auto found = apart(stamps_of({{NodeId{0}, always(0)}, {NodeId{1}, gaining}}, 101));
  // The last instant that both have shown their time of is node 0's last: 1 s.
  EXPECT_EQ(found.longest(), Duration{50'000});
  EXPECT_EQ(found.count(), 200u);
}

// An oracle: draws of clocks, and the difference at every stamp by their closed form.
TEST(AchievedPrecision, DrawnClocksAreAsFarApartAsTheirFormulasSay) {
  for (std::uint32_t draw = 0; draw < 20; ++draw) {
    RandomStream stream({.seed = 3, .purpose = Purpose::kTest, .index = draw});
    std::vector<HandClock> clocks;
    std::vector<std::pair<std::int64_t, std::int64_t>> lines;  // ahead, ns per ms
    for (std::uint8_t n = 0; n < 5; ++n) {
      const std::int64_t ahead = stream.integer(-30'000, 30'000), gain = stream.integer(-20, 20);
      const std::int64_t rounds = stream.integer(-3, 3) * kRoundNs;  // by its own count
      lines.emplace_back(ahead, gain);
      clocks.push_back({NodeId{n}, [=](std::int64_t host_ns) { return ahead + gain * host_ns / 1'000'000 + rounds; }});
    }
    std::int64_t largest = 0;
    const int count = 40;
    // From node 4's first stamp to node 0's last all clocks are known.
    for (std::int64_t at = 1'200'000; at <= 2 * kCycleNs * (count - 1); at += 100'000) {
      std::vector<std::int64_t> shown;
      for (const auto& [ahead, gain] : lines) shown.push_back(ahead + gain * at / 1'000'000);
      const auto [low, high] = std::minmax_element(shown.begin(), shown.end());
      largest = std::max(largest, *high - *low);
    }
    const auto found = apart(stamps_of(clocks, count));
    EXPECT_NEAR(static_cast<double>(found.longest().ns), static_cast<double>(largest), 50.0) << draw;
  }
}

TEST(AchievedPrecision, OfOneClockOrOfNoneThereIsNone) {
  EXPECT_TRUE(apart({}).empty());
  EXPECT_TRUE(apart(stamps_of({{NodeId{0}, always(7)}}, 20)).empty());
  // A node without global time shows its local time again.
  auto stamps = stamps_of({{NodeId{0}, always(0)}, {NodeId{1}, always(5'000)}}, 20);
  for (recording::records::Stamp& stamp : stamps)
    if (stamp.node == NodeId{1}) stamp.local.ns = stamp.global.ns;
  EXPECT_TRUE(apart(stamps).empty());
}

TEST(AchievedPrecision, ASilentNodeHasNoTimeMeanwhile) {
  // Node 1 is 20 us ahead before its silence. On another count of rounds, it is 2 us ahead after it.
  const std::vector<HandClock> clocks{
      {NodeId{0}, always(0)},
      {NodeId{1}, [](std::int64_t host_ns) { return host_ns < 50 * kCycleNs ? 20'000 : 2'000 - 5 * kRoundNs; }}};
  const auto all = stamps_of(clocks, 60);
  const auto silent = stamps_of(clocks, 60, [](NodeId node, int k) { return node == NodeId{0} || k < 20 || k >= 30; });
  EXPECT_EQ(apart(silent).longest(), Duration{20'000});
  EXPECT_EQ(apart(all).longest(), Duration{20'000});
  // Ten stamps of node 1 are missing. Node 0's from k = 20 to 30 lie between node 1's of k = 19 and of k =
  // 30, which is 300 us later than node 0's.
  EXPECT_EQ(apart(all).count() - apart(silent).count(), 10u + 11u);
  // One missing stamp is bridged.
  const auto gap = stamps_of(clocks, 60, [](NodeId node, int k) { return node == NodeId{0} || k != 20; });
  EXPECT_EQ(apart(all).count() - apart(gap).count(), 1u);
}

TEST(AchievedPrecision, ImpossibleTimesAreLeftOut) {
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  AchievedPrecision precision(Duration{kCycleNs});
  for (const std::int64_t at : {-kFar - 1, kFar, std::int64_t{0}, std::int64_t{1} << 60, -(std::int64_t{1} << 60)})
    for (const std::int64_t global : {-kFar - 1, kFar, std::int64_t{1} << 60, -(std::int64_t{1} << 60)})
      for (const NodeId node : {NodeId{0}, NodeId{255}})
        precision.add({TrueTime{at}, LocalTime{1}, GlobalTime{global}, node});
  EXPECT_LT(precision.finish().longest(), Duration{kRoundNs});
  for (const Duration cycle : {Duration{}, Duration{-1}, Duration{kFar}}) {
    AchievedPrecision without(cycle);
    without.add({TrueTime{1}, {}, GlobalTime{1}, NodeId{0}});
    EXPECT_TRUE(without.finish().empty());
  }
}

// ----------------------------------------------------------------------------------------------------- account

schedules::model::Cluster three_nodes() {
  schedules::model::Cluster cluster;
  cluster.flexray.gMacroPerCycle = 5000;
  for (const char* name : {"laser", "fusion", "feature"}) {
    schedules::model::Node node;
    node.name = name;
    node.microtick_ps = 25'000;
    cluster.nodes.push_back(node);
  }
  return cluster;
}

recording::records::TimingProblem problem(int node, recording::records::TimingFault what, std::uint32_t count = 1) {
  recording::records::TimingProblem one;
  one.stamp.node = NodeId{static_cast<std::uint8_t>(node)};
  one.what = what;
  one.count = count;
  return one;
}
recording::records::ClockCorrected corrected(const recording::records::Stamp& stamp, std::int32_t offset_microticks) {
  return {stamp, 1, offset_microticks, 0};
}

TEST(LatenessAccount, InVirtualTimeThereIsNothingToReport) {
  const schedules::model::Cluster cluster = three_nodes();
  LatenessAccount account(cluster, {});
  account.on(corrected({{}, {}, {}, NodeId{1}}, 5));
  EXPECT_EQ(account.finish(), std::nullopt);
}

TEST(LatenessAccount, CountsWhatWasNotInItsTimeByNodeAndKind) {
  const schedules::model::Cluster cluster = three_nodes();
  LatenessAccount account(cluster, {});
  account.on(problem(0, recording::records::TimingFault::kLateWakeUp));
  account.on(problem(0, recording::records::TimingFault::kLateWakeUp));
  account.on(problem(0, recording::records::TimingFault::kSlotMissed));
  account.on(problem(1, recording::records::TimingFault::kLateFrame));
  account.on(problem(1, recording::records::TimingFault::kEarlyFrame, 3));
  account.on(problem(1, recording::records::TimingFault::kFramesLost, 7));
  account.on(problem(2, recording::records::TimingFault::kFramesLost, 2));
  account.on(problem(2, recording::records::TimingFault{200}, 9));           // from a later version
  account.on(problem(77, recording::records::TimingFault::kFramesLost, 9));  // from another cluster
  const auto found = account.finish();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->timing.size(), 3u);
  EXPECT_EQ(found->timing.at(NodeId{0}).late_wake_ups, 2u);
  EXPECT_EQ(found->timing.at(NodeId{0}).slots_missed, 1u);
  EXPECT_EQ(found->timing.at(NodeId{1}).late_frames, 1u);
  EXPECT_EQ(found->timing.at(NodeId{1}).early_frames, 3u);
  EXPECT_EQ(found->frames_lost(), 9u);
  EXPECT_EQ(found->late_frames(), 1u);
  EXPECT_FALSE(found->timing.at(NodeId{2}).largest_offset_correction.has_value());
}

recording::records::MediumCounts counted(int node, std::int64_t local_ms, std::uint64_t of_each) {
  const NodeId id{static_cast<std::uint8_t>(node)};
  return {{{}, LocalTime{local_ms * 1'000'000}, {}, id},
          of_each,
          of_each + 1,
          of_each + 2,
          of_each + 3,
          of_each + 4,
          of_each + 5,
          of_each + 6};
}

TEST(LatenessAccount, MediaCountsAreOfTheWholeRun) {
  const schedules::model::Cluster cluster = three_nodes();
  LatenessAccount account(cluster, {});
  account.on(counted(0, 100, 10));
  account.on(counted(0, 200, 20));  // since the process began
  account.on(counted(1, 100, 10));
  account.on(counted(1, 200, 9));  // another process
  account.on(counted(1, 300, 90));
  account.on(counted(2, 200, 5));
  account.on(counted(2, 100, 50));  // another, whose clock began again
  account.on(counted(77, 1, 1));    // from another cluster
  const auto found = account.finish();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->timing.size(), 3u);
  ASSERT_EQ(found->medium.size(), 3u);
  EXPECT_EQ(found->medium.at(NodeId{0}).sent, 20u);
  EXPECT_EQ(found->medium.at(NodeId{0}).received, 21u);
  EXPECT_EQ(found->medium.at(NodeId{0}).not_sent, 22u);
  EXPECT_EQ(found->medium.at(NodeId{0}).lost, 23u);
  EXPECT_EQ(found->medium.at(NodeId{0}).foreign, 24u);
  EXPECT_EQ(found->medium.at(NodeId{0}).malformed, 25u);
  EXPECT_EQ(found->medium.at(NodeId{0}).dropped, 26u);
  EXPECT_EQ(found->medium.at(NodeId{1}).sent, 100u);
  EXPECT_EQ(found->medium.at(NodeId{1}).dropped, 112u);
  EXPECT_EQ(found->medium.at(NodeId{2}).sent, 55u);
}

// One of two absent frames was withheld: its sender reports it in another log.
TEST(LatenessAccount, WithheldFramesAreCountedApart) {
  schedules::model::Cluster cluster = three_nodes();
  schedules::model::FrameSlot frame;
  frame.slot = 4;
  frame.sender = NodeId{0};
  cluster.frames.push_back(frame);
  LatenessAccount account(cluster, {});
  auto missed = problem(0, recording::records::TimingFault::kSlotMissed),
       lost = problem(1, recording::records::TimingFault::kFramesLost, 2);
  missed.slot = lost.slot = 4;
  missed.cycle = 10;
  missed.stamp.true_time = accuracy::at(50);
  lost.cycle = 12;
  lost.stamp.true_time = accuracy::at(60);
  account.on(lost);
  account.on(missed);
  const auto found = account.finish();
  EXPECT_EQ(found->timing.at(NodeId{1}).frames_lost, 2u);
  EXPECT_EQ(found->timing.at(NodeId{1}).missing.away, 0u) << "no log says what was sent";
  EXPECT_EQ(found->timing.at(NodeId{1}).missing.withheld, 1u);
  EXPECT_EQ(found->timing.at(NodeId{1}).lost_on_the_way(), 1u);
  EXPECT_EQ(found->timing.at(NodeId{0}).missing.withheld, 0u);
}

TEST(LatenessAccount, TheLargestCorrectionIsBySizeAndInRealTime) {
  const schedules::model::Cluster cluster = three_nodes();
  for (const auto& [ppm, expected_ns] : {std::pair(1'000'000, 10'000), std::pair(20'000'000, 200'000)}) {
    LatenessAccount account(cluster, {ppm, {}});
    account.on(problem(0, recording::records::TimingFault::kLateWakeUp));
    for (const std::int32_t microticks : {12, -400, 399}) account.on(corrected({{}, {}, {}, NodeId{1}}, microticks));
    account.on(corrected({{}, {}, {}, NodeId{2}}, 0));
    const auto found = account.finish();
    EXPECT_EQ(found->timing.at(NodeId{1}).largest_offset_correction, Duration{expected_ns});
    EXPECT_EQ(found->timing.at(NodeId{2}).largest_offset_correction, Duration{});
  }
}

TEST(LatenessAccount, ClocksAreComparedOnTheirOwnHostOnly) {
  const schedules::model::Cluster cluster = three_nodes();
  const std::vector<HandClock> clocks{
      {NodeId{0}, always(0)}, {NodeId{1}, always(9'000'000)}, {NodeId{2}, always(3'000)}};
  const auto precision_on = [&](const std::map<NodeId, std::string>& hosts) {
    LatenessAccount account(cluster, {1'000'000, hosts});
    account.on(problem(0, recording::records::TimingFault::kLateWakeUp));
    for (const recording::records::Stamp& stamp : stamps_of(clocks, 20)) account.on(corrected(stamp, 1));
    return account.finish()->precision;
  };
  const auto apart_hosts = precision_on({{NodeId{0}, "ash"}, {NodeId{1}, "elm"}, {NodeId{2}, "ash"}});
  ASSERT_EQ(apart_hosts.size(), 1u) << "elm has one node alone";
  EXPECT_EQ(apart_hosts[0].host, "ash");
  EXPECT_EQ(apart_hosts[0].apart.longest(), Duration{3'000});
  const auto one_host = precision_on({{NodeId{0}, "ash"}, {NodeId{1}, "ash"}, {NodeId{2}, "ash"}});
  ASSERT_EQ(one_host.size(), 1u);
  EXPECT_EQ(one_host[0].apart.longest(), Duration{9'000'000});
  EXPECT_TRUE(precision_on({}).empty());
}

TEST(LatenessAccount, RealTimeIsTheDrivesTimesTheScale) {
  EXPECT_EQ(in_real_time(Duration{-7}, 1'000'000), Duration{-7});
  EXPECT_EQ(in_real_time(Duration{1'000}, 2'500'000), Duration{2'500});
  EXPECT_EQ(in_real_time(Duration{3}, 500'000), Duration{1});
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(in_real_time(Duration{kFar}, kFar), Duration{kFar});
  EXPECT_EQ(in_real_time(Duration{-kFar}, kFar), Duration{-kFar - 1});
}

// Logs as the processes write them: a node each, on two hosts.
TEST(LatenessAccount, MergedLogsOfSeveralNodesHaveTheWholeRun) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("ttf_test_lateness." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const schedules::model::Cluster cluster = three_nodes();
  ASSERT_EQ(cluster.cycle(), Duration{kCycleNs});
  // The far host's clock is 40 ms behind.
  const std::vector<std::int64_t> behind_ns{0, 0, 40'000'000};
  const std::vector<std::int64_t> ahead_ns{0, 6'000, 0};
  std::vector<std::string> paths;
  for (std::uint8_t n = 0; n < 3; ++n) {
    recording::log::LogManifest manifest;
    manifest.cycle_ns = kCycleNs;
    manifest.clock = recording::log::kWallClock;
    manifest.host = n < 2 ? "near" : "far";
    manifest.time_scale_ppm = 10'000'000;
    paths.push_back((folder / (std::to_string(n) + ".mcap")).string());
    recording::log::LogWriter log(paths.back(), manifest);
    const auto stamp = [&](std::int64_t ns) {
      return recording::records::Stamp{TrueTime{ns - behind_ns[n]}, LocalTime{ns - 1}, GlobalTime{ns + ahead_ns[n]},
                                       NodeId{n}};
    };
    for (std::int64_t k = 0; k < 30; ++k) {
      log.on(corrected(stamp(2 * kCycleNs * k + 100'000 * n), n == 1 ? -8 : 0));
      if (k % 10 != 9) continue;
      // Totals since the beginning: k wake-ups of (10 + n) us, one of 100 us.
      std::vector<std::uint64_t> counts(100);
      counts[10u + n] = static_cast<std::uint64_t>(k);
      counts[recording::records::lateness_bin(Duration::microseconds(100))] = 1;
      log.on(recording::records::LatenessHistogram{stamp(2 * kCycleNs * k + 500'000),
                                                   recording::records::LatenessOf::kWakeUps,
                                                   Duration::microseconds(100), counts});
    }
    auto lost = problem(n, recording::records::TimingFault::kFramesLost, n);
    lost.stamp = stamp(70'000'000);
    if (n > 0) log.on(lost);
    log.close();
  }
  const recording::merge::MergedLogs merged(paths);
  EXPECT_EQ(merged.warnings(), std::vector<std::string>{});
  const RealTimeDrive run = real_time_drive(merged);
  EXPECT_EQ(run.time_scale_ppm, 10'000'000);
  EXPECT_EQ(run.hosts, (std::map<NodeId, std::string>{{NodeId{0}, "near"}, {NodeId{1}, "near"}, {NodeId{2}, "far"}}));
  LatenessAccount account(cluster, run);
  merged.read(account);
  const auto found = account.finish();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->frames_lost(), 3u);
  ASSERT_EQ(found->lateness.size(), 3u);
  for (const auto& [node, late] : found->lateness) {
    EXPECT_EQ(late.wake_ups.count(), 30u);
    EXPECT_EQ(late.wake_ups.quantile(500), Duration::microseconds(11 + static_cast<std::int64_t>(index_of(node))));
    EXPECT_EQ(late.wake_ups.longest(), Duration::microseconds(100));
    EXPECT_TRUE(late.floor.empty());
  }
  EXPECT_EQ(found->timing.at(NodeId{1}).largest_offset_correction, Duration{8 * 25 * 10});
  ASSERT_EQ(found->precision.size(), 1u);
  EXPECT_EQ(found->precision[0].host, "near");
  EXPECT_NEAR(static_cast<double>(found->precision[0].apart.longest().ns), 6'000.0, 1.0);
  std::filesystem::remove_all(folder);
}

// ----------------------------------------------------------------------------------------- sensor to feature

// The measures' ages as distributions: of the oldest and the newest measurement fused in the used image.
TEST(Measures, AgesOfTheOldestAndTheNewestUsedAreTheSortedLists) {
  RandomStream stream({.seed = 5, .purpose = Purpose::kTest});
  accuracy::DriveMeasures measures(TrueTime{});
  std::vector<Duration> oldest, newest;
  accuracy::AgeStatistics all;
  for (std::uint32_t k = 0; k < 400; ++k) {
    const TrueTime now = accuracy::at(100 + 40 * k);
    std::vector<MeasurementId> ids;
    std::vector<Duration> ages;
    for (std::uint8_t sensor = 0; sensor < 3; ++sensor) {
      const Duration age = Duration::microseconds(stream.integer(5'000, 35'000));
      ages.push_back(age);
      all.add(age);
      ids.push_back({SensorId{sensor}, k});
      measures.on(recording::records::ListFused{{now, {}, GlobalTime{now.ns}, {}},
                                                k,
                                                ids.back(),
                                                GlobalTime{now.ns} - age,
                                                recording::records::Disposition::kFused});
    }
    write_image(measures, k, GlobalTime{now.ns}, {{10, 0}}, ids);
    use_image(measures, k, now, {{10, 0}});
    oldest.push_back(*std::max_element(ages.begin(), ages.end()));
    newest.push_back(*std::min_element(ages.begin(), ages.end()));
  }
  // An image too old to be used has no age.
  recording::records::FeatureUsed stale;
  stale.stamp.true_time = accuracy::at(20'000);
  stale.image_sequence = 399;
  stale.stale = true;
  measures.on(stale);
  const accuracy::DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.age_used.count, all.count);
  EXPECT_EQ(summary.age_used.worst, all.worst);
  for (auto [list, found] : {std::pair(oldest, summary.age_used_oldest), std::pair(newest, summary.age_used_newest)}) {
    std::sort(list.begin(), list.end());
    EXPECT_EQ(found.count(), 400u);
    EXPECT_EQ(found.longest(), list.back());
    for (const int percent : {50, 99}) {
      const Duration exact = list[static_cast<std::size_t>(4 * percent) - 1];
      EXPECT_GE(found.quantile(10 * percent), exact);
      EXPECT_LE(found.quantile(10 * percent).ns, exact.ns + exact.ns / 32 + 1);
    }
  }
}

}  // namespace
}  // namespace ttf::evaluation::lateness
