// The laws of bus/ports/exchange.h as a suite for every exchange:
//
//   class MyBench : public laws::ExchangeBench { ... };
//   INSTANTIATE_TYPED_TEST_SUITE_P(MyExchange, ExchangeLaws, MyBench);     // in namespace ttf::laws
//
// A bench is at least two members, NodeId 0 and up, who all receive each other and have sent no message yet.
// Each law runs every member in its own thread.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "bus/ports/exchange.h"
#include "core/ids.h"
#include "tests/support/messages.h"

namespace ttf::laws {

class ExchangeBench {
 public:
  virtual ~ExchangeBench() = default;
  virtual std::size_t members() const = 0;
  virtual bus::ports::Exchange& member(std::size_t index) = 0;
  // Makes it gone for the others, in any way; its own thread no longer uses it.
  virtual void end(std::size_t index) = 0;
};

template <class Bench> class ExchangeLaws : public testing::Test {
 protected:
  static NodeId node(std::size_t index) { return NodeId{static_cast<std::uint8_t>(index)}; }

  // Runs `work` for all members in parallel.
  void all(const std::function<void(std::size_t)>& work) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < bench_.members(); ++i)
      threads.emplace_back([&work, i] { EXPECT_NO_THROW(work(i)) << "member " << i; });
    for (std::thread& thread : threads) thread.join();
  }
  void send(std::size_t member, std::uint64_t number, test::Sizes sizes) {
    bench_.member(member).send(test::message(node(member), number, sizes));
  }
  // Receives until it has received `count` messages of every other member. Each must be its sender's next,
  // without others in between.
  void receive(std::size_t member, std::uint64_t count, test::Sizes sizes) {
    std::map<std::size_t, std::uint64_t> next;
    std::uint64_t left = count * (bench_.members() - 1);
    for (; left > 0; --left) {
      const auto received = bench_.member(member).receive();
      const std::size_t from = index_of(received.from);
      ASSERT_NE(from, member) << "hears itself";
      ASSERT_LT(from, bench_.members());
      ASSERT_FALSE(received.gone) << from;
      const auto expected = test::message(received.from, next[from]++, sizes);
      ASSERT_TRUE(std::equal(received.bytes.begin(), received.bytes.end(), expected.begin(), expected.end()))
          << "member " << member << " on message " << next[from] - 1 << " of " << from << ", " << received.bytes.size()
          << " bytes for " << expected.size();
    }
    for (const auto& [from, received] : next) ASSERT_EQ(received, count) << "of " << from;
  }
  void expect_gone(std::size_t member, std::size_t other) {
    const auto received = bench_.member(member).receive();
    EXPECT_EQ(received.from, node(other)) << "heard by " << member;
    EXPECT_TRUE(received.gone) << "heard by " << member;
    EXPECT_TRUE(received.bytes.empty());
  }

  Bench bench_;
};

TYPED_TEST_SUITE_P(ExchangeLaws);

TYPED_TEST_P(ExchangeLaws, L1_EveryMessageReachesEveryOtherMemberOnceUnchanged) {
  static constexpr std::uint64_t kCount = 300;
  this->all([this](std::size_t member) {
    for (std::uint64_t i = 0; i < kCount; ++i) this->send(member, i, test::Sizes::kAll);
    this->receive(member, kCount, test::Sizes::kAll);
  });
  this->bench_.end(0);  // this comes next, so no message came twice
  this->all([this](std::size_t member) {
    if (member != 0) this->expect_gone(member, 0);
  });
}

TYPED_TEST_P(ExchangeLaws, L2_InTheOrderInWhichTheyWereSentHoweverFarAhead) {
  static constexpr std::uint64_t kCount = 3000;
  this->all([this](std::size_t member) {
    if (member != 0) return;
    for (std::uint64_t i = 0; i < kCount; ++i) this->send(member, i, test::Sizes::kSmall);
  });
  this->all([this](std::size_t member) {
    if (member == 0) return;
    for (std::uint64_t i = 0; i < kCount; ++i) {
      const auto received = this->bench_.member(member).receive();
      const auto expected = test::message(NodeId{0}, i, test::Sizes::kSmall);
      ASSERT_TRUE(std::equal(received.bytes.begin(), received.bytes.end(), expected.begin(), expected.end())) << i;
    }
  });
}

TYPED_TEST_P(ExchangeLaws, L3_AMemberDoesNotReceiveItself) {
  static constexpr std::uint64_t kRounds = 200;  // in lockstep: each sends, then receives all others
  this->all([this](std::size_t member) {
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      this->send(member, round, test::Sizes::kSmall);
      for (std::size_t i = 1; i < this->bench_.members(); ++i)
        ASSERT_NE(this->bench_.member(member).receive().from, this->node(member));
    }
  });
}

TYPED_TEST_P(ExchangeLaws, L4_ReceiveSleepsUntilThereIsSomething) {
  using namespace std::chrono_literals;
  this->all([this](std::size_t member) {
    if (member == 0) {
      std::this_thread::sleep_for(500ms);
      this->send(0, 0, test::Sizes::kSmall);
      return;
    }
    const auto cpu = [] {
      timespec now{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
    };
    const auto before = cpu();
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(this->bench_.member(member).receive().from, this->node(0));
    EXPECT_GT(std::chrono::steady_clock::now() - began, 300ms);
    EXPECT_LT(cpu() - before, 20ms);
  });
}

TYPED_TEST_P(ExchangeLaws, L5_AGoneMemberIsReceivedNoMoreAndAllItSaidBeforeHasBeen) {
  static constexpr std::uint64_t kCount = 500;
  for (std::uint64_t i = 0; i < kCount; ++i) this->send(0, i, test::Sizes::kAll);
  for (std::size_t member = 1; member < this->bench_.members(); ++member)  // remaining members are not disturbed
    for (std::uint64_t i = 0; i < kCount; ++i) this->send(member, i, test::Sizes::kSmall);
  std::thread ending([this] { this->bench_.end(0); });
  this->all([this](std::size_t member) {
    if (member == 0) return;
    std::vector<std::uint64_t> next(this->bench_.members());
    bool gone = false;
    std::uint64_t left = kCount * (this->bench_.members() - 1) + 1;
    for (; left > 0; --left) {
      const auto received = this->bench_.member(member).receive();
      const std::size_t from = index_of(received.from);
      if (received.gone) {
        ASSERT_EQ(from, 0u);
        ASSERT_EQ(next[0], kCount) << "member " << member << " lacks what was said before";
        gone = true;
        continue;
      }
      ASSERT_FALSE(from == 0 && gone) << "heard after it had gone";
      const auto sizes = from == 0 ? test::Sizes::kAll : test::Sizes::kSmall;
      const auto expected = test::message(received.from, next[from]++, sizes);
      ASSERT_TRUE(std::equal(received.bytes.begin(), received.bytes.end(), expected.begin(), expected.end()));
    }
    EXPECT_TRUE(gone);
  });
  ending.join();
}

REGISTER_TYPED_TEST_SUITE_P(ExchangeLaws, L1_EveryMessageReachesEveryOtherMemberOnceUnchanged,
                            L2_InTheOrderInWhichTheyWereSentHoweverFarAhead, L3_AMemberDoesNotReceiveItself,
                            L4_ReceiveSleepsUntilThereIsSomething,
                            L5_AGoneMemberIsReceivedNoMoreAndAllItSaidBeforeHasBeen);

}  // namespace ttf::laws
