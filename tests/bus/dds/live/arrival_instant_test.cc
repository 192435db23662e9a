// The arrival instants of other hosts' frames. The tests compare them with the instants of frames that only
// have the network's least delay. The test draws the delays.
#include "bus/dds/live/arrival_instant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "bus/dds/live/least_delay.h"

namespace ttf::bus::dds::live {
namespace {

constexpr std::int64_t kUs = 1'000, kMs = 1'000'000, kSecond = 1'000'000'000;
constexpr std::int64_t kLeast = 60 * kUs;          // on the network
constexpr std::int64_t kApart = -1'000 * kSecond;  // what the other clock shows beyond this one at the begin

// A remote host, and this host's delay in taking its frames. The delay is exponential and never negative.
// Sometimes it is a slice of the scheduler. Frames come one after the other, in order, as from a socket.
class Afar {
 public:
  Afar(std::uint64_t seed, double drift_ppm, double jitter_us)
      : random_(seed), drift_ppm_(drift_ppm), jitter_us_(jitter_us) {}

  struct Frame {
    std::int64_t left = 0;  // by this host's clock
    std::int64_t sent = 0;  // by the other's
    std::int64_t received = 0;
  };
  Frame at(std::int64_t left) {
    double late_us = -jitter_us_ * std::log(1.0 - uniform());
    if (uniform() < 0.02) late_us += 4'000 * uniform();
    last_ = std::max(last_, left + kLeast + static_cast<std::int64_t>(late_us * 1e3));
    return {left, left + kApart + set_ + std::llround(static_cast<double>(left) * drift_ppm_ * 1e-6), last_};
  }
  void set(std::int64_t by) { set_ += by; }

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::mt19937_64 random_;
  double drift_ppm_, jitter_us_;
  std::int64_t set_ = 0, last_ = 0;
};

// Errors [ns] of the instants of frames that leave from `from` to `to`: positive is too late.
struct Errors {
  std::int64_t earliest = 0, latest = 0, median = 0;
};
constexpr NodeId kFarSender{3};
constexpr std::uint64_t kFarHost = 77;

Errors errors(ArrivalInstant& instants, Afar& afar, std::int64_t from, std::int64_t to, std::int64_t every) {
  std::vector<std::int64_t> all;
  for (std::int64_t left = from; left < to; left += every) {
    const Afar::Frame frame = afar.at(left);
    const ports::MachineTime at = instants.of(kFarSender, kFarHost, frame.sent, ports::MachineTime{frame.received});
    EXPECT_LE(at.ns, frame.received);
    all.push_back(at.ns - (left + kLeast));
  }
  std::ranges::sort(all);
  return {all.front(), all.back(), all[all.size() / 2]};
}

class DdsArrivalInstant : public testing::TestWithParam<std::uint64_t> {};

// Wake-ups are 200 us late on average. The instants show none of it, except the least of some hundred.
TEST_P(DdsArrivalInstant, OneSidedJitterVanishes) {
  ArrivalInstant instants(4);
  Afar afar(GetParam(), 0, 200);
  errors(instants, afar, 0, kSecond, 5 * kMs);
  const Errors settled = errors(instants, afar, kSecond, 10 * kSecond, 5 * kMs);
  EXPECT_GE(settled.earliest, 0);
  EXPECT_LE(settled.latest, 12 * kUs);
  EXPECT_LE(settled.median, 2 * kUs);
  EXPECT_GE(errors(instants, afar, 10 * kSecond, 60 * kSecond, 5 * kMs).earliest, -3 * kUs);
}

// Either clock off by 100 ppm at most, known or not.
TEST_P(DdsArrivalInstant, DriftIsFollowedAndThenKnown) {
  for (const double ppm : {-200.0, -100.0, -20.0, 20.0, 100.0, 200.0}) {
    SCOPED_TRACE(ppm);
    ArrivalInstant instants(4);
    Afar afar(GetParam(), ppm, 200);
    errors(instants, afar, 0, kSecond, 5 * kMs);
    // While the drift is unknown, the least delay of a second ago counts if delays grow (the other clock is
    // slow).
    const Errors unknown = errors(instants, afar, kSecond, 8 * kSecond, 5 * kMs);
    EXPECT_GE(unknown.earliest, std::min(0.0, ppm * 1e3) - 1e3);
    EXPECT_LE(unknown.latest, 100 * kUs);
    errors(instants, afar, 8 * kSecond, 20 * kSecond, 5 * kMs);
    const Errors known = errors(instants, afar, 20 * kSecond, 60 * kSecond, 5 * kMs);
    EXPECT_GE(known.earliest, -6 * kUs);
    EXPECT_LE(known.latest, 15 * kUs);
    EXPECT_LE(std::abs(known.median), 4 * kUs);
  }
}

// Set ahead: noticed at the next frame with hardly any delay. Set back: within a window.
TEST_P(DdsArrivalInstant, AClockThatIsSetIsFollowed) {
  for (const std::int64_t by : {5 * kSecond, 3 * kMs, -3 * kMs, -5 * kSecond}) {
    SCOPED_TRACE(by);
    ArrivalInstant instants(4);
    Afar afar(GetParam(), 0, 200);
    errors(instants, afar, 0, 20 * kSecond, 5 * kMs);
    afar.set(by);
    const Errors meanwhile = errors(instants, afar, 20 * kSecond, 21 * kSecond + 40 * kMs, 5 * kMs);
    EXPECT_GE(meanwhile.earliest, std::min<std::int64_t>(by, 0) - 3 * kUs);
    const Errors then = errors(instants, afar, 21 * kSecond + 40 * kMs, 60 * kSecond, 5 * kMs);
    EXPECT_GE(then.earliest, -3 * kUs);
    EXPECT_LE(then.latest, 15 * kUs);
  }
}

// A new boot forgets the old one's least delay.
TEST_P(DdsArrivalInstant, AHostThatWasStartedAnewBeginsAnew) {
  ArrivalInstant instants(1);
  Afar before(GetParam(), 0, 200);
  errors(instants, before, 0, 5 * kSecond, 5 * kMs);
  ports::MachineTime last{};
  for (std::int64_t i = 0; i < 1000; ++i) {
    const std::int64_t left = 6 * kSecond + i * 5 * kMs;
    const Afar::Frame frame = before.at(left);
    const ports::MachineTime at =
        instants.of(kFarSender, kFarHost + 1, left - 6 * kSecond, ports::MachineTime{frame.received});
    if (i == 0) {
      EXPECT_EQ(at.ns, frame.received);
    }
    EXPECT_GE(at.ns, left + kLeast);
    EXPECT_LE(at.ns, frame.received);
    EXPECT_GE(at, last);
    last = at;
  }
}

INSTANTIATE_TEST_SUITE_P(Drawn, DdsArrivalInstant, testing::Range<std::uint64_t>(1, 11));

// Without a known drift, it is the least of a second, up to values in the bin of that second's start.
TEST(DdsLeastDelay, IsTheLeastOfASecond) {
  std::mt19937_64 random(3);
  LeastDelay least;
  std::vector<std::pair<std::int64_t, std::int64_t>> frames;  // received, delay
  const auto of_the_last = [&frames](std::int64_t span) {
    std::int64_t found = frames.back().second;
    for (const auto& [received, delay] : frames)
      if (received > frames.back().first - span) found = std::min(found, delay);
    return found;
  };
  for (std::int64_t received = 0; received < 9 * kSecond;
       received += static_cast<std::int64_t>(random() % (40 * kMs))) {
    frames.emplace_back(received, static_cast<std::int64_t>(random() % (2 * kMs)) - kMs);
    const std::int64_t said = least.least(ports::MachineTime{received}, Duration{frames.back().second}).ns;
    ASSERT_GE(said, of_the_last(LeastDelay::kWindow.ns)) << received;
    ASSERT_LE(said, of_the_last(LeastDelay::kWindow.ns - LeastDelay::kWindow.ns / 32)) << received;
  }
}

// The first has arrived when it was in hand. From then on, no arrival is later than the least delay so far.
//
//   left       0     10    20    30    40 ms
//   delayed    900   300   500   60    700 us
TEST(DdsArrivalInstantBegin, TheLeastDelayedSoFarIsTheMeasure) {
  ArrivalInstant instants(1);
  std::int64_t least = 1'000 * kUs;
  std::int64_t left = 0;
  for (const std::int64_t delayed : {900 * kUs, 300 * kUs, 500 * kUs, 60 * kUs, 700 * kUs}) {
    least = std::min(least, delayed);
    EXPECT_EQ(
        instants.of(kFarSender, kFarHost, left + kApart + kSecond, ports::MachineTime{left + delayed + kSecond}).ns,
        left + least + kSecond);
    left += 10 * kMs;
  }
}

// L2: a burst taken at once after a stop, directly followed by an undelayed frame.
TEST(DdsArrivalInstantOrder, OfOneSenderNothingComesBeforeWhatCameBefore) {
  ArrivalInstant instants(1);
  const ports::MachineTime first = instants.of(NodeId{1}, kFarHost, 1'000 * kUs, ports::MachineTime{kSecond});
  EXPECT_EQ(first.ns, kSecond);
  const ports::MachineTime next = instants.of(NodeId{1}, kFarHost, 1'010 * kUs, ports::MachineTime{kSecond});
  EXPECT_EQ(next, first);
  // Another's, that left in between, is where the better minimum puts it.
  const ports::MachineTime other = instants.of(NodeId{2}, kFarHost, 1'005 * kUs, ports::MachineTime{kSecond + kUs});
  EXPECT_LT(other, next);
  EXPECT_EQ(other.ns, kSecond - 5 * kUs);
}

// Each host has its own minimum. When room runs out, the host that was silent for longest is forgotten.
TEST(DdsArrivalInstantHosts, HaveTheirOwnMinima) {
  ArrivalInstant instants(2);
  const auto delayed = [&](std::uint64_t host, std::int64_t by) {
    static std::int64_t left = kSecond;
    left += kMs;
    return instants.of(NodeId{static_cast<std::uint8_t>(host)}, host, left, ports::MachineTime{left + by}).ns - left;
  };
  EXPECT_EQ(delayed(1, 100), 100);
  EXPECT_EQ(delayed(2, 300), 300);
  EXPECT_EQ(delayed(1, 500), 100);
  EXPECT_EQ(delayed(2, 500), 300);
  EXPECT_EQ(delayed(3, 400), 400);  // 1 is forgotten
  EXPECT_EQ(delayed(2, 500), 300);
  EXPECT_EQ(delayed(1, 500), 500);  // and now 3
  EXPECT_EQ(delayed(2, 500), 300);
}

// With any stamp, instants are in order, never after the frame was in hand, and repeatable.
TEST(DdsArrivalInstantProperty, HoldsForAnyStamps) {
  std::mt19937_64 random(5);
  ArrivalInstant one(3), again(3);
  std::array<ports::MachineTime, 8> last{};
  std::int64_t received = 0;
  for (int i = 0; i < 200'000; ++i) {
    received += static_cast<std::int64_t>(random() % (1ull << (random() % 36)));
    const NodeId sender{static_cast<std::uint8_t>(random() % 8)};
    const std::uint64_t host = 1 + random() % 5;
    const auto sent = random() % 4 == 0 ? static_cast<std::int64_t>(random() % 4'000'000'000'000'000'000)
                                        : received + static_cast<std::int64_t>(random() % 1'000'000);
    const ports::MachineTime at = one.of(sender, host, sent, ports::MachineTime{received});
    ASSERT_LE(at.ns, received) << i;
    ASSERT_GE(at, last[index_of(sender)]) << i;
    ASSERT_EQ(at, again.of(sender, host, sent, ports::MachineTime{received})) << i;
    last[index_of(sender)] = at;
  }
}

}  // namespace
}  // namespace ttf::bus::dds::live
