// The laws of bus/ports/can_port.h as a suite for every medium:
//
//   class MyBench : public laws::CanBench { ... };
//   INSTANTIATE_TYPED_TEST_SUITE_P(MyMedium, CanPortLaws, MyBench);     // in namespace ttf::laws
//
// A bench is a CAN with at least three controllers, idle at the start. Only the test sends.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "bus/ports/can_port.h"

namespace ttf::laws {

struct CanReached {
  std::size_t controller = 0;
  std::uint32_t identifier = 0;
  bool flexible_data_rate = false;
  std::vector<std::byte> data;
};

class CanBench {
 public:
  virtual ~CanBench() = default;
  virtual bool flexible_data_rate() const = 0;
  virtual std::size_t controllers() const = 0;
  virtual bus::ports::CanPort& port(std::size_t controller) = 0;
  // Lets the bus decide the next sender among the frames handed over so far, without ending a frame.
  virtual void begin() = 0;
  // Delivers everything that was handed over.
  virtual void run_until_idle() = 0;
  // All receptions so far, in the order in which they were delivered.
  virtual const std::vector<CanReached>& reached() const = 0;
};

// Identifier, sender and number of a frame.
using CanLabel = std::tuple<std::uint32_t, std::size_t, std::size_t>;

template <class Bench> class CanPortLaws : public testing::Test {
 protected:
  // Every length on this bus.
  std::vector<std::size_t> lengths() const {
    std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7, 8};
    if (bench_.flexible_data_rate()) all.insert(all.end(), {12, 16, 20, 24, 32, 48, 64});
    return all;
  }
  // Data that identify their sender and number.
  static std::vector<std::byte> data(std::size_t sender, std::size_t number, std::size_t length = 8) {
    std::vector<std::byte> bytes(length);
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<std::byte>(number * 37 + i);
    if (length > 0) bytes[0] = static_cast<std::byte>(sender);
    if (length > 1) bytes[1] = static_cast<std::byte>(number);
    return bytes;
  }
  void send(std::size_t sender, std::uint32_t identifier, const std::vector<std::byte>& bytes) {
    bench_.port(sender).send({identifier, bench_.flexible_data_rate(), bytes});
  }
  std::vector<CanLabel> received() const {  // by controller 2
    std::vector<CanLabel> labels;
    for (const CanReached& reached : bench_.reached())
      if (reached.controller == 2)
        labels.emplace_back(reached.identifier, static_cast<std::size_t>(reached.data.at(0)),
                            static_cast<std::size_t>(reached.data.at(1)));
    return labels;
  }

  Bench bench_;
};

TYPED_TEST_SUITE_P(CanPortLaws);

TYPED_TEST_P(CanPortLaws, L1_EveryFrameReachesEveryOtherControllerOnceUnchanged) {
  using Frame = std::tuple<std::size_t, std::uint32_t, std::vector<std::byte>>;
  std::vector<Frame> sent;
  std::size_t number = 0;
  for (const std::size_t length : this->lengths())
    for (std::size_t sender = 0; sender < this->bench_.controllers(); ++sender) {
      const auto identifier = static_cast<std::uint32_t>((number * 509) & 0x7ff);
      const auto bytes = this->data(sender, number, length);
      this->send(sender, identifier, bytes);
      sent.emplace_back(sender, identifier, bytes);
      if (++number % 5 == 0) this->bench_.run_until_idle();
    }
  this->bench_.run_until_idle();
  for (std::size_t controller = 0; controller < this->bench_.controllers(); ++controller) {
    std::map<std::pair<std::uint32_t, std::vector<std::byte>>, int> times;
    std::size_t count = 0, expected = 0;
    for (const CanReached& reached : this->bench_.reached()) {
      if (reached.controller != controller) continue;
      ++times[{reached.identifier, reached.data}];
      ++count;
      EXPECT_EQ(reached.flexible_data_rate, this->bench_.flexible_data_rate());
    }
    for (const auto& [sender, identifier, bytes] : sent) {
      if (sender == controller) continue;
      ++expected;
      EXPECT_EQ((times[{identifier, bytes}]), 1) << "controller " << controller << " identifier " << identifier;
    }
    EXPECT_EQ(count, expected);
  }
}

