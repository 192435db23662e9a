// Laws of recording/log/behind.h: every added message is written, in order, and adding never waits.
#include "recording/log/behind.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/allocation_counter.h"

namespace ttf::recording::log {
namespace {

constexpr std::uint32_t kSeed = 41;

// A message's number determines its whole content.
std::string payload_of(std::uint64_t number) {
  return std::string(number * 2'654'435'761 % 97, static_cast<char>('a' + number % 26));
}

void add(LogBehind& log, std::uint64_t number) {
  const std::string payload = payload_of(number);
  log.add({static_cast<std::uint8_t>(number % 251), number, number + 1, payload});
}

// Checks that the written messages are 0, 1, 2 and so on, each as added.
class Check {
 public:
  void operator()(const LogMessage& message) {
    EXPECT_EQ(message.log_time, next_);
    EXPECT_EQ(message.publish_time, next_ + 1);
    EXPECT_EQ(message.kind, next_ % 251);
    EXPECT_EQ(message.payload, payload_of(next_));
    ++next_;
  }
  std::uint64_t written() const { return next_; }

 private:
  std::uint64_t next_ = 0;
};

TEST(LogBehind, WritesAllInOrder) {
  for (const std::uint64_t count : {0u, 1u, 2u, 3u, 100'000u}) {
    Check check;
    LogBehind log([&](const LogMessage& message) { check(message); });
    for (std::uint64_t i = 0; i < count; ++i) add(log, i);
    log.close();
    EXPECT_EQ(check.written(), count);
    log.close();  // again
    EXPECT_EQ(check.written(), count);
  }
}

// For longer than the writer pauses, with pauses of all lengths between: the writer takes over at many
// instants.
TEST(LogBehind, WritesAllInOrderHoweverItIsAdded) {
  Check check;
  LogBehind log([&](const LogMessage& message) { check(message); });
  std::mt19937 random(kSeed);
  std::uint64_t added = 0;
  for (int burst = 0; burst < 200; ++burst) {
    for (std::uint64_t i = random() % 50; i > 0; --i) add(log, added++);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 2'000));
  }
  log.close();
  EXPECT_EQ(check.written(), added);
}

TEST(LogBehind, IsWrittenBehindAndNotOnlyAtTheEnd) {
  std::promise<void> written;
  LogBehind log([&](const LogMessage& message) {
    if (message.log_time == 0) written.set_value();
  });
  add(log, 0);
  written.get_future().wait();
}

// The writer stands still. Messages are kept, without allocation while there is room. If adding waited for
// the writer, this test would hang.
TEST(LogBehind, AddingNeverWaits) {
  std::promise<void> stands, go_on;
  std::uint64_t written = 0;
  LogBehind log([&](const LogMessage& message) {
    EXPECT_EQ(message.log_time, written);
    if (written++ > 0) return;
    stands.set_value();
    go_on.get_future().wait();
  });
  add(log, 0);
  stands.get_future().wait();
  const std::string payload(100, 'x');
  const std::int64_t allocations = support::allocations();
  for (std::uint64_t i = 1; i <= 30'000; ++i)  // in the room of 4 MiB
    log.add({static_cast<std::uint8_t>(i % 251), i, i + 1, payload});
  EXPECT_EQ(support::allocations(), allocations);
  go_on.set_value();
  log.close();
  EXPECT_EQ(written, 30'001u);
}

// Beyond the room it costs memory, without losses.
TEST(LogBehind, KeepsWhatThereIsNoRoomFor) {
  std::promise<void> stands, go_on;
  Check check;
  LogBehind log([&](const LogMessage& message) {
    if (message.log_time == 0) {
      stands.set_value();
      go_on.get_future().wait();
    }
    check(message);
  });
  add(log, 0);
  stands.get_future().wait();
  constexpr std::uint64_t kMany = 300'000;  // of 72 bytes on average
  for (std::uint64_t i = 1; i < kMany; ++i) add(log, i);
  go_on.set_value();
  log.close();
  EXPECT_EQ(check.written(), kMany);
}

}  // namespace
}  // namespace ttf::recording::log
