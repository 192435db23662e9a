// Each law of bus/ports/live_medium.h as a function that tries it and returns the error in words; empty: no
// error. So they can be tried on media that break them (tests/bus/ports/live_medium_test.cc), and are known
// to notice.
#pragma once

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bus/ports/live_medium.h"
#include "tests/laws/live_listener.h"
#include "tests/support/allocation_counter.h"

namespace ttf::laws {

// One listener for each member.
inline std::vector<LiveListener> listeners(LiveBench& bench, Traffic traffic) {
  std::vector<LiveListener> all;
  for (std::size_t i = 0; i < bench.members(); ++i) all.emplace_back(bench, i, traffic);
  return all;
}

inline std::string first_wrong(const std::vector<LiveListener>& members) {
  for (const LiveListener& member : members)
    if (!member.wrong().empty()) return member.wrong();
  return {};
}

// Returns the next signal this member receives in time.
inline std::optional<bus::ports::LiveArrival> await(
    LiveBench& bench, std::size_t member, const std::function<void()>& meanwhile = [] {}) {
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    if (auto received = bench.member(member).receive()) return received;
    if (std::chrono::steady_clock::now() - begin > bench.patience()) return {};
    meanwhile();
    std::this_thread::sleep_for(kGlance);
  }
}

inline bool readable(bus::ports::LiveMedium& medium, bus::ports::Line line, std::chrono::milliseconds patience) {
  pollfd poller{medium.descriptor(line), POLLIN, 0};
  return poll(&poller, 1, static_cast<int>(patience.count())) == 1 && (poller.revents & POLLIN) != 0;
}

// Checks that the medium counted all utterances sent and received, without losses.
inline std::string check_counts(LiveBench& bench, const LiveListener& member) {
  std::uint64_t said = 0;
  for (bus::ports::Line line = 0; line < bench.lines(); ++line) said += member.said(line);
  const bus::ports::LiveCounts counts = member.medium().counts();
  if (counts.sent == said && counts.received == member.received() && counts.not_sent == member.refused() &&
      counts.lost == 0 && counts.foreign == 0 && counts.malformed == 0 && member.medium().failure().empty())
    return {};
  return fmt::format(
      "member {} counts {} sent for {}, {} received for {}, {} not sent for {}, {} lost, {} foreign, {} "
      "malformed; \"{}\"",
      member.self(), counts.sent, said, counts.received, member.received(), counts.not_sent, member.refused(),
      counts.lost, counts.foreign, counts.malformed, member.medium().failure());
}

inline void say_on_all_lines(LiveBench& bench, LiveListener& member, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    for (bus::ports::Line line = 0; line < bench.lines(); ++line)
      if (bench.on(member.self(), line)) member.say(line);
}
inline void receive_all_of(
    LiveBench& bench, LiveListener& member, std::size_t count, const std::function<void()>& meanwhile = [] {}) {
  for (bus::ports::Line line = 0; line < bench.lines(); ++line)
    for (const std::size_t other : bench.others(member.self(), line))
      if (bench.on(member.self(), line)) member.receive_until(line, other, count, false, meanwhile);
}

// L1, and the lateness that departures have. Every member talks on all lines, in rounds, each member in its
// own thread or one after the other.
inline std::string once_and_unchanged(LiveBench& bench, bool in_threads) {
  static constexpr std::size_t kRounds = 200, kEach = 2;
  auto members = listeners(bench, Traffic::kAll);
  std::atomic<bool> stop = false;
  const auto say = [&](LiveListener& member) { say_on_all_lines(bench, member, kEach); };
  const auto all_receive = [&] {
    if (in_threads) return;
    for (LiveListener& member : members) member.receive();
  };
  const auto receive = [&](LiveListener& member, std::size_t round) {
    receive_all_of(bench, member, (round + 1) * kEach, all_receive);
    if (!member.wrong().empty()) stop = true;
  };
  if (in_threads) {
    std::vector<std::thread> threads;
    for (LiveListener& member : members)
      threads.emplace_back([&say, &receive, &stop, &member] {
        for (std::size_t round = 0; round < kRounds && !stop; ++round) say(member), receive(member, round);
      });
    for (std::thread& thread : threads) thread.join();
  } else {
    for (std::size_t round = 0; round < kRounds && !stop; ++round) {
      for (LiveListener& member : members) say(member);
      for (LiveListener& member : members) receive(member, round);
    }
  }
  for (LiveListener& member : members) member.receive_rest();  // no signal comes twice
  std::string wrong = first_wrong(members);
  for (const LiveListener& member : members)
    if (wrong.empty()) wrong = check_counts(bench, member);
  return wrong;
}

