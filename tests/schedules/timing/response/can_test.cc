// CAN against a bus that arbitrates frame by frame, without errors and with them.
#include "schedules/timing/response/can.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/can_load.h"
#include "schedules/timing/response/can_faults.h"
#include "tests/schedules/timing/simulated_resource.h"

namespace ttf::schedules::timing::response {
namespace {

// Draws messages with few bits, below full load.
std::vector<CanMessage> small_messages(RandomStream& stream, std::size_t count, std::int64_t longest_jitter) {
  for (;;) {
    std::vector<CanMessage> messages;
    double load = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t period = stream.integer(4, 24);
      messages.push_back({.period = period,
                          .transmission = stream.integer(1, 6),
                          .deadline = period,
                          .jitter = stream.integer(0, longest_jitter)});
      load += static_cast<double>(messages.back().transmission) / static_cast<double>(period);
    }
    if (load < 0.97) return messages;
  }
}

std::int64_t longest_below(const std::vector<CanMessage>& messages, std::size_t which) {
  std::int64_t longest = 0;
  for (std::size_t i = which + 1; i < messages.size(); ++i) longest = std::max(longest, messages[i].transmission);
  return longest;
}

// The critical instant: a lower frame has just begun. All messages come with their jitter, their next ones without it.
std::int64_t critical_response(const std::vector<CanMessage>& messages, std::size_t which) {
  std::vector<SimulatedJob> jobs;
  for (std::size_t i = 0; i <= which; ++i)
    for (std::int64_t at = -messages[i].jitter; at < 2'000; at += messages[i].period)
      jobs.push_back({i, at, std::max<std::int64_t>(0, at), messages[i].transmission});
  return simulated_longest(jobs, which + 1, Preemption::kNever, longest_below(messages, which))[which];
}

// The formula of clusters adds up the same bits.
TEST(CanMessages, FramesAreAsLongAsAClustersOwn) {
  model::CanBus bus;
  bus.nominal_bit_rate = bus.data_bit_rate = 500'000;
  for (int bytes = 0; bytes <= 8; ++bytes)
    EXPECT_EQ(can_time_ns(can_frame_bits(CanIdentifier::k11Bits, bytes), bus.nominal_bit_rate),
              analysis::can_worst_case(bus, bytes).ns);
}

TEST(CanMessages, CriticalInstantsReachTheResponse) {
  RandomStream stream({.seed = 21});
  for (int set = 0; set < 200; ++set) {
    const std::vector<CanMessage> messages = small_messages(stream, 4, set % 2 == 0 ? 0 : 30);
    const std::vector<Response> responses = can_responses({.bit = 1, .errors = {}}, messages);
    for (std::size_t i = 0; i < messages.size(); ++i)
      ASSERT_EQ(responses[i], (Response{Quality::kExact, critical_response(messages, i)}))
          << "set " << set << ", " << i;
  }
}

// Any phases, any jitter, any blocking frame up to the longest.
TEST(CanMessages, NoPhaseExceedsTheResponse) {
  RandomStream stream({.seed = 22});
  for (int set = 0; set < 300; ++set) {
    const std::vector<CanMessage> messages = small_messages(stream, 4, 12);
    const std::vector<Response> responses = can_responses({.bit = 1, .errors = {}}, messages);
    std::vector<SimulatedJob> jobs;
    for (std::size_t i = 0; i < messages.size(); ++i)
      for (std::int64_t at = stream.integer(0, 30); at < 600; at += messages[i].period)
        jobs.push_back({i, at, at + stream.integer(0, messages[i].jitter), messages[i].transmission});
    const auto longest = simulated_longest(jobs, messages.size(), Preemption::kNever);
    for (std::size_t i = 0; i < messages.size(); ++i)
      ASSERT_TRUE(responses[i].keeps(kLongestResponse) && longest[i] <= responses[i].longest);
  }
}

// Errors as a bucket of `at_once` that fills by one every `interarrival`.
class SimulatedErrors {
 public:
  explicit SimulatedErrors(const CanErrors& errors) : errors_(errors) {}
  bool strikes(RandomStream& stream, std::int64_t bit) {
    const std::int64_t due = std::max(bit, full_again_);
    if (due - bit > (errors_.at_once - 1) * errors_.interarrival || stream.uniform() < 0.3) return false;
    full_again_ = due + errors_.interarrival;
    return true;
  }

 private:
  CanErrors errors_;
  std::int64_t full_again_ = 0;
};

// Sends frames in bits. An error strikes the last bit of a frame. An error frame of 31 bits follows, and a new
// arbitration.
std::vector<std::int64_t> struck_longest(RandomStream& stream, const std::vector<CanMessage>& messages,
                                         const CanErrors& errors) {
  struct Waiting {
    std::size_t message;
    std::int64_t arrival, queued;
  };
  std::vector<Waiting> waiting;
  for (std::size_t i = 0; i < messages.size(); ++i)
    for (std::int64_t at = stream.integer(0, 300); at < 6'000; at += messages[i].period)
      waiting.push_back({i, at, at + stream.integer(0, messages[i].jitter)});
  SimulatedErrors strike(errors);
  std::vector<std::int64_t> longest(messages.size(), 0);
  std::int64_t now = 0;
  while (!waiting.empty()) {
    auto next = waiting.end();
    std::int64_t soonest = kLongestResponse;
    for (auto one = waiting.begin(); one != waiting.end(); ++one) {
      soonest = std::min(soonest, one->queued);
      if (one->queued <= now && (next == waiting.end() || one->message < next->message)) next = one;
    }
    if (next == waiting.end()) {
      now = soonest;
      continue;
    }
    now += messages[next->message].transmission;
    if (strike.strikes(stream, now - 1)) {
      now += kCanErrorBits;
      continue;
    }
    longest[next->message] = std::max(longest[next->message], now - next->arrival);
    waiting.erase(next);
  }
  return longest;
}

TEST(CanMessages, NoErrorsExceedTheirBound) {
  RandomStream stream({.seed = 23});
  int bounded = 0;
  for (int set = 0; set < 300; ++set) {
    std::vector<CanMessage> messages = small_messages(stream, 4, 10);
    for (CanMessage& one : messages) one.period *= 12;  // room for errors
    const CanErrors errors{.at_once = stream.integer(1, 3), .interarrival = stream.integer(80, 400)};
    const std::vector<Response> responses = can_responses({.bit = 1, .errors = errors}, messages);
    const auto longest = struck_longest(stream, messages, errors);
    for (std::size_t i = 0; i < messages.size(); ++i) {
      if (!responses[i].bounded()) continue;
      ASSERT_LE(longest[i], responses[i].longest) << "set " << set << ", message " << i;
      ASSERT_EQ(responses[i].quality, Quality::kBound);
      ++bounded;
    }
  }
  EXPECT_GT(bounded, 1'000);
}

// Tindell's term by hand: w = E(w + 100). One message of 100 bits comes each 1000. Errors come 500 apart. One of them
// costs 131 bits.
TEST(CanMessages, ErrorTermByHand) {
  const std::vector<CanMessage> one{{.period = 1'000, .transmission = 100, .deadline = 1'000}};
  EXPECT_EQ(can_responses({.bit = 1, .errors = CanErrors{1, 500}}, one)[0], (Response{Quality::kBound, 231}));
  EXPECT_EQ(can_responses({.bit = 1, .errors = CanErrors{3, 500}}, one)[0], (Response{Quality::kBound, 493}));
  EXPECT_EQ(can_responses({.bit = 1, .errors = CanErrors{4, 500}}, one)[0], (Response{Quality::kBound, 755}));
  EXPECT_EQ(can_responses({.bit = 1, .errors = CanErrors{1, 140}}, one)[0], Response{}) << "1.04 of the bus";
}

// Finds the first K whose time S_K has at most K faults, with faults drawn one after another.
TEST(CanFaults, DrawnFaultsHaveTheDistribution) {
  const std::vector<CanMessage> higher{{.period = 1'500, .transmission = 120, .deadline = 1'500, .jitter = 10},
                                       {.period = 2'600, .transmission = 95, .deadline = 2'600}};
  const CanMessage message{.period = 4'000, .transmission = 135, .deadline = 3'000, .jitter = 50};
  const double rate = 1.0 / 700.0;
  const FaultyResponses responses = responses_with_faults(1, rate, higher, message, 135);
  ASSERT_GE(responses.in_time.size(), 5U);
  EXPECT_EQ(responses.in_time[0].longest, 50 + 135 + 120 + 95 + 135);
  EXPECT_DOUBLE_EQ(responses.in_time[0].probability, std::exp(-rate * (135 + 120 + 95 + 135)));
  RandomStream stream({.seed = 24});
  constexpr int kDraws = 200'000;
  std::vector<int> hits(responses.in_time.size() + 1, 0);
  for (int draw = 0; draw < kDraws; ++draw) {
    std::size_t faults = 0;
    double next = -std::log(1.0 - stream.uniform()) / rate;
    while (faults < responses.in_time.size() &&
           next <= static_cast<double>(responses.in_time[faults].longest - message.jitter)) {
      ++faults;
      next += -std::log(1.0 - stream.uniform()) / rate;
    }
    ++hits[faults];
  }
  for (std::size_t k = 0; k <= responses.in_time.size(); ++k) {
    const double expected =
        k < responses.in_time.size() ? responses.in_time[k].probability : responses.miss_probability;
    const double sigma = std::sqrt(expected * (1.0 - expected) / kDraws);
    EXPECT_NEAR(static_cast<double>(hits[k]) / kDraws, expected, 4.0 * sigma + 1e-9) << k;
  }
}

TEST(CanFaults, WithoutFaultsNothingIsMissed) {
  const CanMessage message{.period = 1'000, .transmission = 135, .deadline = 1'000};
  EXPECT_EQ(responses_with_faults(1, 0.0, {}, message, 0).miss_probability, 0.0);
  EXPECT_EQ(
      responses_with_faults(1, 0.0, {}, {.period = 1'000, .transmission = 135, .deadline = 200}, 0).miss_probability,
      1.0)
      << "an instance before it may end just behind its arrival";
}

}  // namespace
}  // namespace ttf::schedules::timing::response
