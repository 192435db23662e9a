// The laws of bus/ports/live_medium.h as a suite for every live medium:
//
//   class MyBench : public laws::LiveBench { ... };                          // tests/laws/live_listener.h
//   INSTANTIATE_TYPED_TEST_SUITE_P(MyMedium, LiveMediumLaws, MyBench);       // in namespace ttf::laws
//
// Its users link tests/support/allocation_counter.cc.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/laws/live_medium_checks.h"

namespace ttf::laws {

template <class Bench> class LiveMediumLaws : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = bench_.missing(); !why.empty()) GTEST_SKIP() << why;
  }
  Bench bench_;
};

TYPED_TEST_SUITE_P(LiveMediumLaws);

TYPED_TEST_P(LiveMediumLaws, L1_EverySignalReachesEveryOtherNodeOnceUnchanged) {
  EXPECT_EQ(once_and_unchanged(this->bench_, false), "");
}
TYPED_TEST_P(LiveMediumLaws, L1_AlsoWhereEveryNodeHasAThread) { EXPECT_EQ(once_and_unchanged(this->bench_, true), ""); }
TYPED_TEST_P(LiveMediumLaws, L1_OrIsCountedAsLostWhereNobodyListens) {
  EXPECT_EQ(missing_is_counted(this->bench_), "");
}
TYPED_TEST_P(LiveMediumLaws, L2_ANodeDoesNotReceiveItself) { EXPECT_EQ(does_not_receive_itself(this->bench_), ""); }
TYPED_TEST_P(LiveMediumLaws, L3_InTheOrderInWhichTheyWereSent) { EXPECT_EQ(keeps_the_order(this->bench_), ""); }
TYPED_TEST_P(LiveMediumLaws, L4_ItArrivesBetweenSendAndReceive) { EXPECT_EQ(arrives_when_it_says(this->bench_), ""); }
TYPED_TEST_P(LiveMediumLaws, L5_BytesAreKeptAsLongAsTheyAreNeeded) {
  EXPECT_EQ(keeps_what_is_its_own(this->bench_), "");
}
TYPED_TEST_P(LiveMediumLaws, L6_NothingBlocksNorAllocates) { EXPECT_EQ(never_blocks_nor_allocates(this->bench_), ""); }
TYPED_TEST_P(LiveMediumLaws, L7_WhatIsForeignIsCounted) {
  EXPECT_EQ(strangers_are_counted(this->bench_, LiveBench::Intruder::kForeign), "");
}
TYPED_TEST_P(LiveMediumLaws, L7_WhatIsMalformedIsCounted) {
  EXPECT_EQ(strangers_are_counted(this->bench_, LiveBench::Intruder::kMalformed), "");
}
TYPED_TEST_P(LiveMediumLaws, L8_WhatIsWatchedIsReadableUntilItIsHandedOver) {
  EXPECT_EQ(what_is_watched_is_readable(this->bench_), "");
}
TYPED_TEST_P(LiveMediumLaws, Departure_ASyncFrameSaysHowLateItLeft) {
  EXPECT_EQ(says_how_late_it_left(this->bench_), "");
}

REGISTER_TYPED_TEST_SUITE_P(LiveMediumLaws, L1_EverySignalReachesEveryOtherNodeOnceUnchanged,
                            L1_AlsoWhereEveryNodeHasAThread, L1_OrIsCountedAsLostWhereNobodyListens,
                            L2_ANodeDoesNotReceiveItself, L3_InTheOrderInWhichTheyWereSent,
                            L4_ItArrivesBetweenSendAndReceive, L5_BytesAreKeptAsLongAsTheyAreNeeded,
                            L6_NothingBlocksNorAllocates, L7_WhatIsForeignIsCounted, L7_WhatIsMalformedIsCounted,
                            L8_WhatIsWatchedIsReadableUntilItIsHandedOver, Departure_ASyncFrameSaysHowLateItLeft);

}  // namespace ttf::laws
