// Buses and slots of the CSV file against ones that run: no response exceeds its bound, and exact ones are reached.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/timing/task_set/reader.h"
#include "schedules/timing/task_set/verdict.h"
#include "tests/schedules/timing/task_set/running_buses.h"

namespace ttf::schedules::timing::task_set {
namespace {

constexpr std::int64_t kUs = 1'000;

std::string us_text(std::int64_t time) { return std::to_string(time / kUs) + " us"; }

// A drawn message, the same on every bus.
struct DrawnMessage {
  std::int64_t period = 0, jitter = 0;

  // The first arrival is within a period, and each is late by the jitter at most. A queue keeps their order.
  std::vector<BusJob> jobs(RandomStream& stream, std::int64_t horizon, std::int64_t first, bool late) const {
    std::vector<BusJob> found;
    for (std::int64_t at = first; at < horizon; at += period)
      found.push_back({.arrival = at, .queued = at + (late ? stream.integer(0, jitter) : 0)});
    for (std::size_t j = 1; j < found.size(); ++j) found[j].queued = std::max(found[j].queued, found[j - 1].queued);
    return found;
  }
};

BusJobs drawn_jobs(RandomStream& stream, const std::vector<DrawnMessage>& messages, std::int64_t horizon) {
  BusJobs jobs;
  for (const DrawnMessage& one : messages)
    jobs.push_back(one.jobs(stream, horizon, stream.integer(0, one.period), true));
  return jobs;
}

std::string message_line(std::size_t m, const DrawnMessage& one, const std::string& worst, std::size_t priority,
                         const std::string& rest = "") {
  return "message,m" + std::to_string(m) + ",bus," + us_text(one.period) + ",," + us_text(one.jitter) + ",," + worst +
         ",1 s," + (priority > 0 ? std::to_string(priority) : "") + ",implicit" + rest + "\n";
}

std::vector<response::Response> responses_in(const std::string& text) {
  std::vector<response::Response> found;
  for (const TaskTiming& timing : verdict_on(parse_task_set(text, "drawn.csv")).responses.tasks)
    found.push_back(timing.response);
  return found;
}

// Where the first job comes just behind the slot, the exact response is reached.
TEST(DrawnBuses, Tdma) {
  std::size_t reached = 0;
  for (std::uint32_t index = 0; index < 300; ++index) {
    RandomStream stream({.seed = 21, .purpose = Purpose::kTest, .index = index});
    const std::int64_t cycle = stream.integer(5, 20) * kUs, length = stream.integer(1, 4) * kUs;
    const DrawnMessage one{.period = stream.integer(10, 60) * kUs, .jitter = stream.integer(0, 1) * 7 * kUs};
    const std::int64_t work = stream.integer(1, 9) * kUs;
    const response::Response found = responses_in("bus,bus,tdma,,," + us_text(cycle) + "\n" +
                                                  message_line(0, one, us_text(work), 0, "," + us_text(length)))[0];
    ASSERT_EQ(found.bounded(), work * cycle <= one.period * length) << "set " << index;
    if (!found.bounded()) continue;
    EXPECT_EQ(found.quality, response::Quality::kExact);
    for (int draw = 0; draw < 5; ++draw) {
      const std::vector<BusJob> jobs = one.jobs(stream, 3'000 * kUs, stream.integer(0, one.period), true);
      ASSERT_LE(longest_in_slot(jobs, work, length, cycle, stream.integer(0, cycle)), found.longest) << "set " << index;
    }
    // All of the jitter first, and none behind it.
    std::vector<BusJob> worst = one.jobs(stream, 3'000 * kUs, 0, false);
    for (BusJob& job : worst) job.queued = std::max(job.queued, one.jitter);
    EXPECT_EQ(longest_in_slot(worst, work, length, cycle, one.jitter + cycle - length), found.longest)
        << "set " << index;
    ++reached;
  }
  EXPECT_GT(reached, 100U);
}

TEST(DrawnBuses, DynamicSegment) {
  constexpr std::int64_t kCycle = 1'000 * kUs, kMinislot = 10 * kUs, kMinislots = 40;
  std::size_t bounded = 0, lost = 0;
  for (std::uint32_t index = 0; index < 300; ++index) {
    RandomStream stream({.seed = 22, .purpose = Purpose::kTest, .index = index});
    const bool at_start = index % 2 == 1;
    std::string text = std::string("bus,bus,dynamic,,,1 ms,40,10 us,") + (at_start ? "start\n" : "turn\n");
    std::vector<RunningFrame> frames;
    std::vector<DrawnMessage> messages;
    const std::int64_t count = stream.integer(2, 5);
    for (int m = 0; m < count; ++m) {
      RunningFrame frame;
      frame.slot = m + 1;
      frame.repetition = static_cast<int>(1 << stream.integer(0, 2));
      frame.base_cycle = static_cast<int>(stream.integer(0, frame.repetition - 1));
      frame.minislots = stream.integer(2, 25);
      const bool fits = stream.integer(0, 1) == 0;
      frame.latest_tx = fits ? kMinislots - frame.minislots + 1 : stream.integer(m + 1, kMinislots - 25 + 1);
      messages.push_back({.period = stream.integer(4, 30) * kCycle + stream.integer(0, 99) * kUs,
                          .jitter = stream.integer(0, 1) * stream.integer(0, 2'000) * kUs});
      text += message_line(static_cast<std::size_t>(m), messages.back(), std::to_string(frame.minislots),
                           static_cast<std::size_t>(frame.slot),
                           ",," + std::to_string(frame.base_cycle) + "/" + std::to_string(frame.repetition) +
                               (fits ? "" : "," + std::to_string(frame.latest_tx)));
      frames.push_back(frame);
    }
    const std::vector<response::Response> found = responses_in(text);
    for (int draw = 0; draw < 5; ++draw) {
      const std::vector<std::int64_t> longest =
          longest_in_segments(frames, drawn_jobs(stream, messages, 300 * kCycle),
                              {.cycle = kCycle, .minislot = kMinislot, .decides_at_start = at_start}, 400);
      for (std::size_t m = 0; m < found.size(); ++m) {
        if (!found[m].bounded()) continue;
        ++bounded;
        ASSERT_LE(longest[m], found[m].longest) << "set " << index << ", message " << m << "\n" << text;
        lost += longest[m] > (frames[m].repetition + 1) * kCycle + messages[m].jitter ? 1 : 0;
      }
    }
  }
  EXPECT_GT(bounded, 2000U);
  EXPECT_GT(lost, 20U);  // lower slots do take turns away
}

TEST(DrawnBuses, CanWithErrors) {
  std::size_t bounded = 0, struck = 0;
  for (std::uint32_t index = 0; index < 300; ++index) {
    RandomStream stream({.seed = 23, .purpose = Purpose::kTest, .index = index});
    const std::int64_t apart = stream.integer(3'000, 20'000) * kUs;
    std::string messages_text;
    std::vector<DrawnMessage> messages;
    std::vector<std::int64_t> transmissions;
    for (std::int64_t m = 0, count = stream.integer(2, 5); m < count; ++m) {
      const std::int64_t bytes = stream.integer(0, 8);
      messages.push_back({.period = stream.integer(3'000, 12'000) * kUs,
                          .jitter = stream.integer(0, 1) * stream.integer(0, 4'000) * kUs});
      transmissions.push_back((55 + 10 * bytes) * 8 * kUs);  // 125 kbit/s
      messages_text += message_line(static_cast<std::size_t>(m), messages.back(), std::to_string(bytes),
                                    static_cast<std::size_t>(m + 1));
    }
    const std::string bus = "bus,bus,can,125000,";
    const std::vector<response::Response> found = responses_in(bus + ",,,,," + us_text(apart) + "\n" + messages_text);
    const std::vector<response::Response> without = responses_in(bus + "\n" + messages_text);
    for (int draw = 0; draw < 5; ++draw) {
      std::vector<std::int64_t> errors;
      for (std::int64_t at = stream.integer(0, apart); at < 2'000'000 * kUs; at += apart + stream.integer(0, 2) * kUs)
        errors.push_back(at);
      const std::vector<std::int64_t> longest =
          longest_on_can(transmissions, drawn_jobs(stream, messages, 1'000'000 * kUs), errors, 31 * 8 * kUs);
      for (std::size_t m = 0; m < found.size(); ++m) {
        if (!found[m].bounded()) continue;
        ++bounded;
        EXPECT_EQ(found[m].quality, response::Quality::kBound);
        ASSERT_LE(longest[m], found[m].longest) << "set " << index << ", message " << m;
        struck += longest[m] > without[m].longest ? 1 : 0;
      }
    }
  }
  EXPECT_GT(bounded, 2000U);
  EXPECT_GT(struck, 20U);  // errors make frames later than any could be without
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
