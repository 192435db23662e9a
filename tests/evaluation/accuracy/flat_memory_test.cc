// The measures' memory does not grow with the drive's length.
#include <gtest/gtest.h>

#include "evaluation/accuracy/drive_measures.h"
#include "tests/evaluation/accuracy/synthetic_uses.h"
#include "tests/support/allocation_counter.h"

namespace ttf::evaluation::accuracy {
namespace {

// 25 objects, a list every 20 ms, an image and a use every 40 ms, a fix every 100 ms.
void drive(DriveMeasures& measures, std::int64_t from_ms, std::int64_t to_ms, std::int64_t last_fix_ms) {
  for (std::int64_t ms = from_ms; ms < to_ms; ms += 20) {
    const TrueTime now = TrueTime{} + Duration::milliseconds(ms);
    const auto list = static_cast<std::uint32_t>(ms / 20);
    const MeasurementId id{SensorId{0}, list};
    const GlobalTime measured = GlobalTime{now.ns} - Duration::milliseconds(30);
    measures.on(recording::records::FusionInput{
        {now, {}, GlobalTime{now.ns}, {}}, list, PduId{0}, SensorId{0}, list, measured, 25, {}});
    measures.on(recording::records::ListFused{
        {now, {}, GlobalTime{now.ns}, {}}, list, id, measured, recording::records::Disposition::kFused});
    if (ms % 100 == 0 && ms <= last_fix_ms) {
      recording::records::ReferenceFix fix;
      fix.measured_true = now - Duration::milliseconds(60);
      fix.x = 20;
      measures.on(fix);
    }
    if (ms % 40 != 0) continue;
    std::vector<Shown> shown;
    for (int k = 0; k < 25; ++k) shown.push_back({20.0 + k, 10.0 * k});
    const auto image = static_cast<std::uint32_t>(ms / 40);
    write_image(measures, image, GlobalTime{now.ns}, shown, {id});
    use_image(measures, image, now, shown);
    for (std::uint16_t k = 0; k < 25; ++k) truth_at(measures, now, k, 20.5 + k, 10.0 * k);
  }
}

TEST(Measures, TheirMemoryDoesNotGrowWithTheDrive) {
  for (const bool reference_stays : {true, false}) {
    DriveMeasures measures(TrueTime{});
    const std::int64_t last_fix_ms = reference_stays ? 1'000'000 : 60'000;
    drive(measures, 0, 120'000, last_fix_ms);
    const std::int64_t after_two_minutes = support::live_bytes();
    ASSERT_GT(after_two_minutes, 0);
    drive(measures, 120'000, 600'000, last_fix_ms);
    // Ends of buffers may lie elsewhere; 12000 uses of 25 objects would be megabytes.
    EXPECT_LT(support::live_bytes() - after_two_minutes, 4096) << reference_stays;
    const DriveSummary summary = measures.finish();
    EXPECT_EQ(summary.matched, 25u * 15'000u);
    EXPECT_EQ(summary.age_used.count, 15'000u);
    EXPECT_GT(summary.reference_compared, reference_stays ? 14'000u : 1'400u);
  }
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
