// The cause of each effect when a plan has several faults.
#include "evaluation/faults/causes.h"

#include <gtest/gtest.h>

#include "tests/sim/engine/bus_clusters.h"

namespace ttf::evaluation::faults {
namespace {

using schedules::model::Channels;
using ttf::faults::Fault;
using ttf::faults::FaultKind;

constexpr NodeId kAda{0}, kBen{1}, kCleo{2}, kDan{3};

constexpr TrueTime us(std::int64_t count) { return TrueTime{count * 1'000}; }

struct Plan {
  schedules::model::Cluster cluster = sim::engine::bus_cluster(4, 4, 4);
  ttf::faults::FaultPlan plan;
  std::optional<FaultCauses> causes;

  // All faults begin and act at the same instant.
  explicit Plan(std::vector<Fault> faults) {
    plan.faults = std::move(faults);
    causes.emplace(plan, cluster);
    for (std::size_t f = 0; f < plan.faults.size(); ++f) {
      causes->begins(f, us(0));
      causes->acts(f, us(0));
    }
  }
  // The cause of a signal in a slot of `owner`, as `receiver` reports it.
  std::optional<std::size_t> received(NodeId owner, NodeId receiver, std::int64_t from_us, bool silence = false,
                                      Channels channels = Channels::kB) const {
    return causes->of_signal({owner, receiver, channels, us(from_us), us(from_us + 80), silence});
  }
};

Fault fault(FaultKind kind, NodeId node = kNoNode, Channels channels = Channels::kAB) {
  Fault one;
  one.kind = kind;
  one.node = node;
  one.channels = channels;
  return one;
}

TEST(FaultCauses, ASlotIsItsOwnersWhoeverActedLast) {
  Plan plan(
      {fault(FaultKind::kCrash, kAda), fault(FaultKind::kOmission, kBen), fault(FaultKind::kBitFlipPayload, kCleo)});
  plan.causes->acts(2, us(5'000));
  EXPECT_EQ(plan.received(kAda, kDan, 5'000), 0u);
  EXPECT_EQ(plan.received(kBen, kDan, 5'000), 1u);
  EXPECT_EQ(plan.received(kCleo, kDan, 5'000), 2u);
  EXPECT_EQ(plan.received(kDan, kAda, 5'000), 0u) << "who has no supply hears nothing";
  EXPECT_EQ(plan.received(kDan, kBen, 5'000), std::nullopt) << "who does not send hears all the same";
}

TEST(FaultCauses, OfTwoThatFitTheOneThatActedLastBeforeIt) {
  Plan plan({fault(FaultKind::kOmission, kAda), fault(FaultKind::kBitFlipHeader, kAda)});
  plan.causes->acts(0, us(5'010));
  plan.causes->acts(1, us(10'010));
  EXPECT_EQ(plan.received(kAda, kDan, 5'000), 0u);
  EXPECT_EQ(plan.received(kAda, kDan, 10'000), 1u);
  plan.causes->acts(0, us(15'010));
  EXPECT_EQ(plan.received(kAda, kDan, 10'000), 1u) << "what comes later is no cause";
}

TEST(FaultCauses, AChannelIsDisturbedWhereAndWhileSomethingActsOnIt) {
  Plan plan({fault(FaultKind::kBabblingIdiot, kAda, Channels::kB), fault(FaultKind::kNoise, kNoNode, Channels::kA)});
  plan.causes->acts(0, us(5'030));
  plan.causes->acts(1, us(9'030));
  EXPECT_EQ(plan.received(kBen, kDan, 5'000, false, Channels::kB), 0u);
  EXPECT_EQ(plan.received(kBen, kDan, 5'000, false, Channels::kA), std::nullopt);
  EXPECT_EQ(plan.received(kBen, kDan, 9'000, false, Channels::kA), 1u);
  EXPECT_EQ(plan.received(kBen, kDan, 9'000, false, Channels::kB), std::nullopt) << "long after its last burst";
  EXPECT_EQ(plan.received(kBen, kDan, 5'000, false, Channels::kAB), 0u);
  EXPECT_EQ(plan.received(kNoNode, kDan, 5'000, false, Channels::kB), 0u) << "nobody's slot";
}

TEST(FaultCauses, ALongBurstDisturbsToItsEnd) {
  Fault noise = fault(FaultKind::kNoise);
  noise.length = Duration::milliseconds(20);
  Plan plan({noise});
  plan.causes->acts(0, us(5'000));
  EXPECT_EQ(plan.received(kBen, kDan, 24'000), 0u);
  EXPECT_EQ(plan.received(kBen, kDan, 26'000), std::nullopt);
}

TEST(FaultCauses, SilenceIsTheOwnersThoughSomebodyBabbles) {
  Plan plan({fault(FaultKind::kCrash, kAda), fault(FaultKind::kBabblingIdiot, kBen)});
  plan.causes->acts(1, us(5'030));
  EXPECT_EQ(plan.received(kAda, kDan, 5'000, true), 0u);
  EXPECT_EQ(plan.received(kAda, kDan, 5'000, false), 1u) << "what is heard there is the babbler";
  EXPECT_EQ(plan.received(kCleo, kDan, 5'000, true), 1u) << "none other fits";
}

TEST(FaultCauses, ANodeIsItsFaultsUntilItIsBack) {
  Plan plan({fault(FaultKind::kCrash, kAda), fault(FaultKind::kOmission, kBen)});
  plan.causes->left(kAda, *plan.causes->of_node(kAda, us(0)));
  plan.causes->ends(0, us(100'000));
  EXPECT_EQ(plan.received(kAda, kDan, 150'000), 0u) << "it has its supply, and integrates";
  EXPECT_EQ(plan.causes->of_node(kAda, us(150'000)), 0u);
  plan.causes->is_back(kAda);
  EXPECT_EQ(plan.received(kAda, kDan, 150'100), std::nullopt);
}

TEST(FaultCauses, ATransientIsToBlameForNodesThatItDroveOut) {
  Plan plan({fault(FaultKind::kTransient), fault(FaultKind::kOmission, kBen)});
  plan.causes->ends(0, us(60'000));
  EXPECT_EQ(plan.received(kDan, kAda, 200'000, true), std::nullopt);
  plan.causes->left(kDan, 0);
  EXPECT_EQ(plan.received(kDan, kAda, 200'000, true), 0u);
  plan.causes->is_back(kDan);
  EXPECT_EQ(plan.received(kDan, kAda, 200'000, true), std::nullopt);
}

TEST(FaultCauses, EffectsThatFitNothingElseBelongToTheByzantineClock) {
  Plan plan({fault(FaultKind::kByzantineClock, kAda), fault(FaultKind::kOmission, kBen)});
  plan.causes->acts(1, us(5'000));
  EXPECT_EQ(plan.received(kCleo, kDan, 5'000), 0u);
  EXPECT_EQ(plan.received(kBen, kDan, 5'000), 1u);
  EXPECT_EQ(plan.causes->of_node(kNoNode, us(5'000)), 0u) << "precision";
  plan.causes->ends(0, us(10'000));
  EXPECT_EQ(plan.received(kCleo, kDan, 50'000), 0u) << "clocks take their time to come together again";
  EXPECT_EQ(plan.received(kCleo, kDan, 61'000), std::nullopt);
}

TEST(FaultCauses, AFaultFreeNodesStateIsOfAnyThatActsOrDidOfLate) {
  Plan plan({fault(FaultKind::kTransient)});
  plan.causes->ends(0, us(100'000));
  const std::int64_t patience =
      plan.cluster.cycle().ns / 1'000 * 2 * (plan.cluster.flexray.gMaxWithoutClockCorrectionFatal + 1);
  EXPECT_EQ(plan.causes->of_node(kDan, us(100'000 + patience)), 0u);
  EXPECT_EQ(plan.causes->of_node(kDan, us(100'001 + patience)), std::nullopt);
}

TEST(FaultCauses, NothingIsOfAFaultThatHasNotBegun) {
  Plan plan({});
  plan.plan.faults = {fault(FaultKind::kCrash, kAda)};
  plan.causes.emplace(plan.plan, plan.cluster);
  EXPECT_FALSE(plan.causes->any_begun(us(10'000)));
  plan.causes->begins(0, us(10'000));
  EXPECT_TRUE(plan.causes->any_begun(us(10'000)));
  EXPECT_FALSE(plan.causes->any_begun(us(9'999)));
  EXPECT_EQ(plan.received(kAda, kDan, 9'000), std::nullopt);
  EXPECT_EQ(plan.received(kAda, kDan, 10'000), 0u);
}

// A node that loses its supply dates it by its last microtick, which may be earlier.
TEST(FaultCauses, AFaultMayBeginAMicrotickAfterWhatItDid) {
  Plan plan({});
  plan.plan.faults = {fault(FaultKind::kCrash, kAda)};
  plan.causes.emplace(plan.plan, plan.cluster);
  plan.causes->begins(0, us(10'000));
  EXPECT_EQ(plan.causes->of_node(kAda, us(10'000) - Duration::nanoseconds(50)), 0u);
  EXPECT_EQ(plan.causes->of_node(kAda, us(9'999)), std::nullopt);
}

}  // namespace
}  // namespace ttf::evaluation::faults
