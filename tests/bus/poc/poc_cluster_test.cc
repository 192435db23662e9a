// Whole clusters of protocol operation controls on a perfect bus: start-up emerges without knowledge of the
// other nodes. Time is counted in static slots. Oscillators are perfect, there is one channel, propagation
// takes no time. The last slot of a cycle is the NIT. So only the POC is under test, driven as by a
// controller.
#include <algorithm>
#include <optional>
#include <set>

#include "core/random.h"
#include "tests/bus/poc/poc_script.h"

namespace ttf::bus::poc {
namespace {

struct Frame {
  int id = 0;
  int cycle = 0;
  bool startup = false;
};

class Node {
 public:
  Node(const PocParameters& parameters, int key_slot, int power_on, int cycle_slots)
      : power_on_(power_on), poc_(parameters), key_slot_(key_slot), cycle_slots_(cycle_slots) {}

  // The beginning of slot `now`: timers and cycle starts. Returns the signal sent in the slot.
  void begin(int now) {
    if (now < power_on_) return;
    if (now == power_on_) {
      apply({Event::kConfig}, now);
      apply({Event::kConfigComplete}, now);
      apply({Event::kAllowColdstart}, now);
      apply({Event::kRun}, now);
    }
    if (has_clock_ && ++slot_ > cycle_slots_) start_cycle(now);
    if (listen_until_ == now) apply({Event::kListenTimeout}, now);
    if (noise_until_ == now) apply({Event::kNoiseTimeout}, now);
    if (poc_.state.kind == Kind::kInitialiseSchedule && now > derived_at_ + cycle_slots_)
      apply({Event::kScheduleNotDerived}, now);
  }

  bool sends_cas(int now) const { return cas_at_ == now; }
  std::optional<Frame> sends() const {
    if (!has_clock_ || slot_ != key_slot_ || mac_mode(poc_.state) == MacMode::kNothing) return std::nullopt;
    return Frame{key_slot_, cycle_ % 64, poc_.parameters.pKeySlotUsedForStartup};
  }

  // The end of the slot, for nodes that did not send in it.
  void receive_cas(int now) {
    if (now < power_on_) return;
    apply({Event::kChannelActive}, now);
    apply({Event::kCasReceived}, now);
    apply({Event::kChannelsIdle}, now);
  }
  void receive_noise(int now) {
    if (now < power_on_) return;
    apply({Event::kChannelActive}, now);
    apply({Event::kChannelsIdle}, now);
  }
  void receive(const Frame& frame, int now) {
    if (now < power_on_) return;
    apply({Event::kChannelActive}, now);
    apply({Event::kHeaderReceived}, now);
    if (frame.startup) {
      const Kind before = poc_.state.kind;
      apply(PocEvent::startup_frame(frame.id, frame.cycle), now);
      if (before == Kind::kInitialiseSchedule && poc_.state.kind != before) {
        has_clock_ = true;
        slot_ = frame.id;
        cycle_ = frame.cycle;
        seen_ = {};
      }
      if (has_clock_ && slot_ == frame.id && cycle_ % 64 == frame.cycle)
        seen_[static_cast<std::size_t>(frame.cycle % 2)].insert(frame.id);
    }
    apply({Event::kChannelsIdle}, now);
  }

  Kind kind() const { return poc_.state.kind; }
  int active_in() const { return active_in_; }  // cycle, -1: not yet
  bool exhausted() const { return exhausted_; }
  int cycle() const { return has_clock_ ? cycle_ : -1; }
  int slot() const { return slot_; }

 private:
  void start_cycle(int now) {
    const std::set<int>& even = seen_[0];
    const std::set<int>& odd = seen_[1];
    const std::set<int>& last = cycle_ % 2 == 0 ? even : odd;
    const int reference = poc_.state.reference;
    StartupFramesSeen ended;
    ended.frames = static_cast<int>(last.size());
    ended.pairs = static_cast<int>(std::count_if(even.begin(), even.end(), [&](int id) { return odd.contains(id); }));
    ended.reference_frame = last.contains(reference);
    ended.reference_pair = even.contains(reference) && odd.contains(reference);
    const bool own = poc_.parameters.pKeySlotUsedForStartup && mac_mode(poc_.state) != MacMode::kNothing;
    if (cycle_ >= 0 && cycle_ % 2 != 0) apply(PocEvent::clock_corrected(!own && ended.pairs == 0, false), now);
    ++cycle_;
    slot_ = 1;
    seen_[static_cast<std::size_t>(cycle_ % 2)].clear();
    if (cycle_ % 2 == 0) seen_[1].clear();
    apply(PocEvent::cycle_started(cycle_ % 64, ended), now);
  }