TYPED_TEST_P(CanPortLaws, L2_AControllerDoesNotReceiveItself) {
  for (std::size_t sender = 0; sender < this->bench_.controllers(); ++sender)
    this->send(sender, 7, this->data(sender, 1));
  this->bench_.run_until_idle();
  EXPECT_FALSE(this->bench_.reached().empty());
  for (const CanReached& reached : this->bench_.reached())
    EXPECT_NE(static_cast<std::size_t>(reached.data.at(0)), reached.controller);
}

// While the first frame is on the bus, the others are handed over, the highest identifier first. A begun
// frame is not interrupted.
TYPED_TEST_P(CanPortLaws, L3_TheLowestIdentifierWinsWheneverTheBusFallsIdle) {
  this->send(0, 0x700, this->data(0, 0));
  this->bench_.begin();
  std::size_t number = 1;
  for (const std::uint32_t identifier : {0x600u, 0x010u, 0x7ffu, 0x300u, 0x000u})
    this->send(number % 2, identifier, this->data(number % 2, number)), ++number;
  this->bench_.run_until_idle();
  EXPECT_EQ(this->received(),
            (std::vector<CanLabel>{
                {0x700, 0, 0}, {0x000, 1, 5}, {0x010, 0, 2}, {0x300, 0, 4}, {0x600, 1, 1}, {0x7ff, 1, 3}}));
}

TYPED_TEST_P(CanPortLaws, L3_TiesGoToTheLowerNode) {
  this->send(0, 0x100, this->data(0, 0));
  this->bench_.begin();
  this->send(1, 0x200, this->data(1, 1));
  this->send(0, 0x200, this->data(0, 2));
  this->bench_.run_until_idle();
  EXPECT_EQ(this->received(), (std::vector<CanLabel>{{0x100, 0, 0}, {0x200, 0, 2}, {0x200, 1, 1}}));
}

// Two lists of many frames each, handed over together, with others in between.
TYPED_TEST_P(CanPortLaws, L4_FramesOfOneIdentifierFromOneNodeKeepTheirOrder) {
  for (std::size_t number = 0; number < 20; ++number) {
    this->send(0, 0x200, this->data(0, number));
    this->send(1, 0x100 + static_cast<std::uint32_t>(number % 3), this->data(1, number));
    this->send(1, 0x300, this->data(1, number));
    if (number % 7 == 3) this->bench_.begin();
  }
  this->bench_.run_until_idle();
  std::map<std::pair<std::uint32_t, std::size_t>, std::vector<std::size_t>> order;
  for (const auto& [identifier, sender, number] : this->received()) order[{identifier, sender}].push_back(number);
  EXPECT_EQ(order.size(), 5u);
  EXPECT_EQ((order[{0x200, 0}].size()), 20u);
  EXPECT_EQ((order[{0x300, 1}].size()), 20u);
  for (const auto& [stream, numbers] : order)
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end())) << "identifier " << stream.first;
}

TYPED_TEST_P(CanPortLaws, L5_TheMediumKeepsNoReferenceToTheData) {
  auto bytes = this->data(0, 9);
  const auto original = bytes;
  this->send(0, 0x123, bytes);
  std::fill(bytes.begin(), bytes.end(), std::byte{0xEE});
  this->bench_.run_until_idle();
  ASSERT_EQ(this->bench_.reached().size(), this->bench_.controllers() - 1);
  for (const CanReached& reached : this->bench_.reached()) EXPECT_EQ(reached.data, original);
}

REGISTER_TYPED_TEST_SUITE_P(CanPortLaws, L1_EveryFrameReachesEveryOtherControllerOnceUnchanged,
                            L2_AControllerDoesNotReceiveItself, L3_TheLowestIdentifierWinsWheneverTheBusFallsIdle,
                            L3_TiesGoToTheLowerNode, L4_FramesOfOneIdentifierFromOneNodeKeepTheirOrder,
                            L5_TheMediumKeepsNoReferenceToTheData);

}  // namespace ttf::laws
