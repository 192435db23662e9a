// Logs of several hosts with different, drifting clocks: merging puts them on one time.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include "core/file_bytes.h"
#include "recording/merge/common_time.h"
#include "recording/merge/merge.h"
#include "recording/merge/record_place.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/merge/split_log.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::recording::merge {
namespace {

using fusion::strategies::StrategyKind;
using sim::drives::Drive;

TrueTime ms(std::int64_t n) { return TrueTime{} + Duration::milliseconds(n); }

TEST(CommonTime, IsLinearBetweenItsPointsAndGoesOnAtTheHostsRate) {
  const CommonTime time({{ms(10), ms(100)}, {ms(20), ms(120)}, {ms(40), ms(130)}});
  EXPECT_EQ(time(ms(10)), ms(100));
  EXPECT_EQ(time(ms(15)), ms(110));
  EXPECT_EQ(time(ms(30)), ms(125));
  EXPECT_EQ(time(ms(40)), ms(130));
  EXPECT_EQ(time(ms(7)), ms(97));
  EXPECT_EQ(time(ms(1000)), ms(1090));
  EXPECT_EQ(CommonTime()(ms(7)), ms(7));
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(time(TrueTime{kLast}).ns, kLast);
  EXPECT_EQ(CommonTime({{ms(10), ms(0)}})(TrueTime{-kLast}).ns, -kLast - 1);
}

// A record's own time places it among the others, so every kind must be put on the common scale.
TEST(CommonTime, MovesEveryKindOfRecord) {
  const CommonTime later({{ms(0), ms(1000)}});
  for (int kind = 1; kind <= static_cast<int>(records::kKindCount); ++kind) {
    TrueTime before, after;
    emit(*placing([&](const RecordPlace& place) { before = place.at; }), kind, Values::kDrawn, 3, 5'000'000);
    const auto placed = placing([&](const RecordPlace& place) { after = place.at; });
    emit(*on_common_time(later, *placed), kind, Values::kDrawn, 3, 5'000'000);
    EXPECT_GE(before, ms(4)) << kind;
    EXPECT_EQ(after - before, Duration::milliseconds(1000)) << kind;
  }
}

// A host's clock by the simulator's time: ahead, and faster, for the first 100 s.
CommonTime machine_clock(Duration ahead, std::int64_t ppm) {
  const TrueTime end = ms(100'000);
  return CommonTime({{TrueTime{}, TrueTime{} + ahead}, {end, end + ahead + Duration{ppm * 100'000}}});
}

// Each task's start, keyed by values that no merge changes: node, task and the node's local time.
struct Runs final : records::Sink {
  std::map<std::tuple<NodeId, std::uint8_t, LocalTime>, TrueTime> starts;
  using records::Sink::on;
  void on(const records::TaskRun& r) override { starts[{r.start.node, r.task, r.start.local}] = r.start.true_time; }
};

struct Host {
  std::string name;
  CommonTime clock;
};

// The drive's logs by processes on these hosts; `host_of` gives each node's host.
struct Hosts {
  Runs truth;
  std::vector<std::string> paths;

  Hosts(const Drive& drive, const std::vector<Host>& hosts, const std::function<std::size_t(ttf::NodeId)>& host_of) {
    std::vector<std::unique_ptr<log::LogWriter>> writers;
    std::vector<std::unique_ptr<records::Sink>> clocks;
    for (const Host& host : hosts) {
      log::LogManifest manifest = log::sample_manifest();
      manifest.cycle_ns = drive.cluster.cycle().ns;
      manifest.host = host.name;
      paths.push_back(log::scratch(host.name + ".mcap"));
      writers.push_back(std::make_unique<log::LogWriter>(paths.back(), manifest));
      clocks.push_back(on_common_time(host.clock, *writers.back()));
    }
    std::vector<records::Sink*> of_node;
    for (std::size_t n = 0; n < drive.cluster.nodes.size(); ++n)
      of_node.push_back(clocks[host_of(static_cast<NodeId>(n))].get());
    ByNode by_node(of_node);
    records::Tee tee({&by_node, &truth});
    drive.run(tee);
    for (auto& writer : writers) writer->close();
  }

  // The largest distance between the times of events within the same 20 ms, relative to the simulator's time.
  Duration most_apart(const std::function<void(ttf::recording::records::Sink&)>& read) const {
    Runs runs;
    read(runs);
    EXPECT_EQ(runs.starts.size(), truth.starts.size());
    std::map<std::int64_t, std::pair<Duration, Duration>> gains;
    for (const auto& [run, at] : truth.starts) {
      const auto merged = runs.starts.find(run);
      if (merged == runs.starts.end()) continue;
      const Duration gain = merged->second - at;
      const auto [entry, first] = gains.try_emplace(at.ns / 20'000'000, gain, gain);
      entry->second = {std::min(entry->second.first, gain), std::max(entry->second.second, gain)};
    }
    Duration most{};
    for (const auto& [when, gain] : gains) most = std::max(most, gain.second - gain.first);
    return most;
  }
};

TEST(MergeHosts, ClocksOfDifferentHostsAreBroughtTogether) {
  const Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kTt);
  const std::vector<Host> three{{"ash", machine_clock(Duration{}, 0)},
                                {"elm", machine_clock(Duration::milliseconds(7), 80)},
                                {"oak", machine_clock(Duration::milliseconds(-40), -50)}};
  const Hosts hosts(drive, three, [](NodeId node) { return index_of(node) % 3; });
  const auto as_logged = [&](records::Sink& sink) {
    for (const std::string& path : hosts.paths) log::read_log(path, sink);
  };
  EXPECT_GT(hosts.most_apart(as_logged), Duration::milliseconds(46));
  const MergedLogs merged(hosts.paths);
  EXPECT_EQ(merged.warnings(), std::vector<std::string>{});
  EXPECT_LT(hosts.most_apart([&](records::Sink& sink) { merged.read(sink); }), Duration::microseconds(5));
  EXPECT_EQ(merged.manifest().clock, log::kCommonClock);
  EXPECT_EQ(merged.manifest().host, "");

  // Any order gives the same, and merging again keeps the time.
  write_merged(merged, log::scratch("forest.mcap"));
  write_merged(MergedLogs({hosts.paths[2], hosts.paths[0], hosts.paths[1]}), log::scratch("other.mcap"));
  const std::string bytes = read_file(log::scratch("forest.mcap"));
  EXPECT_TRUE(bytes == read_file(log::scratch("other.mcap")));
  write_merged(MergedLogs(std::vector<std::string>{log::scratch("forest.mcap")}), log::scratch("other.mcap"));
  EXPECT_TRUE(bytes == read_file(log::scratch("other.mcap")));
}

// A node that restarts counts whole rounds of 64 cycles less than before.
TEST(MergeHosts, ANodeThatRestartsStaysOnItsHostsTime) {
  const Drive drive("scenarios/faulty_bus.yaml", StrategyKind::kTt);
  const NodeId camera = drive.cluster.find_node("camera_pre").value();
  const std::vector<Host> two{{"near", machine_clock(Duration{}, 0)},
                              {"far", machine_clock(Duration::milliseconds(120), 100)}};
  const Hosts hosts(drive, two, [&](NodeId node) { return node == camera ? std::size_t{1} : std::size_t{0}; });
  const MergedLogs merged(hosts.paths);
  EXPECT_LT(hosts.most_apart([&](records::Sink& sink) { merged.read(sink); }), Duration::microseconds(20));
}

TEST(MergeHosts, OnOneHostOrWithoutSynchronisationTimesStayAsTheyAre) {
  const Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kTt);
  const std::vector<Host> one{{"ash", machine_clock(Duration::milliseconds(3), 10)}};
  const Hosts alone(drive, one, [](NodeId) { return std::size_t{0}; });
  const MergedLogs merged(alone.paths);
  EXPECT_EQ(merged.manifest().clock, log::kWallClock);
  EXPECT_EQ(merged.manifest().host, "ash");
  Runs runs;
  merged.read(runs);
  const auto& [run, at] = *alone.truth.starts.begin();
  EXPECT_EQ(runs.starts.at(run), machine_clock(Duration::milliseconds(3), 10)(at));

  const NodeId off_flexray = [&] {
    std::size_t n = 0;
    while (drive.cluster.nodes[n].flexray) ++n;
    return static_cast<NodeId>(n);
  }();
  const std::vector<Host> two{{"ash", machine_clock(Duration{}, 0)},
                              {"elm", machine_clock(Duration::milliseconds(9), 0)}};
  const Hosts apart(drive, two, [&](NodeId node) { return node == off_flexray ? std::size_t{1} : std::size_t{0}; });
  const MergedLogs both(apart.paths);
  EXPECT_EQ(both.warnings(), std::vector<std::string>{
                                 "no node of machine elm was synchronised: its logs keep the times of its own clock"});
  EXPECT_GT(apart.most_apart([&](records::Sink& sink) { both.read(sink); }), Duration::milliseconds(8));
}

}  // namespace
}  // namespace ttf::recording::merge
