// The rows behind the figures, against the measures of the same drive, which count them one by one.
#include "evaluation/accuracy/drive_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/accuracy/drive_measures.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::evaluation::accuracy {
namespace {

class Rows : public testing::TestWithParam<const char*> {};

TEST_P(Rows, OfADriveComeToItsMeasures) {
  const sim::drives::Drive drive(GetParam(), fusion::strategies::StrategyKind::kAdva);
  DriveRows rows;
  DriveMeasures measures(TrueTime{});
  recording::records::Tee both({&rows, &measures});
  drive.run(both);
  rows.finish();
  const DriveSummary summary = measures.finish();
  ASSERT_EQ(rows.errors().size(), summary.matched);
  ASSERT_GT(summary.nees_samples, 20u);
  double x2 = 0.0, vy2 = 0.0, nees = 0.0, samples = 0.0;
  for (const ErrorRow& row : rows.errors()) {
    x2 += row.error[0] * row.error[0];
    vy2 += row.error[3] * row.error[3];
    if (std::isnan(row.nees)) continue;
    EXPECT_GT(row.sigma[0], 0.0);
    nees += row.nees;
    ++samples;
  }
  const auto n = static_cast<double>(rows.errors().size());
  EXPECT_NEAR(std::sqrt(x2 / n), summary.rmse_truth[0], 1e-12);
  EXPECT_NEAR(std::sqrt(vy2 / n), summary.rmse_truth[3], 1e-12);
  EXPECT_EQ(static_cast<std::uint64_t>(samples), summary.nees_samples);
  EXPECT_NEAR(nees / samples, summary.nees, 1e-9 * summary.nees);
  std::uint64_t in_windows = 0;
  double windows_nees = 0.0;
  for (const NeesRow& row : nees_rows(rows.errors())) {
    in_windows += row.samples;
    windows_nees += row.mean * static_cast<double>(row.samples);
    EXPECT_LT(row.low, 4.0);
    EXPECT_GT(row.high, 4.0);
  }
  EXPECT_EQ(in_windows, summary.nees_samples);
  EXPECT_NEAR(windows_nees, nees, 1e-9 * nees);
  EXPECT_LE(nees_rows(rows.errors()).size(), 27u);
  std::uint64_t fused = 0, used = 0;
  double fused_ms = 0.0;
  for (const auto& [what, histogram] : rows.ages())
    for (const auto& [bin, count] : histogram) {
      (what.first == AgeOf::kFused ? fused : used) += count;
      if (what.first == AgeOf::kFused) fused_ms += (static_cast<double>(bin) + 0.5) * static_cast<double>(count);
    }
  EXPECT_EQ(fused, summary.age_fused.count);
  EXPECT_EQ(used, summary.age_used.count);
  EXPECT_NEAR(fused_ms / static_cast<double>(fused), static_cast<double>(summary.age_fused.mean().ns) * 1e-6, 0.5);
}
INSTANTIATE_TEST_SUITE_P(Drives, Rows, testing::Values("scenarios/paper_scenario1.yaml", "scenarios/faulty_bus.yaml"));

TEST(DriveRows, AgesBelowZeroHaveBinsOfTheirOwn) {
  DriveRows rows;
  recording::records::ListFused fused;
  fused.disposition = recording::records::Disposition::kFused;
  for (const std::int64_t ns : {-1, 0, 999'999, -1'000'000, -1'000'001}) {
    fused.measured = GlobalTime{-ns};
    rows.on(fused);
  }
  const DriveRows::Histogram expected{{-2, 1}, {-1, 2}, {0, 2}};
  EXPECT_EQ(rows.ages().at({AgeOf::kFused, SensorId{0}}), expected);
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