// L1 without listeners: missing signals are counted, arriving ones are whole and in order, and others receive
// everything.
inline std::string missing_is_counted(LiveBench& bench) {
  auto members = listeners(bench, Traffic::kFrames);
  LiveListener& speaker = members[0];
  const bus::ports::Line line = bus::ports::line_of(schedules::model::Channel::kA);
  for (std::size_t i = 0; i < bench.flood(); ++i) {
    speaker.try_to_say(line);
    for (LiveListener& member : members)
      if (member.self() > 1) member.receive_until(line, 0, speaker.said(line));
    if (auto wrong = first_wrong(members); !wrong.empty()) return wrong;
  }
  LiveListener& sleeper = members[1];
  sleeper.receive_rest(true);
  speaker.say(line);  // shows that an earlier one is missing
  sleeper.receive_until(line, 0, speaker.said(line), true);
  if (!sleeper.wrong().empty()) return sleeper.wrong();
  const std::uint64_t lost = sleeper.medium().counts().lost, missing = sleeper.missed(line, 0);
  if (missing == 0 && speaker.refused() == 0) return "the flood was none: nothing is missing";
  if (lost < missing || (lost > missing && !bench.loses_pieces()))
    return fmt::format("{} are missing, {} are counted as lost", missing, lost);
  if (speaker.medium().counts().not_sent != speaker.refused())
    return fmt::format("{} had no room, {} are counted", speaker.refused(), speaker.medium().counts().not_sent);
  return {};
}

// L2: a lone speaker receives nothing, on any line.
inline std::string does_not_receive_itself(LiveBench& bench) {
  auto members = listeners(bench, Traffic::kAll);
  for (LiveListener& speaker : members) {
    say_on_all_lines(bench, speaker, 20);
    for (LiveListener& other : members)
      for (bus::ports::Line line = 0; line < bench.lines(); ++line)
        if (&other != &speaker && bench.on(speaker.self(), line) && bench.on(other.self(), line))
          other.receive_until(line, speaker.self(), 20, false, [&] { speaker.receive(); });
    if (speaker.medium().receive()) return fmt::format("member {} hears itself", speaker.self());
  }
  return first_wrong(members);
}

// L3: in the order of sending, without listening in between.
inline std::string keeps_the_order(LiveBench& bench) {
  auto members = listeners(bench, Traffic::kAll);
  for (LiveListener& member : members) say_on_all_lines(bench, member, 24);
  const auto all_receive = [&] {
    for (LiveListener& member : members) member.receive();
  };
  for (LiveListener& member : members) receive_all_of(bench, member, 24, all_receive);
  return first_wrong(members);
}

// L4, and that `at` is when it arrived and not when it was looked for.
inline std::string arrives_when_it_says(LiveBench& bench) {
  static constexpr auto kNap = std::chrono::milliseconds(400);
  for (std::size_t i = 0; i < 100; ++i) {
    const bool late = i % 50 == 49;
    const bus::ports::MachineTime begin = bus::ports::host_now();
    const Utterance utterance(i % 2, {0, bench.members()}, i, Traffic::kFrames);
    if (utterance.send(bench.member(0)) != bus::ports::LiveStatus::kDone) return "has no room";
    if (late) std::this_thread::sleep_for(kNap);
    const auto received = await(bench, 1);
    const bus::ports::MachineTime end = bus::ports::host_now();
    if (!received || !utterance.is(*received)) return "hears something else";
    if (received->at < begin || received->at > end)
      return fmt::format("arrives {} ns after it was sent, {} ns before it is received", (received->at - begin).ns,
                         (end - received->at).ns);
    if (received->received < received->at || received->received > end)
      return fmt::format("was in hand {} ns after it arrived, {} ns before it is received",
                         (received->received - received->at).ns, (end - received->received).ns);
    if (received->left && (*received->left < begin || *received->left > received->received))
      return fmt::format("left {} ns after it was sent, {} ns before it was in hand", (*received->left - begin).ns,
                         (received->received - *received->left).ns);
    if (late && end - received->at < Duration::milliseconds(kNap.count() / 4))
      return "is said to arrive when it is looked for";
  }
  return {};
}