  void apply(const PocEvent& event, int now) {
    const Kind before = poc_.state.kind;
    poc_.apply(event);
    const PocActions actions = poc_.last.actions;
    if (actions.has(PocAction::kStopTimers)) listen_until_ = noise_until_ = -1;
    if (actions.has(PocAction::kDropSchedule)) has_clock_ = false;
    if (actions.has(PocAction::kStopListenTimer)) listen_until_ = -1;
    // Two cycles as pdListenTimeout; timers restarted at the end of a slot begin with the next one.
    if (actions.has(PocAction::kRestartListenTimer)) listen_until_ = now + 2 * cycle_slots_ + 1;
    if (actions.has(PocAction::kRestartNoiseTimer)) noise_until_ = now + 4 * cycle_slots_ + 1;
    if (actions.has(PocAction::kSendCas)) {  // in this slot; cycle 0 begins with the next
      cas_at_ = now;
      has_clock_ = true;
      cycle_ = -1;
      slot_ = cycle_slots_;
      seen_ = {};
    }
    if (actions.has(PocAction::kDeriveSchedule)) derived_at_ = now;
    if (before != poc_.state.kind && poc_.state.kind == Kind::kNormalActive) active_in_ = cycle_;
    exhausted_ |= poc_.last.consequence == PocReason::kAttemptsExhausted;
  }

  int power_on_;
  PocScript poc_;
  int key_slot_;
  int cycle_slots_;
  bool has_clock_ = false;
  int slot_ = 0;
  int cycle_ = 0;
  std::array<std::set<int>, 2> seen_;  // startup frames of the even and the odd cycle
  int listen_until_ = -1, noise_until_ = -1, cas_at_ = -1, derived_at_ = -1;
  int active_in_ = -1;
  bool exhausted_ = false;
};

class Bus {
 public:
  // `power_on` by node; the first `coldstart_nodes` of them may start the cluster. Node i has the key slot i
  // + 1.
  Bus(const std::vector<int>& power_on, int coldstart_nodes, int attempts = 4)
      : cycle_slots(static_cast<int>(power_on.size()) + 2) {
    for (int i = 0; i < static_cast<int>(power_on.size()); ++i) {
      PocParameters parameters = i < coldstart_nodes ? coldstart_node() : other_node();
      parameters.gColdStartAttempts = attempts;
      nodes.emplace_back(parameters, i + 1, power_on[static_cast<std::size_t>(i)], cycle_slots);
    }
  }

  void run(int cycles) {
    for (int end = now + cycles * cycle_slots; now < end; ++now) {
      for (Node& node : nodes) node.begin(now);
      int frames = 0, symbols = 0;
      Frame frame;
      std::vector<bool> sent(nodes.size());
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].sends_cas(now)) ++symbols, sent[i] = true;
        if (const auto own = nodes[i].sends()) frame = *own, ++frames, sent[i] = true;
      }
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (sent[i] || frames + symbols == 0) continue;
        if (frames == 0)
          nodes[i].receive_cas(now);  // symbols over symbols are still one
        else if (frames + symbols == 1)
          nodes[i].receive(frame, now);
        else
          nodes[i].receive_noise(now);
      }
    }
  }

  bool all_active() const {
    return std::all_of(nodes.begin(), nodes.end(), [](const Node& n) { return n.kind() == Kind::kNormalActive; });
  }

  int cycle_slots;
  int now = 0;
  std::vector<Node> nodes;
};

void expect_one_schedule(const Bus& bus) {
  for (const Node& node : bus.nodes) {
    EXPECT_EQ(node.cycle(), bus.nodes[0].cycle());
    EXPECT_EQ(node.slot(), bus.nodes[0].slot());
  }
}

TEST(PocCluster, PoweredOnInTimeLeaderIn6FollowersIn7OthersIn8) {
  // The first listening node leads; all others are on before its cycle 0.
  Bus bus({9, 0, 14, 3, 5, 11}, 3);
  bus.run(12);
  ASSERT_TRUE(bus.all_active());
  EXPECT_EQ(bus.nodes[1].active_in(), 6);
  EXPECT_EQ(bus.nodes[0].active_in(), 7);
  EXPECT_EQ(bus.nodes[2].active_in(), 7);
  for (const std::size_t other : {3u, 4u, 5u}) EXPECT_EQ(bus.nodes[other].active_in(), 8);
  expect_one_schedule(bus);
}

