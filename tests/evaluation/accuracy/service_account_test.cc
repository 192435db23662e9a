#include "evaluation/accuracy/service_account.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/evaluation/accuracy/synthetic_uses.h"

namespace ttf::evaluation::accuracy {
namespace {

constexpr SensorId kLaser{0}, kCamera{1};

// A list of the laser, measured at `measured` ms and fused 10 ms later.
MeasurementId fuse(recording::records::Sink& sink, std::uint32_t sequence, std::int64_t measured) {
  recording::records::ListFused list;
  list.stamp = {at(measured + 10), {}, GlobalTime{at(measured + 10).ns}, {}};
  list.id = {kLaser, sequence};
  list.measured = GlobalTime{at(measured).ns};
  list.disposition = recording::records::Disposition::kFused;
  sink.on(list);
  return list.id;
}

const std::map<SensorId, Duration> kLaserAlone{{kLaser, Duration::milliseconds(55)}};

// Measured every 40 ms, used every 20 ms and 30 ms after the measurement. Lists in `lost` do not come, uses in
// `missing` neither.
ServiceFindings drive(std::int64_t uses, std::int64_t lost = -1, std::int64_t missing = -1, std::int64_t many = 0,
                      const std::map<SensorId, Duration>& bounds = kLaserAlone) {
  ServiceAccount account(at(0), bounds);
  std::uint32_t image = 0;
  MeasurementId newest{};
  for (std::int64_t k = 0; k < uses; ++k) {
    if (k % 2 == 0 && k / 2 != lost) {
      newest = fuse(account, static_cast<std::uint32_t>(k / 2), 20 * k);
      write_image(account, ++image, GlobalTime{at(20 * k + 20).ns}, {}, {newest});
    }
    if (missing < 0 || k < missing || k >= missing + many) use_image(account, image, at(20 * k + 30), {});
  }
  return account.finish(at(20 * uses + 20));
}

TEST(ServiceAccount, ASoundDriveIsAsPromised) {
  const ServiceFindings findings = drive(50);
  EXPECT_TRUE(findings.as_promised());
  EXPECT_EQ(findings.uses, 50u);
}

TEST(ServiceAccount, ALostListMakesTheNewestOlderThanTheSchedulePromises) {
  const ServiceFindings findings = drive(50, 10);
  EXPECT_FALSE(findings.as_promised());
  ASSERT_EQ(findings.older.count(kLaser), 1u);
  const ServiceFindings::Older& older = findings.older.at(kLaser);
  EXPECT_EQ(older.uses, 2u);
  EXPECT_EQ(older.worst, Duration::milliseconds(90));
  EXPECT_EQ(older.bound, Duration::milliseconds(55));
  EXPECT_FALSE(findings.gap);
}

// Used at 30, 50, ... 1010 ms. The camera may need 100 ms to begin.
TEST(ServiceAccount, ASensorThatNeverComesIsNotAsPromised) {
  const std::map<SensorId, Duration> both{{kLaser, Duration::milliseconds(55)}, {kCamera, Duration::milliseconds(100)}};
  const ServiceFindings findings = drive(50, -1, -1, 0, both);
  EXPECT_FALSE(findings.as_promised());
  ASSERT_EQ(findings.older.size(), 1u);
  const ServiceFindings::Older& older = findings.older.at(kCamera);
  EXPECT_EQ(older.uses, 46u);
  EXPECT_EQ(older.missing, 46u);
  EXPECT_EQ(older.worst, Duration::milliseconds(1010));
  EXPECT_EQ(older.bound, Duration::milliseconds(100));
  EXPECT_TRUE(drive(4, -1, -1, 0, both).as_promised()) << "until 90 ms";
}

// The log may lack an image: its node was killed before it wrote.
TEST(ServiceAccount, AnUnknownImageSaysNothingOfTheSensors) {
  ServiceAccount account(at(0), kLaserAlone);
  for (std::int64_t k = 0; k < 50; ++k) use_image(account, 1, at(20 * k), {});
  EXPECT_TRUE(account.finish(at(1000)).as_promised());
}

// Its images begin without measurements.
TEST(ServiceAccount, ARestartedFusionNodeLosesTheNewestMeasurement) {
  ServiceAccount account(at(0), kLaserAlone);
  write_image(account, 1, GlobalTime{at(20).ns}, {}, {fuse(account, 0, 0)});
  use_image(account, 1, at(30), {});
  write_image(account, 0, GlobalTime{at(40).ns}, {});
  use_image(account, 0, at(50), {});
  use_image(account, 0, at(70), {});
  const ServiceFindings findings = account.finish(at(80));
  ASSERT_EQ(findings.older.count(kLaser), 1u);
  EXPECT_EQ(findings.older.at(kLaser).uses, 1u);
  EXPECT_EQ(findings.older.at(kLaser).worst, Duration::milliseconds(70));
}

TEST(ServiceAccount, TimeWithoutAUseIsNamed) {
  EXPECT_FALSE(drive(50, -1, 20, 2).gap);  // 60 ms: not more than three times 20 ms
  EXPECT_EQ(drive(50, -1, 20, 5).gap, Duration::milliseconds(120));
  EXPECT_EQ(drive(50, -1, 0, 10).gap, Duration::milliseconds(230));   // from the begin of the judged part
  EXPECT_EQ(drive(50, -1, 40, 10).gap, Duration::milliseconds(210));  // to the end
}

TEST(ServiceAccount, RefusedImagesAndNoneAtAllAreNotAsPromised) {
  ServiceAccount account(at(0), {});
  recording::records::FeatureUsed stale;
  stale.stamp = {at(5), {}, GlobalTime{at(5).ns}, {}};
  stale.stale = true;
  account.on(stale);
  const ServiceFindings findings = account.finish(at(10));
  EXPECT_EQ(findings.refused, 1u);
  EXPECT_FALSE(findings.as_promised());
  EXPECT_FALSE(ServiceAccount(at(0), {}).finish(at(10)).as_promised());
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
