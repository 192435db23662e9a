// The laws of nodes/runner/machine_clock.h as a suite that every clock is put through:
//
//   struct MyBench { MachineClock& clock(); };
//   INSTANTIATE_TYPED_TEST_SUITE_P(Mine, MachineClockLaws, MyBench);
#pragma once

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

#include "nodes/runner/machine_clock.h"

namespace ttf::nodes::runner {

template <class Bench> class MachineClockLaws : public testing::Test {
 protected:
  MachineClockLaws() { EXPECT_GE(readable_, 0); }
  ~MachineClockLaws() override { close(readable_); }
  MachineClock& clock() { return bench_.clock(); }
  bus::ports::MachineTime in(Duration from_now) { return clock().now() + from_now; }

  Bench bench_;
  const int readable_ = eventfd(1, EFD_CLOEXEC);
};

TYPED_TEST_SUITE_P(MachineClockLaws);

TYPED_TEST_P(MachineClockLaws, L1_NeverGoesBack) {
  bus::ports::MachineTime last = this->clock().now();
  for (int i = 0; i < 1000; ++i) {
    const bus::ports::MachineTime now = this->clock().now();
    ASSERT_GE(now, last);
    last = now;
  }
}

TYPED_TEST_P(MachineClockLaws, L2_WaitsUntilAnInstantAndNotLess) {
  for (const std::int64_t us : {0, 1, 300, 20'000}) {
    const bus::ports::MachineTime until = this->in(Duration::microseconds(us));
    this->clock().wait_until(until);
    EXPECT_GE(this->clock().now(), until);
  }
  this->clock().wait_until(bus::ports::MachineTime{-5});  // over long ago
}

// Without watching, this would wait for an hour.
TYPED_TEST_P(MachineClockLaws, L2_WakesUpForWhatItWatches) {
  const bus::ports::MachineTime until = this->in(Duration::milliseconds(3'600'000));
  this->clock().watch(-1);
  this->clock().watch(this->readable_);
  this->clock().wait_until(until);
  EXPECT_LT(this->clock().now(), until);
}

TYPED_TEST_P(MachineClockLaws, L2_DoesNotWakeUpForWhatItWatchesNoMore) {
  this->clock().watch(this->readable_);
  this->clock().clear();
  const bus::ports::MachineTime until = this->in(Duration::milliseconds(2));
  this->clock().wait_until(until);
  EXPECT_GE(this->clock().now(), until);
}

TYPED_TEST_P(MachineClockLaws, L3_NothingWatchedShortensASleep) {
  this->clock().watch(this->readable_);
  const bus::ports::MachineTime until = this->in(Duration::milliseconds(2));
  this->clock().sleep(Duration::milliseconds(2));
  EXPECT_GE(this->clock().now(), until);
}

TYPED_TEST_P(MachineClockLaws, ReportsWhatIsReadable) {
  EXPECT_TRUE(this->clock().readable(this->readable_));
  eventfd_t taken = 0;
  eventfd_read(this->readable_, &taken);
  EXPECT_FALSE(this->clock().readable(this->readable_));
  EXPECT_FALSE(this->clock().readable(-1));
}

REGISTER_TYPED_TEST_SUITE_P(MachineClockLaws, L1_NeverGoesBack, L2_WaitsUntilAnInstantAndNotLess,
                            L2_WakesUpForWhatItWatches, L2_DoesNotWakeUpForWhatItWatchesNoMore,
                            L3_NothingWatchedShortensASleep, ReportsWhatIsReadable);

}  // namespace ttf::nodes::runner