TEST(PocCluster, SimultaneousSymbolsLeaveOneLeader) {
  // All three send the symbol in the same slot; the first startup frame decides.
  Bus bus({0, 0, 0, 0}, 3);
  bus.run(12);
  ASSERT_TRUE(bus.all_active());
  EXPECT_EQ(bus.nodes[0].active_in(), 6);
  EXPECT_EQ(bus.nodes[1].active_in(), 7);
  EXPECT_EQ(bus.nodes[2].active_in(), 7);
  EXPECT_EQ(bus.nodes[3].active_in(), 8);
}

TEST(PocCluster, RandomPowerOnInTimeGivesTheSameNumbers) {
  struct Case {
    int size, runs;
  };
  for (const auto [size, runs] : {Case{2, 2'000}, Case{4, 2'000}, Case{16, 500}, Case{64, 100}}) {
    RandomStream draw({.seed = static_cast<std::uint64_t>(size), .purpose = Purpose::kTest});
    const int coldstart = std::max(2, size / 4);
    const std::int64_t listen_timeout = 2 * (std::int64_t{size} + 2);  // [slots]
    for (int run = 0; run < runs; ++run) {
      std::vector<int> power_on(static_cast<std::size_t>(size));
      for (int& slot : power_on) slot = static_cast<int>(draw.integer(0, listen_timeout));
      power_on[static_cast<std::size_t>(draw.integer(0, coldstart - 1))] = 0;
      Bus bus(power_on, coldstart);
      bus.run(12);
      ASSERT_TRUE(bus.all_active()) << size << " nodes, run " << run;
      int leaders = 0;
      for (int i = 0; i < size; ++i) {
        const int active_in = bus.nodes[static_cast<std::size_t>(i)].active_in();
        if (active_in == 6 && i < coldstart)
          ++leaders;
        else
          EXPECT_EQ(active_in, i < coldstart ? 7 : 8) << size << " nodes, run " << run << ", node " << i;
      }
      EXPECT_EQ(leaders, 1) << size << " nodes, run " << run;
      expect_one_schedule(bus);
    }
  }
}

// A second coldstart node within the window of attempts starts the cluster with the first one. Beyond it, the
// first one's attempts are exhausted; it then follows the second one's attempt.
TEST(PocCluster, ASecondColdstartNodeWithinAndBeyondTheAttemptsWindow) {
  constexpr int kSlots = 6;  // 4 nodes, one free, the NIT
  constexpr int kListen = 2 * kSlots + 1;
  constexpr int kAttempt = 1 + 6 * kSlots;  // CAS, four cycles of resolution, one of check, one of gap
  constexpr int kLastSymbol = kListen + 3 * kAttempt;
  // To send in cycle 4 of an attempt, a node must receive the startup frame of cycle 0: the leader's slot is the
  // first one.
  constexpr int kLastFrame = kLastSymbol + 1;
  for (int late = 0; late <= kLastFrame + 2 * kAttempt; ++late) {
    Bus bus({0, late, late + 3, late + 40}, 2);
    bus.run(80);
    EXPECT_EQ(bus.nodes[0].exhausted(), late > kLastFrame) << "second node on in slot " << late;
    EXPECT_TRUE(bus.all_active()) << "second node on in slot " << late;
    expect_one_schedule(bus);
  }
}

TEST(PocCluster, ALoneColdstartNodeExhaustsItsAttempts) {
  Bus bus({0, 0, 0}, 1);
  bus.run(60);
  EXPECT_TRUE(bus.nodes[0].exhausted());
  for (const Node& node : bus.nodes) {
    EXPECT_EQ(node.active_in(), -1);
    EXPECT_EQ(node.kind(), Kind::kIntegrationListen);
  }
}

TEST(PocCluster, LateNodesJoinTheRunningCluster) {
  Bus bus({0, 2, 100, 171, 202}, 3);  // a coldstart node and two others come when the cluster runs
  bus.run(60);
  EXPECT_TRUE(bus.all_active());
  EXPECT_EQ(bus.nodes[0].active_in(), 6);
  EXPECT_EQ(bus.nodes[1].active_in(), 7);
  expect_one_schedule(bus);
}

}  // namespace
}  // namespace ttf::bus::poc
