// A stamp from the future settles no other list: waiting goes on as before.
#include <gtest/gtest.h>

#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies {
namespace {

// sensor 0 (worst 60)   x0 (stamped 30 s)   x10 ---------------> 62
// sensor 1 (worst 30)          x20 ---> 45
//   1/0 (20 ms) waits for sensor 0 until 20 + 60 = 80, regardless of 0/0's stamp.
class FutureStamp : public testing::TestWithParam<StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(Waiting, FutureStamp, testing::Values(StrategyKind::kBuff, StrategyKind::kTt),
                         name_of_strategy);

TEST_P(FutureStamp, EndsNobodysWaiting) {
  const bool scheduled = GetParam() == StrategyKind::kTt;
  const std::vector<SensorTiming> sensors{
      {SensorId{0}, Settling::after(Duration::milliseconds(60)), scheduled, at_ms(10), Duration::milliseconds(80)},
      {SensorId{1}, Settling::after(Duration::milliseconds(30)), scheduled, at_ms(20), Duration::milliseconds(40)}};
  const auto strategy = make_strategy(GetParam(), {}, sensors);
  strategy->accept(list_of(0, 0, at_ms(30'000)).view());
  strategy->accept(list_of(1, 0, at_ms(20)).view());
  strategy->fuse(at_ms(50));
  EXPECT_TRUE(strategy->newest().empty()) << "fused without waiting for sensor 0";
  strategy->accept(list_of(0, 1, at_ms(10)).view());
  strategy->fuse(at_ms(80));
  ASSERT_EQ(strategy->last_fused().size(), 3u);
  EXPECT_EQ(strategy->last_fused()[0].id.sensor, SensorId{0});
  EXPECT_EQ(strategy->last_fused()[0].disposition, Disposition::kFused);
  EXPECT_EQ(strategy->last_fused()[1].disposition, Disposition::kFused) << "not late: it has waited";
  EXPECT_EQ(strategy->last_fused()[2].disposition, Disposition::kHeld);
}

}  // namespace
}  // namespace ttf::fusion::strategies
