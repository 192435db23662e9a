#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "schedules/analysis/ages.h"
#include "schedules/analysis/dynamic_load.h"
#include "schedules/exchange/cluster_text.h"
#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules {
namespace {

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, LoadsAndChecksClean) {
  const model::Cluster cluster = file::load_cluster(shipped_path(GetParam()));
  EXPECT_EQ(cluster.name, GetParam());
  EXPECT_EQ(cluster.text, shipped_text(GetParam()));
  const auto findings = check::check(cluster);
  EXPECT_TRUE(findings.empty()) << sentences(findings);
}

TEST_P(Shipped, IsTheSameFromItsWholeText) {
  const model::Cluster cluster = file::load_cluster(shipped_path(GetParam()));
  EXPECT_EQ(dump(file::parse_cluster(cluster.text, "log.yaml")), dump(cluster));
}

TEST_P(Shipped, EverySensorReachesItsUse) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path(GetParam()));
  const auto ages = analysis::measurement_ages(cluster);
  const auto observing = std::count_if(cluster.sensors.begin(), cluster.sensors.end(), [](const model::Sensor& sensor) {
    return sensor.kind != model::SensorKind::kOdometry;
  });
  ASSERT_EQ(std::ssize(ages), observing);
  for (const analysis::AgePath& path : ages) {
    ASSERT_TRUE(path.reaches_use);
    EXPECT_GT(path.fusion_best, Duration{});
    EXPECT_LE(path.fusion_best, path.fusion_worst);
    EXPECT_LE(path.fused_best, path.fused_worst);
    EXPECT_LE(path.use_best, path.use_worst);
    EXPECT_LT(path.fusion_worst, path.fused_worst);
    EXPECT_LT(path.fused_worst, path.use_worst);
    EXPECT_LE(path.use_worst, path.newest_worst);
    EXPECT_LE(path.use_worst, path.buffered_use_worst + cluster.cycle());
    Duration best{}, worst{};
    for (const analysis::Contribution& part : path.to_use) best += part.best, worst += part.worst;
    EXPECT_EQ(best, path.use_best);
    EXPECT_EQ(worst, path.use_worst);
  }
}

TEST_P(Shipped, IsDrawnAsText) {
  const model::Cluster cluster = file::load_cluster(shipped_path(GetParam()));
  const std::string text = exchange::show_text(cluster);
  for (const model::Node& node : cluster.nodes)
    for (const model::Task& task : node.tasks) EXPECT_NE(text.find(task.name), std::string::npos) << task.name;
  const bool one = cluster.pdu(*cluster.find_pdu("image")).max_fragments() == 1;
  EXPECT_NE(text.find(one ? "image 0" : "image 0-"), std::string::npos);
  EXPECT_NE(text.find("(sync, startup)"), std::string::npos);
}

TEST_P(Shipped, IsTextOfAtMost100Columns) {
  const model::Cluster cluster = file::load_cluster(shipped_path(GetParam()));
  std::istringstream lines(exchange::show_text(cluster) + analysis::ages_text(cluster) +
                           analysis::dynamic_text(cluster));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

INSTANTIATE_TEST_SUITE_P(Clusters, Shipped, testing::ValuesIn(shipped_clusters()),
                         [](const auto& parameter) { return parameter.param; });

TEST(ShippedPaper, HoldsThePapersFigures) {
  const model::Cluster cluster = file::load_cluster(shipped_path("paper_unsynchronised"));
  EXPECT_EQ(cluster.cycle(), Duration::milliseconds(5));
  EXPECT_EQ(cluster.flexray.baudrate, 10'000'000);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("image")).max_elements, 25);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("image")).max_fragments(), 13);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("image")).element_bits, 192);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("laser_objects")).max_fragments(), 9);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("laser_objects")).element_bits, 128);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("camera_objects")).max_fragments(), 7);
  EXPECT_EQ(cluster.pdu(*cluster.find_pdu("camera_objects")).element_bits, 96);
  for (const model::Task& task : cluster.node(*cluster.find_node("fusion")).tasks) {
    const Duration period = cluster.cycle() * task.activation.at.repetition;
    EXPECT_EQ(period, Duration::milliseconds(task.name == "fuse" ? 10 : 40));
  }
  EXPECT_EQ(cluster.node(*cluster.find_node("feature")).tasks[0].activation.at.repetition, 8);
}

// The purpose of synchronised sensors: a smaller and far more even age when used.
TEST(ShippedPaper, SynchronisedMeasurementsAreYoungerAtWorst) {
  const auto loose = analysis::measurement_ages(file::load_cluster(shipped_path("paper_unsynchronised")));
  const auto tight = analysis::measurement_ages(file::load_cluster(shipped_path("paper_synchronised")));
  for (std::size_t s = 0; s < loose.size(); ++s) {
    EXPECT_LT(tight[s].use_worst, loose[s].use_worst);
    EXPECT_LT(tight[s].use_worst - tight[s].use_best, Duration::milliseconds(1));
    EXPECT_GT(loose[s].use_worst - loose[s].use_best, Duration::milliseconds(40));
  }
}

// The laser's slowest list comes later than the camera's fastest one that was measured after it.
TEST(ShippedPaper, UnsynchronisedListsCanArriveOutOfSequence) {
  const model::Cluster cluster = file::load_cluster(shipped_path("paper_unsynchronised"));
  const auto ages = analysis::measurement_ages(cluster);
  const auto& laser = ages[index_of(*cluster.find_sensor("laser"))];
  const auto& camera = ages[index_of(*cluster.find_sensor("camera"))];
  EXPECT_GT(laser.fusion_worst, camera.fusion_best + Duration::milliseconds(10));
  EXPECT_NE(cluster.sensors[0].period.ns % cluster.sensors[1].period.ns, 0);
}

}  // namespace
}  // namespace ttf::schedules
