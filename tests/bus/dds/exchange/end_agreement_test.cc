// Survivors' agreement on the end of a dead member (bus/dds/exchange/end_agreement.h), with its streams
// (bus/dds/exchange/stream.h).
#include "bus/dds/exchange/end_agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "bus/dds/exchange/stream.h"
#include "tests/support/messages.h"

namespace ttf::bus::dds::exchange {
namespace {

constexpr NodeId kA{1}, kB{2}, kC{3};

TEST(EndAgreement, EndsWhereTheBestInformedIsWhoSaysTheRestAgain) {
  EndAgreement agreement({kA, kB, kC});
  EXPECT_EQ(agreement.begin().kind, common::Kind::kFence);
  EXPECT_FALSE(agreement.report(kA, 1, 5));
  EXPECT_FALSE(agreement.report(kB, 1, 9));
  const auto close = agreement.report(kC, 1, 7);
  ASSERT_TRUE(close);
  EXPECT_EQ(close->kind, common::Kind::kClose);
  EXPECT_EQ(close->round, 1u);
  EXPECT_EQ(close->holder, kB);
  EXPECT_EQ(close->first, 5u);
  EXPECT_EQ(close->end, 9u);
  agreement.closed(kA, 1);
  agreement.closed(kB, 1);
  EXPECT_FALSE(agreement.done());
  agreement.closed(kC, 1);
  EXPECT_TRUE(agreement.done());
  EXPECT_EQ(agreement.end(), 9u);
}

TEST(EndAgreement, WhereAllReceivedTheSameNothingIsRepeated) {
  EndAgreement agreement({kA, kB});
  agreement.begin();
  agreement.report(kA, 1, 5);
  const auto close = agreement.report(kB, 1, 5);
  ASSERT_TRUE(close);
  EXPECT_EQ(close->holder, kNoNode);
  EXPECT_FALSE(agreement.without(kA));  // so no end depends on it
}

TEST(EndAgreement, BeginsAgainWhereTheHolderDies) {
  EndAgreement agreement({kA, kB, kC});
  agreement.begin();
  agreement.report(kA, 1, 5);
  agreement.report(kB, 1, 9);
  agreement.report(kC, 1, 7);
  const auto fence = agreement.without(kB);
  ASSERT_TRUE(fence);
  EXPECT_EQ(fence->kind, common::Kind::kFence);
  EXPECT_EQ(fence->round, 2u);
  agreement.closed(kA, 1);  // late, of the round before
  agreement.closed(kC, 1);
  EXPECT_FALSE(agreement.done());
  EXPECT_FALSE(agreement.report(kA, 1, 9));
  EXPECT_FALSE(agreement.report(kA, 2, 6));
  const auto close = agreement.report(kC, 2, 8);
  ASSERT_TRUE(close);
  EXPECT_EQ(close->holder, kC);
  EXPECT_EQ(close->first, 6u);
  EXPECT_EQ(close->end, 8u);
}

TEST(EndAgreement, ADyingSurvivorsReportIsNotWaitedFor) {
  EndAgreement agreement({kA, kB});
  agreement.begin();
  agreement.report(kA, 1, 5);
  const auto close = agreement.without(kB);
  ASSERT_TRUE(close);
  EXPECT_EQ(close->end, 5u);
  EXPECT_FALSE(agreement.without(kC));  // was no survivor
}

TEST(EndAgreement, WithoutSurvivorsThereIsNothingToAgreeUpon) {
  EndAgreement nobody({});
  nobody.begin();
  EXPECT_TRUE(nobody.done());
  EndAgreement last({kA});
  last.begin();
  last.without(kA);
  EXPECT_TRUE(last.done());
}

// Survivors of one dead member: each received it up to a drawn sample. They receive all messages late, in a
// drawn order. Some die in between, and with them their repetitions. All remaining survivors must have received
// the same.
class DrawnAgreement {
 public:
  explicit DrawnAgreement(std::uint64_t seed) : draw_(seed) {
    const std::size_t members = 2 + below(5);
    std::set<NodeId> all;
    for (std::size_t i = 0; i < members; ++i) {
      const NodeId node{static_cast<std::uint8_t>(i)};
      Survivor& survivor = survivors_.try_emplace(node).first->second;
      const std::uint64_t received = below(20);
      for (std::uint64_t n = 0; n < received; ++n) accept(survivor, n);
      survivor.in_flight = received;
      survivor.reach = received + below(4);
      all.insert(node);
    }
    agreement_ = std::make_unique<EndAgreement>(all);
  }
  void run() {
    report_all(agreement_->begin());
    for (int steps = 0; !agreement_->done(); ++steps) {
      ASSERT_LT(steps, 100'000) << "it never ends";
      if (survivors_.size() > 1 && below(12) == 0) {
        auto victim = std::next(survivors_.begin(), static_cast<std::ptrdiff_t>(below(survivors_.size())));
        const NodeId node = victim->first;
        survivors_.erase(victim);
        for (auto& other : survivors_) cut_off(node, other.second.again);
        if (const auto order = agreement_->without(node)) report_all(*order);
        continue;
      }
      step(std::next(survivors_.begin(), static_cast<std::ptrdiff_t>(below(survivors_.size())))->second);
    }
  }
  void expect_all_the_same() const {
    const std::vector<common::Entry>& first = survivors_.begin()->second.entries;
    for (const auto& [node, survivor] : survivors_) {
      EXPECT_TRUE(survivor.stream.closed());
      ASSERT_EQ(survivor.entries.size(), first.size()) << index_of(node);
      for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(survivor.entries[i].number, i);
        EXPECT_EQ(survivor.entries[i].kind, i + 1 < first.size() ? common::Kind::kMessage : common::Kind::kBye);
      }
      EXPECT_EQ(first.size(), agreement_->end() + 1);
    }
  }