// L5: senders' bytes are not looked at after send(), arrivals' are there while others send.
inline std::string keeps_what_is_its_own(LiveBench& bench) {
  static constexpr std::size_t kCount = 20;
  std::vector<Utterance> said;
  said.reserve(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    said.emplace_back(bus::ports::Line{0}, Speaker{0, bench.members()}, i, Traffic::kFrames);
    if (said.back().send(bench.member(0)) != bus::ports::LiveStatus::kDone) return "has no room";
    said.back().scribble();
  }
  const auto expected = [&bench](std::size_t number) {
    return Utterance(0, {0, bench.members()}, number, Traffic::kFrames);
  };
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto received = await(bench, 1);
    if (!received || !expected(i).is(*received)) return fmt::format("number {} is not what was sent", i);
    if (i + 1 < kCount) continue;
    for (std::size_t more = 1; more <= 100; ++more) expected(i + more).send(bench.member(0));
    std::this_thread::sleep_for(bench.quiet());
    if (!expected(i).is(*received)) return "what was received has changed";
  }
  return {};
}

// L6. The first round is not counted: a first send may have work left to do.
inline std::string never_blocks_nor_allocates(LiveBench& bench) {
  static constexpr std::size_t kCount = 32;
  static constexpr auto kAtOnce = std::chrono::seconds(1);  // on a machine that has other things to do
  const auto timed = [](auto&& call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::steady_clock::now() - begin;
  };
  auto longest = std::chrono::steady_clock::duration::zero();
  const std::size_t lines = bench.lines();
  std::vector<std::vector<Utterance>> utterances(lines);
  for (bus::ports::Line line = 0; line < lines; ++line)
    for (std::size_t i = 0; i < kCount && bench.on(0, line); ++i)
      utterances[line].emplace_back(line, Speaker{0, bench.members()}, i, Traffic::kAll, bench.fast(line));
  std::int64_t allocated = 0;
  std::size_t received = 0, said = 0;
  for (int round = 0; round < 2; ++round) {
    const std::int64_t before = support::allocations();
    for (bus::ports::Line line = 0; line < lines; ++line) {
      for (const Utterance& utterance : utterances[line]) {
        longest =
            std::max(longest, timed([&] { said += utterance.send(bench.member(0)) == bus::ports::LiveStatus::kDone; }));
      }
    }
    for (std::size_t quiet = 0; quiet < 50; ++quiet) {
      for (std::size_t i = 1; i < bench.members(); ++i) {
        bool something = true;
        while (something) {
          longest = std::max(longest, timed([&] { something = bench.member(i).receive().has_value(); }));
          received += something;
          if (something) quiet = 0;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    allocated = support::allocations() - before;
  }
  if (received < said) return fmt::format("{} heard of {}", received, said);
  if (longest > kAtOnce)
    return fmt::format("a call took {} ms", std::chrono::duration_cast<std::chrono::milliseconds>(longest).count());
  if (allocated != 0) return fmt::format("{} allocations on the way", allocated);
  return {};
}

// L7: on every line, and our own frames are still received.
inline std::string strangers_are_counted(LiveBench& bench, LiveBench::Intruder what) {
  auto members = listeners(bench, Traffic::kAll);
  for (bus::ports::Line line = 0; line < bench.lines(); ++line) {
    std::vector<bus::ports::LiveCounts> before;
    for (const LiveListener& member : members) before.push_back(member.medium().counts());
    if (!bench.intrude(line, what)) continue;
    const std::size_t speaker = bench.on(0, line) ? 0 : bench.others(0, line).front();
    members[speaker].say(line);
    for (const std::size_t other : bench.others(speaker, line)) {
      members[other].receive_until(line, speaker, 1);
      members[other].receive_rest();
      const bus::ports::LiveCounts counts = members[other].medium().counts();
      const bool foreign = what == LiveBench::Intruder::kForeign;
      const std::uint64_t counted =
          foreign ? counts.foreign - before[other].foreign : counts.malformed - before[other].malformed;
      if (counted != 1) return fmt::format("line {}: member {} counts {} strangers, not 1", line, other, counted);
      if ((foreign ? counts.malformed - before[other].malformed : counts.foreign - before[other].foreign) != 0)
        return fmt::format("line {}: member {} takes it for what it is not", line, other);
    }
  }
  return first_wrong(members);
}

// L8, for each line separately.
inline std::string what_is_watched_is_readable(LiveBench& bench) {
  using namespace std::chrono_literals;
  for (bus::ports::Line line = 0; line < bench.lines(); ++line) {
    const std::size_t speaker = bench.on(0, line) ? 0 : bench.others(0, line).front();
    const std::size_t receiver = bench.others(speaker, line).front();
    bus::ports::LiveMedium& medium = bench.member(receiver);
    const auto say = [&](std::size_t number) {
      return Utterance(line, {speaker, bench.members()}, number, Traffic::kFrames, bench.fast(line))
                 .send(bench.member(speaker)) == bus::ports::LiveStatus::kDone;
    };
    const auto complaint = [line](const char* what) { return fmt::format("line {} {}", line, what); };
    for (std::size_t i = 0; i < bench.members(); ++i)
      if ((bench.member(i).descriptor(line) >= 0) != bench.on(i, line))
        return complaint("has a descriptor where it should have none, or none where it should");
    medium.watch(line, true);
    if (readable(medium, line, 0ms)) return complaint("is readable with nothing there");
    if (!say(0) || !readable(medium, line, bench.patience())) return complaint("is not readable");
    if (!say(1)) return complaint("has no room");
    std::this_thread::sleep_for(bench.quiet());
    if (!await(bench, receiver) || !readable(medium, line, 0ms))
      return complaint("is not readable while there is more");
    if (!await(bench, receiver) || medium.receive()) return complaint("hears too little or too much");
    if (readable(medium, line, 0ms)) return complaint("is readable after everything was handed over");
    medium.watch(line, false);
    if (!say(2)) return complaint("has no room");
    std::this_thread::sleep_for(bench.quiet());
    medium.watch(line, true);
    if (!readable(medium, line, bench.patience()))
      return complaint("is not readable where it came before it was watched");
    if (!await(bench, receiver)) return complaint("hears nothing");
    medium.watch(line, false);
    for (std::size_t i = 0; i < bench.members(); ++i)  // the others have received it too
      while (bench.member(i).receive()) {
      }
  }
  return {};
}

// A sync frame gives its lateness: no less than at the begin of send(), no more than at its return.
inline std::string says_how_late_it_left(LiveBench& bench) {
  for (std::size_t i = 0; i < 20; ++i) {
    const Utterance utterance(i % 2, {0, bench.members()}, 1 + 8 * i, Traffic::kAll);
    const bus::ports::MachineTime due =
        bus::ports::host_now() - Duration::microseconds(static_cast<std::int64_t>(700 * i));
    const bus::ports::MachineTime begin = bus::ports::host_now();
    if (bench.member(0).send(utterance.signal(), due) != bus::ports::LiveStatus::kDone) return "has no room";
    const bus::ports::MachineTime end = bus::ports::host_now();
    for (std::size_t member = 1; member < bench.members(); ++member) {
      std::optional<Duration> late;
      const auto received = await(bench, member);
      if (!received || !utterance.is(*received)) return "hears something else";
      late = received->late;
      if (!late) {
        const auto follow_up = await(bench, member, [&] { bench.member(0).receive(); });
        if (follow_up && follow_up->kind == bus::ports::LiveArrival::Kind::kFollowUp) late = follow_up->late;
      }
      if (!late) return "is not told how late it left";
      if (*late < begin - due || *late > end - due)
        return fmt::format("left {} to {} ns late, is told {}", (begin - due).ns, (end - due).ns, late->ns);
    }
  }
  return {};
}

}  // namespace ttf::laws
