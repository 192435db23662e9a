// Other traffic on the CAN between preprocessing and fusion: lists wait for it no longer than the checker
// says.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "tests/sim/drives/ages/drive_ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

using fusion::strategies::StrategyKind;

constexpr std::size_t kObservationCan = 2;  // the third of the file's

Drive with_other_load(const std::string& load) {
  Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kAdva);
  std::string text = schedules::file::load_cluster(shipped("schedules/paper_event_triggered.yaml")).text;
  const auto at = text.rfind("other_load: 0.0");
  text.replace(at, std::string("other_load: 0.0").size(), "other_load: " + load);
  drive.cluster = schedules::file::parse_cluster(text, "cluster.yaml");
  EXPECT_EQ(drive.cluster.can_buses[kObservationCan].name, "observation_can");
  EXPECT_TRUE(schedules::check::check(drive.cluster).empty());
  return drive;
}

// The longest way of one drive's lists, from the end of their preprocessing to the fusion node.
struct Transfers final : recording::records::Sink {
  using recording::records::Sink::on;
  std::map<std::pair<PduId, std::uint32_t>, TrueTime> written;
  Duration longest{}, sum{};
  std::int64_t count = 0;
  void on(const recording::records::ListHop& hop) override {
    if (hop.can_bus != static_cast<int>(kObservationCan)) return;
    if (hop.hop == recording::records::Hop::kWritten) written[{hop.pdu, hop.sequence}] = hop.stamp.true_time;
    if (hop.hop != recording::records::Hop::kReceived) return;
    const Duration took = hop.stamp.true_time - written.at({hop.pdu, hop.sequence});
    longest = std::max(longest, took);
    sum += took;
    ++count;
  }
};

TEST(OtherTraffic, MakesListsWaitWithinTheBounds) {
  Transfers alone;
  const double quiet = with_other_load("0.0").run(alone).can_load.at(kObservationCan);
  Transfers before = alone;
  for (const char* load : {"0.2", "0.5"}) {
    SCOPED_TRACE(load);
    const Drive drive = with_other_load(load);
    Transfers among;
    Ages ages;
    double busy = 0.0;
    constexpr std::uint64_t kDrives = 10;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      among.written.clear();
      recording::records::Tee tee({&among, &ages});
      busy += drive.run(tee, seed).can_load.at(kObservationCan) / static_cast<double>(kDrives);
      ages.next_drive();
    }
    EXPECT_NEAR(busy, quiet + std::stod(load), 0.02);
    EXPECT_GT(among.longest, before.longest);
    EXPECT_GT(among.sum.ns / among.count, before.sum.ns / before.count);
    before = among;
    int parts = 0;
    for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(drive.cluster)) {
      EXPECT_GE(ages.fused[path.sensor].best, path.fused_best);
      EXPECT_LE(ages.fused[path.sensor].worst, path.fused_worst);
      for (const schedules::analysis::Contribution& part : path.to_fusion)
        if (part.name.find("on observation_can") != std::string::npos && part.name.find("laser") != std::string::npos) {
          EXPECT_LE(among.longest, part.worst);
          ++parts;
        }
    }
    EXPECT_EQ(parts, 1);
  }
}

}  // namespace
}  // namespace ttf::sim::drives::ages