 private:
  struct Survivor {
    Stream stream{NodeId{100}, 1 << 20};
    std::vector<common::Entry> entries;
    std::uint64_t in_flight = 0;                         // the next sample that still comes from the dead itself
    std::uint64_t reach = 0;                             // and the first that does not
    std::deque<EndAgreement::Order> orders;              // the supervisor's, not yet seen
    std::deque<std::pair<NodeId, std::uint64_t>> again;  // repetitions with their speakers, not yet seen
    std::uint32_t confirm = 0;                           // the round to confirm
  };

  static void accept(Survivor& survivor, std::uint64_t number) {
    const auto nothing = std::make_shared<const std::vector<std::byte>>();
    survivor.stream.accept({number, common::Kind::kMessage, nothing}, survivor.entries);
  }
  void report_all(const EndAgreement::Order& order) {
    for (auto& entry : survivors_) entry.second.orders.push_back(order);
  }
  void step(Survivor& survivor) {
    const NodeId self = node_of(survivor);
    switch (below(3)) {
      case 0:
        if (survivor.in_flight < survivor.reach) accept(survivor, survivor.in_flight++);
        break;
      case 1:
        if (survivor.again.empty()) break;
        accept(survivor, survivor.again.front().second);
        survivor.again.pop_front();
        break;
      default:
        if (!survivor.orders.empty()) obey(self, survivor);
    }
    if (survivor.confirm != 0 && survivor.stream.closed()) agreement_->closed(self, std::exchange(survivor.confirm, 0));
  }
  void obey(NodeId self, Survivor& survivor) {
    const EndAgreement::Order order = survivor.orders.front();
    survivor.orders.pop_front();
    if (order.kind == common::Kind::kFence) {
      if (const auto close = agreement_->report(self, order.round, survivor.stream.fence())) report_all(*close);
      return;
    }
    survivor.confirm = order.round;
    survivor.stream.close(order.end, survivor.entries);
    if (order.holder != self) return;
    for (const common::Entry& entry : survivor.stream.again(order.first))
      for (auto& other : survivors_)
        if (other.first != self) other.second.again.emplace_back(self, entry.number);
  }
  // The last few, or all, that the dead was saying never come.
  void cut_off(NodeId dead, std::deque<std::pair<NodeId, std::uint64_t>>& again) {
    const auto said = std::count_if(again.begin(), again.end(), [&](const auto& a) { return a.first == dead; });
    auto kept = said == 0 ? 0 : below(static_cast<std::uint64_t>(said) + 1);
    std::erase_if(again, [&](const auto& a) { return a.first == dead && (kept == 0 || kept-- == 0); });
  }
  NodeId node_of(const Survivor& wanted) const {
    for (const auto& [node, survivor] : survivors_)
      if (&survivor == &wanted) return node;
    return kNoNode;
  }
  std::uint64_t below(std::uint64_t bound) { return (draw_ = test::scattered(draw_)) / 65536 % bound; }

  std::uint64_t draw_;
  std::map<NodeId, Survivor> survivors_;
  std::unique_ptr<EndAgreement> agreement_;
};

TEST(EndAgreement, SurvivorsHaveReceivedTheSameWheneverMembersDie) {
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    SCOPED_TRACE(seed);
    DrawnAgreement drawn(seed);
    drawn.run();
    drawn.expect_all_the_same();
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace ttf::bus::dds::exchange
