#include "cli/supervision/policy.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace ttf::cli::supervision {
namespace {

constexpr Duration ms(std::int64_t n) { return Duration::milliseconds(n); }

TEST(Policy, HasItsNames) {
  for (const Policy policy : {Policy::kRequired, Policy::kRestart, Policy::kOptional})
    EXPECT_EQ(policy_of(name_of(policy)), policy);
  EXPECT_EQ(policy_of("always"), std::nullopt);
}

TEST(Backoff, DoublesUpToItsCapAndEnds) {
  Backoff backoff({ms(100), ms(350), 4, ms(1000)});
  EXPECT_EQ(backoff.next(ms(1)), ms(100));
  EXPECT_EQ(backoff.next(ms(1)), ms(200));
  EXPECT_EQ(backoff.next(ms(1)), ms(350));
  EXPECT_EQ(backoff.next(ms(999)), ms(350));
  EXPECT_EQ(backoff.tried(), 4);
  EXPECT_EQ(backoff.next(ms(1)), std::nullopt);
}

TEST(Backoff, BeginsAnewAfterAProcessThatKeptGoing) {
  Backoff backoff({ms(100), ms(350), 2, ms(1000)});
  EXPECT_EQ(backoff.next(ms(1)), ms(100));
  EXPECT_EQ(backoff.next(ms(1)), ms(200));
  EXPECT_EQ(backoff.next(ms(1000)), ms(100));
  EXPECT_EQ(backoff.tried(), 1);
}

TEST(Backoff, NeedNotRestartAtAll) { EXPECT_EQ(Backoff({ms(100), ms(100), 0, ms(1000)}).next(ms(1)), std::nullopt); }

TEST(StopOrder, GoesFromInterruptToKill) {
  StopOrder order({ms(50), ms(20)});
  EXPECT_FALSE(order.begun());
  EXPECT_EQ(order.due(ms(1'000'000)), std::nullopt);
  EXPECT_EQ(order.begin(ms(100)), SIGINT);
  EXPECT_EQ(order.begin(ms(101)), std::nullopt);  // once
  EXPECT_EQ(order.next_instant(), ms(150));
  EXPECT_EQ(order.due(ms(149)), std::nullopt);
  EXPECT_EQ(order.due(ms(150)), SIGTERM);
  EXPECT_EQ(order.due(ms(169)), std::nullopt);
  EXPECT_EQ(order.due(ms(170)), SIGKILL);
  EXPECT_EQ(order.signal(), SIGKILL);
  EXPECT_EQ(order.next_instant(), std::nullopt);
  EXPECT_EQ(order.due(ms(1'000'000)), std::nullopt);
}

TEST(StopOrder, CanBeHurried) {
  StopOrder order({ms(50), ms(20)});
  EXPECT_EQ(order.begin(ms(100)), SIGINT);
  EXPECT_EQ(order.hurry(ms(110)), SIGTERM);
  EXPECT_EQ(order.next_instant(), ms(130));
  EXPECT_EQ(order.hurry(ms(111)), SIGKILL);
  EXPECT_EQ(order.hurry(ms(112)), std::nullopt);
}

}  // namespace
}  // namespace ttf::cli::supervision
