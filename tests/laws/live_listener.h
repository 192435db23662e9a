// A member that sends and receives utterances (tests/laws/live_traffic.h) on a live medium, and notices errors
// in the received ones.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/ports/live_medium.h"
#include "tests/laws/live_traffic.h"

namespace ttf::laws {

class LiveBench {
 public:
  virtual ~LiveBench() = default;
  // The reason why this machine lacks such a medium; empty: it has one.
  virtual std::string missing() const { return {}; }
  // 2..16 members, who all receive each other already and have sent nothing yet. Each may have its own thread.
  virtual std::size_t members() const = 0;
  virtual bus::ports::LiveMedium& member(std::size_t index) = 0;
  // For each CAN whether it carries CAN FD.
  virtual std::vector<bool> can_buses() const = 0;
  // Every member is on both channels; at least two members are on every CAN.
  virtual bool on(std::size_t member, bus::ports::Line line) const = 0;

  enum class Intruder { kForeign, kMalformed };
  // Puts a foreign frame, or a malformed one in our form, on a line. Returns false if the medium has no such
  // frame.
  virtual bool intrude(bus::ports::Line line, Intruder what) = 0;
  // More signals than a member keeps without listening.
  virtual std::size_t flood() const = 0;
  // lost counts pieces of signals, so it may exceed the number of missing signals.
  virtual bool loses_pieces() const { return false; }

  // The longest way on a busy machine, and the time after which no signal is under way.
  virtual std::chrono::milliseconds patience() const { return std::chrono::seconds(10); }
  virtual std::chrono::milliseconds quiet() const { return std::chrono::milliseconds(200); }

  std::size_t lines() const { return bus::ports::line_of_can(can_buses().size()); }
  bool fast(bus::ports::Line line) const {
    return line >= bus::ports::line_of_can(0) && can_buses()[line - bus::ports::line_of_can(0)];
  }
  // All other members on the line.
  std::vector<std::size_t> others(std::size_t member, bus::ports::Line line) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < members(); ++i)
      if (i != member && on(i, line)) found.push_back(i);
    return found;
  }
};

inline constexpr auto kGlance = std::chrono::microseconds(50);  // between two looks

class LiveListener {
 public:
  LiveListener(LiveBench& bench, std::size_t self, Traffic traffic)
      : bench_(bench), self_(self), traffic_(traffic), next_(bench.lines(), std::vector<std::size_t>(bench.members())),
        missed_(next_), said_(bench.lines()) {}

  bus::ports::LiveMedium& medium() const { return bench_.member(self_); }
  std::size_t self() const { return self_; }
  // The first error; empty: no error.
  const std::string& wrong() const { return wrong_; }
  std::size_t said(bus::ports::Line line) const { return said_[line]; }
  std::size_t received(bus::ports::Line line, std::size_t from) const { return next_[line][from]; }
  std::size_t missed(bus::ports::Line line, std::size_t from) const { return missed_[line][from]; }
  std::uint64_t received() const { return received_; }
  std::uint64_t refused() const { return refused_; }

  // Sends the next utterance on this line, and retries while there is no room.
  void say(bus::ports::Line line) {
    const auto begin = std::chrono::steady_clock::now();
    while (!try_to_say(line) && wrong_.empty()) {
      if (std::chrono::steady_clock::now() - begin > bench_.patience()) return complain("never has room");
      std::this_thread::sleep_for(kGlance);
    }
  }
  // Once; whether there was room.
  bool try_to_say(bus::ports::Line line) {
    Utterance utterance(line, {self_, bench_.members()}, said_[line], traffic_, bench_.fast(line));
    const bus::ports::LiveStatus status = utterance.send(medium());
    utterance.scribble();  // L5
    if (status == bus::ports::LiveStatus::kDone) ++said_[line];
    if (status == bus::ports::LiveStatus::kNoRoom) ++refused_;
    if (status == bus::ports::LiveStatus::kFailed) complain("send fails: " + medium().failure());
    return status == bus::ports::LiveStatus::kDone;
  }

