// Rewinding gives the bits of processing in order, for any order of arrival.
#include "fusion/oosm/rewind.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/fusion/oosm/timelines.h"

namespace ttf::fusion::oosm {
namespace {

using Axis = ConstantVelocity<1>;
using Rewound = Rewind<2, 1, Axis, 256>;

linear::Gaussian<2> rewound(const linear::Gaussian<2>& prior, const Timeline<2, 1>& arrivals) {
  Rewound method(Axis{});
  method.start(GlobalTime{}, prior);
  for (const Taken taken : take_all(method, arrivals)) EXPECT_LE(taken, Taken::kLate);
  return method.state();
}

TEST(Rewind, AllPermutationsOfSevenGiveTheSameBits) {
  RandomStream stream({.seed = 1});
  const linear::Gaussian<2> prior = drawn_prior<2>(stream);
  const Timeline<2, 1> events = drawn_timeline<2, 1>(stream, 7);
  const linear::Gaussian<2> expected = rewound(prior, events);
  std::array<std::size_t, 7> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  int permutations = 0;
  do {
    Timeline<2, 1> arrivals;
    for (const std::size_t i : order) arrivals.push_back(events[i]);
    ASSERT_TRUE(same_bits<2>(rewound(prior, arrivals), expected));
    ++permutations;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(permutations, 5040);
}

TEST(Rewind, RandomPermutationsOfTwoHundredGiveTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream stream({.seed = seed});
    const linear::Gaussian<2> prior = drawn_prior<2>(stream);
    Timeline<2, 1> events = drawn_timeline<2, 1>(stream, 200);
    const linear::Gaussian<2> expected = rewound(prior, events);
    for (int i = 199; i > 0; --i)
      std::swap(events[static_cast<std::size_t>(i)], events[static_cast<std::size_t>(stream.integer(0, i))]);
    EXPECT_TRUE(same_bits<2>(rewound(prior, events), expected));
  }
}

// All of one instant, of three sensors and several sequence numbers: order is (sensor, sequence).
TEST(Rewind, TiesAreOrderedBySensorThenSequence) {
  RandomStream stream({.seed = 3});
  const linear::Gaussian<2> prior = drawn_prior<2>(stream);
  Timeline<2, 1> events = drawn_timeline<2, 1>(stream, 6);
  for (std::size_t i = 0; i < 6; ++i)
    events[i].stamp = stamp_at(after_ms(40), static_cast<std::uint8_t>(i / 2), i % 2 == 0 ? 7u : 300u);
  linear::Gaussian<2> expected = prior;
  advance<2>(expected, Axis{}, Duration::milliseconds(40));
  for (const auto& event : events) correct<2, 1>(expected, event.measurement);
  std::reverse(events.begin(), events.end());
  EXPECT_TRUE(same_bits<2>(rewound(prior, events), expected));
  std::swap(events[1], events[4]);
  EXPECT_TRUE(same_bits<2>(rewound(prior, events), expected));
}

//   start . . . oldest remembered . late . . . newest
TEST(Rewind, AForgottenMeasurementStaysFusedAndNothingComesBeforeIt) {
  RandomStream stream({.seed = 4});
  const linear::Gaussian<2> prior = drawn_prior<2>(stream);
  Timeline<2, 1> events = drawn_timeline<2, 1>(stream, 40);
  for (std::size_t i = 0; i < 40; ++i) events[i].stamp = stamp_at(after_ms(10 * static_cast<std::int64_t>(i) + 10));
  Rewind<2, 1, Axis, 8> method(Axis{});
  method.start(GlobalTime{}, prior);
  Timeline<2, 1> without = events;
  without.erase(without.begin() + 33);
  take_all(method, without);  // remembers 34, 35 ... 39 and two before
  const linear::Gaussian<2> before = method.state();
  EXPECT_EQ(method.take(stamp_at(after_ms(310)), events[30].measurement), Taken::kTooOld);
  EXPECT_EQ(method.take(stamp_at(after_ms(315)), events[30].measurement), Taken::kTooOld);
  EXPECT_EQ(method.take(events[31].stamp, events[31].measurement), Taken::kDuplicate);
  EXPECT_TRUE(same_bits<2>(method.state(), before));
  EXPECT_EQ(method.take(events[33].stamp, events[33].measurement), Taken::kLate);
  EXPECT_TRUE(same_bits<2>(method.state(), rewound(prior, events)));
  EXPECT_EQ(method.take(events[31].stamp, events[31].measurement), Taken::kTooOld);  // made room
}

}  // namespace
}  // namespace ttf::fusion::oosm
