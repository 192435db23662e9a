// Whole drives: determinism, order of arrival, and the use of the bus' content.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "recording/log/writer.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/sim/drives/image_copy.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

std::string log_of(const Drive& drive, std::uint64_t seed, const std::string& name) {
  const std::string path = testing::TempDir() + "/" + name + ".mcap";
  recording::log::LogManifest manifest;
  manifest.seed = seed;
  recording::log::LogWriter log(path, manifest);
  drive.run(log, seed);
  log.close();
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

TEST(Drive, SameSeedSameLogBytesOtherSeedOthers) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive("scenarios/paper_scenario2.yaml", strategy);
    const std::string first = log_of(drive, 5, "first"), second = log_of(drive, 5, "second");
    EXPECT_GT(first.size(), 100'000u);
    EXPECT_TRUE(first == second) << name_of(strategy);
    EXPECT_FALSE(first == log_of(drive, 6, "third")) << name_of(strategy);
  }
}

struct FusedLists final : recording::records::Sink {
  using recording::records::Sink::on;
  std::vector<MeasurementId> ids;
  void on(const recording::records::ListFused& list) override {
    if (list.disposition == recording::records::Disposition::kFused ||
        list.disposition == recording::records::Disposition::kFusedLate)
      ids.push_back(list.id);
  }
};

TEST(Drive, ShippedDrivesHaveOutOfSequenceArrivalsAndTheStrategiesDiffer) {
  std::vector<Images> images(3);
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive("scenarios/paper_scenario1.yaml", strategy);
    evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
    recording::records::Tee tee({&measures, &images[static_cast<std::size_t>(strategy)]});
    drive.run(tee);
    const evaluation::accuracy::DriveSummary summary = measures.finish();
    EXPECT_EQ(summary.out_of_sequence == 0, strategy == StrategyKind::kTt);
    if (strategy == StrategyKind::kBuff) {
      EXPECT_GT(summary.held, 0u);
      EXPECT_EQ(summary.fused_late, 0u);
    }
    if (strategy == StrategyKind::kAdva) {
      EXPECT_EQ(summary.fused_late, summary.out_of_sequence);
    }
    EXPECT_EQ(summary.dropped, 0u);
    EXPECT_EQ(summary.missed, 0u);
  }
  const auto differ = [&](std::size_t a, std::size_t b) {
    return std::any_of(images[a].written.begin(), images[a].written.end(), [&](const auto& entry) {
      const auto other = images[b].written.find(entry.first);
      return other != images[b].written.end() && !same(entry.second.objects, other->second.objects);
    });
  };
  EXPECT_TRUE(differ(0, 1));
  EXPECT_TRUE(differ(1, 2));
  EXPECT_TRUE(differ(0, 2));
}

TEST(Drive, EveryListIsFusedExactlyOnce) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    FusedLists fused;
    Drive("scenarios/paper_scenario2.yaml", strategy).run(fused);
    std::sort(fused.ids.begin(), fused.ids.end());
    EXPECT_EQ(std::adjacent_find(fused.ids.begin(), fused.ids.end()), fused.ids.end()) << name_of(strategy);
    EXPECT_GT(fused.ids.size(), 90u);
  }
}

// The feature service uses the image written under its sequence number, equal in every field, decoded from
// the bus.
TEST(Drive, TheFeatureServiceUsesWhatTheBusCarried) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive("scenarios/paper_scenario1.yaml", strategy);
    Images images;
    drive.run(images);
    ASSERT_GT(images.used.size(), 60u);
    std::set<std::uint32_t> seen;
    std::size_t objects = 0;
    for (const Images::Use& use : images.used) {
      const auto written = images.written.find(use.sequence);
      ASSERT_NE(written, images.written.end()) << "image " << use.sequence;
      // The bus carries the instant in microseconds.
      EXPECT_EQ(use.valid_at, written->second.valid_at) << "image " << use.sequence;
      EXPECT_TRUE(same(use.objects, written->second.objects)) << "image " << use.sequence;
      EXPECT_EQ(use.fresh, seen.insert(use.sequence).second) << "image " << use.sequence;
      objects += use.objects.size();
    }
    EXPECT_GT(seen.size(), 60u);
    EXPECT_GT(objects, 50u);
  }
}

}  // namespace
}  // namespace ttf::sim::drives
