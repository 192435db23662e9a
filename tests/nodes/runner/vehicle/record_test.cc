// The record of a driven vehicle among processes: messages that get lost, come late, twice or in another order, and
// processes that begin later. Messages go by hand here, at instants of the drive.
#include "nodes/runner/vehicle/record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "core/random.h"
#include "tests/support/allocation_counter.h"

namespace ttf::nodes::runner::vehicle {
namespace {

using sim::world::vehicle::Actuation;
using sim::world::vehicle::Driven;
using sim::world::vehicle::RearAxleMotion;
using Bytes = std::vector<std::byte>;

constexpr std::int64_t kEvery = 40, kDead = 50;  // ms: between commands, and until one begins
constexpr Duration kLong = Duration::milliseconds(60'000);

TrueTime at_ms(std::int64_t ms) { return TrueTime{} + Duration::milliseconds(ms); }
// The k-th command is read at k * kEvery.
Actuation command(std::int64_t k) { return {at_ms(k * kEvery + kDead), std::sin(0.3 * static_cast<double>(k)), 0.001}; }
Bytes copy(std::span<const std::byte> message) { return {message.begin(), message.end()}; }

struct Process {
  Process() {
    config.speed = 20.0;
    config.actuator.emplace();
    driven = std::make_unique<Driven>(config, nullptr, kLong);
    record = std::make_unique<Record>(*driven);
  }
  const Counts& counts() const { return record->counts(); }
  double x(std::int64_t ms) { return driven->at(at_ms(ms)).x; }

  sim::world::vehicle::EgoConfig config;
  std::unique_ptr<Driven> driven;
  std::unique_ptr<Record> record;
};

// Lets `from` ask all of `others` until it need not ask any more. Returns the number of questions.
int ask_until_quiet(Process& from, const std::vector<Process*>& others) {
  int questions = 0;
  for (bool asks = true; asks;) {
    asks = false;
    ++questions;
    const Bytes question = copy(from.record->ask());
    std::vector<Bytes> answers;
    for (Process* other : others)
      if (const auto answer = other->record->take(question).answer; !answer.empty()) answers.push_back(copy(answer));
    for (const Bytes& answer : answers) asks |= from.record->take(answer).asks;
  }
  return questions;
}

void expect_same_way(Process& one, Process& other, std::int64_t until) {
  for (std::int64_t at = 3; at < until; at += 41) {
    const RearAxleMotion a = one.driven->at(at_ms(at)), b = other.driven->at(at_ms(at));
    EXPECT_EQ(std::memcmp(&a.x, &b.x, sizeof a.x) | std::memcmp(&a.vx, &b.vx, sizeof a.vx), 0) << at;
  }
}

TEST(VehicleRecord, IsThatOfTheActuatorBeforeACommandBegins) {
  Process actuator, sensor;
  for (std::int64_t k = 1; k <= 40; ++k) {
    EXPECT_FALSE(sensor.record->take(actuator.record->report(command(k))).asks);
    for (const std::int64_t later : {0, 17, 39})
      EXPECT_EQ(sensor.x(k * kEvery + later), actuator.x(k * kEvery + later));
  }
  EXPECT_EQ(sensor.counts().received, 40u);
  EXPECT_EQ(sensor.counts().late + sensor.counts().gaps + sensor.counts().malformed, 0u);
}

// Messages:  1  2  x  x  x  x  x  x  9
TEST(VehicleRecord, TheNextMessageMakesLostOnesGood) {
  Process actuator, sensor;
  for (std::int64_t k = 1; k <= 9; ++k) {
    const Bytes message = copy(actuator.record->report(command(k)));
    if (k <= 2 || k == 9) {
      EXPECT_FALSE(sensor.record->take(message).asks);
    }
    (void)sensor.x(k * kEvery);
  }
  EXPECT_EQ(sensor.counts().gaps, 0u);
  EXPECT_EQ(sensor.counts().late, 4u) << "3 to 6 had begun by the look at the reading of 8";
  expect_same_way(sensor, actuator, 9 * kEvery + 500);
}

TEST(VehicleRecord, ALateMessageChangesNoEarlierLookAndEveryLaterOne) {
  Process actuator, sensor;
  (void)sensor.record->take(actuator.record->report(command(1)));
  const Bytes late = copy(actuator.record->report({at_ms(200), -6.0, 0.0}));
  const double seen = sensor.x(400);
  EXPECT_NE(seen, actuator.x(400));
  (void)sensor.record->take(late);
  EXPECT_EQ(sensor.counts().late, 1u);
  EXPECT_EQ(sensor.x(400), actuator.x(400));
  EXPECT_EQ(sensor.x(401), actuator.x(401));
}

TEST(VehicleRecord, TheOrderOfMessagesAndTheirRepetitionMakeNoDifference) {
  Process actuator;
  std::vector<Bytes> messages;
  for (std::int64_t k = 1; k <= 60; ++k) messages.push_back(copy(actuator.record->report(command(k))));
  for (std::uint32_t draw = 0; draw < 10; ++draw) {
    RandomStream stream({7, draw, Purpose::kTest, 0, 0});
    Process sensor;
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < messages.size(); ++k)
      for (std::int64_t times = stream.integer(1, 2); times > 0; --times) order.push_back(k);
    for (std::size_t i = 0; i < order.size(); ++i)
      std::swap(order[i], order[std::min(order.size() - 1, i + static_cast<std::size_t>(stream.integer(0, 5)))]);
    for (const std::size_t k : order)
      if (sensor.record->take(messages[k]).asks) (void)ask_until_quiet(sensor, {&actuator});
    EXPECT_TRUE(sensor.record->whole()) << draw;
    EXPECT_EQ(sensor.counts().received, 60u) << draw;
    expect_same_way(sensor, actuator, 3'000);
  }
}

TEST(VehicleRecord, AGapIsAskedForAndAnyProcessWithAWholeRecordAnswers) {
  Process actuator, sensor, other, gone;
  for (std::int64_t k = 1; k <= 30; ++k) {
    const Bytes message = copy(actuator.record->report(command(k)));
    (void)other.record->take(message);
    if (k < 3) (void)sensor.record->take(message);
    if (k == 30) {
      EXPECT_TRUE(sensor.record->take(message).asks);
    }
  }
  EXPECT_FALSE(sensor.record->whole());
  EXPECT_EQ(sensor.counts().gaps, 1u);
  gone.record->begins_later();
  EXPECT_TRUE(gone.record->take(sensor.record->ask()).answer.empty()) << "it lacks some itself";
  EXPECT_EQ(ask_until_quiet(sensor, {&other}), 1);
  EXPECT_TRUE(sensor.record->whole());
  expect_same_way(sensor, actuator, 3'000);
}

// An answer from before the gap does not close it.
TEST(VehicleRecord, AnOldAnswerDoesNotMakeItWhole) {
  Process actuator, sensor;
  (void)sensor.record->take(actuator.record->report(command(1)));
  const Bytes question = copy(sensor.record->ask());
  const Bytes old = copy(actuator.record->take(question).answer);
  for (std::int64_t k = 2; k < 20; ++k) (void)actuator.record->report(command(k));
  EXPECT_TRUE(sensor.record->take(actuator.record->report(command(20))).asks);
  EXPECT_FALSE(sensor.record->take(old).asks);
  EXPECT_FALSE(sensor.record->whole());
  EXPECT_EQ(ask_until_quiet(sensor, {&actuator}), 1);
  EXPECT_TRUE(sensor.record->whole());
}

// 600 commands are three pages. Two processes answer each question, and the pages are asked for once.
TEST(VehicleRecord, AProcessThatBeginsLaterReceivesAll) {
  Process actuator, other, late;
  for (std::int64_t k = 1; k <= 600; ++k) (void)other.record->take(actuator.record->report(command(k)));
  late.record->begins_later();
  EXPECT_TRUE(late.record->take(actuator.record->report(command(601))).asks) << "each message is an occasion to ask";
  (void)other.record->take(actuator.record->report(command(602)));
  EXPECT_EQ(ask_until_quiet(late, {&actuator, &other}), 3);
  EXPECT_TRUE(late.record->whole());
  EXPECT_EQ(late.counts().received, 602u);
  expect_same_way(late, actuator, 26'000);
}

// A new actuator's process has none of the old one's commands, and all others go on.
TEST(VehicleRecord, AnActuatorThatBeginsAnewGoesOn) {
  Process first, sensor, second;
  for (std::int64_t k = 1; k <= 20; ++k) (void)sensor.record->take(first.record->report(command(k)));
  second.record->begins_later();
  EXPECT_EQ(ask_until_quiet(second, {&sensor}), 1);
  const bool asks = sensor.record->take(second.record->report(command(50))).asks;
  EXPECT_TRUE(asks) << "the old one may have told a last command that got lost";
  EXPECT_EQ(ask_until_quiet(sensor, {&second}), 1);
  EXPECT_TRUE(sensor.record->whole());
  expect_same_way(sensor, second, 3'000);
}

TEST(VehicleRecord, AMalformedMessageIsCountedAndNotUsed) {
  Process actuator, sensor;
  (void)actuator.record->report(command(1));
  const Bytes sound = copy(actuator.record->report(command(2)));
  const auto with = [&](std::size_t place, auto value) {
    Bytes bytes = sound;
    std::memcpy(bytes.data() + place, &value, sizeof value);
    return bytes;
  };
  std::vector<Bytes> wrong{{},
                           Bytes(5),
                           with(0, std::uint32_t{1}),
                           with(4, std::uint32_t{0}),
                           with(4, std::uint32_t{5}),
                           with(16, std::uint64_t{1}),
                           with(16, std::uint64_t{3}),
                           with(16, ~std::uint64_t{0}),
                           with(Record::kHead, std::int64_t{0}),
                           with(Record::kHead, std::int64_t{1} << 60),
                           with(Record::kHead + 8, std::numeric_limits<double>::quiet_NaN()),
                           with(Record::kHead + 16, std::numeric_limits<double>::infinity())};
  wrong.push_back(Bytes(sound.begin(), sound.end() - 1));
  wrong.push_back(Bytes(Record::kLargest + 1));
  for (const Bytes& bytes : wrong) {
    const Record::Reaction reaction = sensor.record->take(bytes);
    EXPECT_TRUE(reaction.answer.empty() && !reaction.asks);
  }
  EXPECT_EQ(sensor.counts().malformed, wrong.size());
  EXPECT_TRUE(sensor.driven->actuations().empty());
  RandomStream stream({3, 0, Purpose::kTest, 0, 0});
  for (int draw = 0; draw < 2'000; ++draw) {
    Bytes bytes = sound;
    for (int flips = 0; flips < 3; ++flips)
      bytes[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(bytes.size()) - 1))] ^=
          std::byte{static_cast<unsigned char>(1u << stream.integer(0, 7))};
    (void)sensor.record->take(bytes);
  }
  EXPECT_TRUE(std::isfinite(sensor.x(5'000)));
}

TEST(VehicleRecord, AllocatesNothing) {
  Process actuator, sensor;
  const std::int64_t before = support::allocations();
  for (std::int64_t k = 1; k <= 500; ++k) {
    const auto message = actuator.record->report(command(k));
    if (k % 20 == 0 && sensor.record->take(message).asks)
      (void)sensor.record->take(actuator.record->take(sensor.record->ask()).answer);
    (void)sensor.x(k * kEvery);
  }
  EXPECT_EQ(support::allocations(), before);
  EXPECT_GT(sensor.counts().gaps, 0u);
}

}  // namespace
}  // namespace ttf::nodes::runner::vehicle