  // Receives the pending signals. `gaps`: some may be missing.
  void receive(bool gaps = false) {
    while (const auto arrival = medium().receive()) take(*arrival, gaps);
  }
  // Receives until `count` utterances of this member on this line have arrived with their lateness. `meanwhile`
  // runs members without a thread; some media follow up when their sender receives its frame's confirmation.
  void receive_until(
      bus::ports::Line line, std::size_t from, std::size_t count, bool gaps = false,
      const std::function<void()>& meanwhile = [] {}) {
    const auto begin = std::chrono::steady_clock::now();
    for (receive(gaps); next_[line][from] < count || waits_for_follow_up(line, from); meanwhile(), receive(gaps)) {
      if (!wrong_.empty()) return;
      if (std::chrono::steady_clock::now() - begin > bench_.patience())
        return complain(fmt::format("line {}: of member {} heard {} for {}{}", line, from, next_[line][from], count,
                                    next_[line][from] < count ? "" : ", but not how late they were"));
      std::this_thread::sleep_for(kGlance);
    }
  }
  // Receives until no signal comes any more.
  void receive_rest(bool gaps = false) {
    for (std::uint64_t before = ~std::uint64_t{0}; before != received_;) {
      before = received_;
      std::this_thread::sleep_for(bench_.quiet());
      receive(gaps);
    }
  }

  void complain(const std::string& what) {
    if (wrong_.empty()) wrong_ = fmt::format("member {}: {}", self_, what);
  }

 private:
  struct SyncFrame {
    int slot = 0;
    std::uint8_t cycle = 0;
    Duration late{};
  };

  void take(const bus::ports::LiveArrival& received, bool gaps) {
    const bus::ports::Line line = line_of(received);
    const std::size_t from = speaker_of(received, bench_.members());
    if (line >= bench_.lines() || !bench_.on(self_, line)) return complain(fmt::format("hears on line {}", line));
    if (from == self_) return complain(fmt::format("line {}: hears itself", line));
    if (from >= bench_.members()) return complain(fmt::format("line {}: hears what nobody said", line));
    if (received.kind == bus::ports::LiveArrival::Kind::kFollowUp) return take_follow_up(line, from, received);
    ++received_;
    std::size_t& next = next_[line][from];
    for (const std::size_t first = next;; ++next, ++missed_[line][from]) {
      const Utterance expected(line, {from, bench_.members()}, next, traffic_, bench_.fast(line));
      if (expected.is(received)) {
        ++next;
        return take_lateness(line, from, expected, received.late);
      }
      if (gaps && next < first + bench_.flood()) continue;
      return complain(fmt::format("line {}: what is heard of member {} is not its number {}", line, from, first));
    }
  }
  void take_lateness(bus::ports::Line line, std::size_t from, const Utterance& expected, std::optional<Duration> late) {
    if (late && !expected.late()) return complain("is told how late, of what is no sync frame");
    if (late) return check_lateness(*late, *expected.late());
    if (expected.late()) waiting_[{line, from}].push_back({expected.slot(), expected.cycle(), *expected.late()});
  }
  void take_follow_up(bus::ports::Line line, std::size_t from, const bus::ports::LiveArrival& received) {
    auto& waiting = waiting_[{line, from}];
    if (waiting.empty()) return complain(fmt::format("line {}: a follow-up of nothing from {}", line, from));
    const SyncFrame frame = waiting.front();
    waiting.pop_front();
    if (received.signal.slot != frame.slot || received.cycle_counter != frame.cycle || !received.late)
      return complain(fmt::format("line {}: a follow-up of slot {} in cycle {}, for slot {} in {}", line,
                                  received.signal.slot, received.cycle_counter, frame.slot, frame.cycle));
    check_lateness(*received.late, frame.late);
  }
  // It cannot be earlier than it was handed over.
  void check_lateness(Duration late, Duration least) {
    if (late < least || late > least + Duration::milliseconds(10'000))
      complain(fmt::format("is told that it left {} ns late, for at least {}", late.ns, least.ns));
  }
  bool waits_for_follow_up(bus::ports::Line line, std::size_t from) const {
    const auto found = waiting_.find({line, from});
    return found != waiting_.end() && !found->second.empty();
  }

  LiveBench& bench_;
  std::size_t self_;
  Traffic traffic_;
  std::vector<std::vector<std::size_t>> next_;  // by line and speaker: the number that is received next
  std::vector<std::vector<std::size_t>> missed_;
  std::map<std::pair<bus::ports::Line, std::size_t>, std::deque<SyncFrame>> waiting_;  // for their follow-up
  std::vector<std::size_t> said_;                                                      // by line
  std::uint64_t received_ = 0, refused_ = 0;
  std::string wrong_;
};

}  // namespace ttf::laws
