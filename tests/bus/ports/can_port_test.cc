// The test CAN obeys the laws of the port. Controllers on it exchange complete lists, regardless of other
// senders.
#include <gtest/gtest.h>

#include <memory>

#include "bus/cni/can_controller.h"
#include "tests/bus/layouts.h"
#include "tests/bus/test_can.h"
#include "tests/laws/can_port_laws.h"

namespace ttf::laws {
namespace {

template <bool kFlexibleDataRate> class TestCanBench final : public CanBench {
 public:
  bool flexible_data_rate() const override { return kFlexibleDataRate; }
  std::size_t controllers() const override { return can_.controllers(); }
  bus::ports::CanPort& port(std::size_t controller) override { return can_.port(controller); }
  void begin() override { can_.begin(); }
  void run_until_idle() override { can_.run_until_idle(); }
  const std::vector<CanReached>& reached() const override { return reached_; }

 private:
  std::vector<CanReached> reached_;
  bus::TestCan can_{
      4, [this](std::size_t controller, const bus::ports::CanFrame& frame) {
        reached_.push_back(
            {controller, frame.identifier, frame.flexible_data_rate, {frame.data.begin(), frame.data.end()}});
      }};
};

using CanBenches = testing::Types<TestCanBench<false>, TestCanBench<true>>;

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(TestMedium, CanPortLaws, CanBenches);

}  // namespace ttf::laws

namespace ttf::bus::ports {
namespace {

// Two nodes' lists interleave on the bus. The urgent one overtakes frame by frame, and the third node gets
// both whole.
TEST(CanControllers, ListsThatInterleaveArriveWhole) {
  schedules::model::Cluster cluster;
  cluster.nodes.resize(3);
  cluster.pdus = {list_layout(4, 10, 4), list_layout(4, 10, 4)};
  schedules::model::CanBus bus;
  bus.flexible_data_rate = true;
  bus.nominal_bit_rate = 1'000'000;
  bus.data_bit_rate = 5'000'000;
  bus.messages = {{PduId{0}, 0x40, NodeId{0}, {}, 0}, {PduId{1}, 0x50, NodeId{1}, {}, 0}};
  cluster.can_buses = {bus};

  std::vector<std::unique_ptr<cni::CanController>> nodes;
  std::vector<PduId> order;  // the frames that node 2 receives
  TestCan can(3, [&](std::size_t node, const CanFrame& frame) {
    const auto arrival = nodes[node]->receive(frame);
    if (node == 2) order.push_back(arrival.value().pdu);
  });
  for (std::size_t n = 0; n < 3; ++n)
    nodes.push_back(std::make_unique<cni::CanController>(cluster, static_cast<NodeId>(n), 0, can.port(n)));
  MadeList urgent(cluster.pdus[0], 3, 10, 100), other(cluster.pdus[1], 9, 10, 200);
  nodes[1]->send(PduId{1}, other.view());
  can.begin();
  nodes[0]->send(PduId{0}, urgent.view());
  can.run_until_idle();
  EXPECT_EQ(order, (std::vector<PduId>{PduId{1}, PduId{0}, PduId{0}, PduId{0}, PduId{1}, PduId{1}}));
  for (const MadeList* sent : {&urgent, &other}) {
    const auto list = nodes[2]->incoming(sent == &urgent ? PduId{0} : PduId{1}).latest();
    ASSERT_TRUE(list.has_value());
    EXPECT_EQ(list->sequence, sent->sequence);
    EXPECT_TRUE(std::equal(list->bytes.begin(), list->bytes.end(), sent->bytes.begin(), sent->bytes.end()));
  }
}

}  // namespace
}  // namespace ttf::bus::ports
