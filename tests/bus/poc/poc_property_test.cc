// Protocol operation control under random events: its invariants. Half the events are drawn from a
// controller's possible reports in the state, so that every state is visited. The others are drawn from all.
#include <algorithm>
#include <map>
#include <set>

#include "core/random.h"
#include "recording/records/enumerations.h"
#include "tests/bus/poc/poc_script.h"

namespace ttf::bus::poc {
namespace {

constexpr int kSeeds = 200;
constexpr int kEvents = 5'000;

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : stream_({.seed = seed, .purpose = Purpose::kTest}) {}

  bool chance(double p) { return stream_.uniform() < p; }
  int number(int low, int high) { return static_cast<int>(stream_.integer(low, high)); }

  PocParameters parameters() {
    PocParameters p;
    p.pKeySlotUsedForStartup = chance(0.7);
    p.pKeySlotOnlyEnabled = chance(0.3);
    p.gColdStartAttempts = number(2, 31);
    p.gMaxWithoutClockCorrectionPassive = number(1, 15);
    p.gMaxWithoutClockCorrectionFatal = number(p.gMaxWithoutClockCorrectionPassive, 15);
    p.pAllowPassiveToActive = number(0, 31);
    p.pAllowHaltDueToClock = chance(0.5);
    return p;
  }

  PocEvent event(const PocState& state, int& cycle) {
    const Event kind = chance(0.6) ? likely(state) : kAllPocEventKinds[pick(kAllPocEventKinds.size())];
    PocEvent event{kind};
    switch (kind) {
      case Event::kStartupFrame:
        return PocEvent::startup_frame(chance(0.8) && state.reference != 0 ? state.reference : number(1, 15),
                                       number(0, 63));
      case Event::kClockCorrected: return PocEvent::clock_corrected(chance(0.15), chance(0.05));
      case Event::kCycleStarted: {
        cycle = (cycle + 1) % 64;
        StartupFramesSeen seen;
        seen.frames = chance(0.1) ? 0 : number(1, 4);
        seen.pairs = number(0, seen.frames);
        seen.reference_frame = seen.frames > 0 && chance(0.8);
        seen.reference_pair = seen.pairs > 0 && seen.reference_frame && chance(0.9);
        return PocEvent::cycle_started(cycle, seen);
      }
      case Event::kPowerOn:
      case Event::kFreeze:
      case Event::kFatalError: return chance(0.1) ? event : PocEvent{Event::kChannelsIdle};  // else no state lasts
      default: return event;
    }
  }

 private:
  std::size_t pick(std::size_t size) { return static_cast<std::size_t>(number(0, static_cast<int>(size) - 1)); }

  Event likely(const PocState& state) {
    switch (state.kind) {
      case Kind::kDefaultConfig:
      case Kind::kHalt: return Event::kConfig;
      case Kind::kConfig: return Event::kConfigComplete;
      case Kind::kReady: return chance(0.5) ? Event::kAllowColdstart : chance(0.2) ? Event::kWakeup : Event::kRun;
      case Kind::kWakeupListen: return Event::kListenTimeout;
      case Kind::kWakeupSend: return chance(0.5) ? Event::kWakeupCollision : Event::kWakeupSent;
      case Kind::kWakeupDetect: return Event::kWakeupPatternReceived;
      case Kind::kColdstartListen: return chance(0.5) ? Event::kListenTimeout : Event::kStartupFrame;
      case Kind::kIntegrationListen:
      case Kind::kInitialiseSchedule: return Event::kStartupFrame;
      default: return chance(0.5) ? Event::kClockCorrected : Event::kCycleStarted;
    }
  }

  RandomStream stream_;
};

// Calls check(parameters, before, event, step) for every step of every seed's run.
template <class Check> void walk(Check check) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Draws draws(seed);
    const PocParameters parameters = draws.parameters();
    PocState state = poc_power_on(parameters);
    int cycle = -1;
    for (int i = 0; i < kEvents; ++i) {
      const PocEvent event = draws.event(state, cycle);
      const PocStep step = poc_step(parameters, state, event);
      check(parameters, state, event, step);
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << "seed " << seed << ", event " << i << ": " << to_text(event.kind) << " in "
                      << to_text(state.kind);
        return;
      }
      state = step.next;
    }
  }
}

TEST(PocProperties, TheWalksReachEveryStateFromMoreThanOneSide) {
  std::map<Kind, std::set<Kind>> entered_from;
  walk([&](const PocParameters&, const PocState& before, const PocEvent&, const PocStep& step) {
    if (step.next.kind != before.kind) entered_from[step.next.kind].insert(before.kind);
  });
  EXPECT_EQ(entered_from.size(), kAllPocKinds.size());
  EXPECT_EQ(entered_from[Kind::kNormalActive].size(), 4u);  // three ways of starting up, and back from passive
  EXPECT_EQ(entered_from[Kind::kHalt].size(), kAllPocKinds.size() - 1);
}

TEST(PocProperties, NormalActiveOnlyThroughStartup) {
  std::vector<Kind> way;  // since the last listen state
  int cycle_starts = 0;
  walk([&](const PocParameters& p, const PocState& before, const PocEvent& event, const PocStep& step) {
    if (event.kind == Event::kCycleStarted) ++cycle_starts;
    if (step.next.kind == before.kind) return;
    if (!in_startup(before.kind) || before.kind == Kind::kColdstartListen || before.kind == Kind::kIntegrationListen) {
      way = {before.kind};
      cycle_starts = event.kind == Event::kCycleStarted;
    }
    way.push_back(step.next.kind);
    if (step.next.kind == Kind::kNormalPassive) {
      EXPECT_EQ(before.kind, Kind::kNormalActive);
    }
    if (step.next.kind != Kind::kNormalActive || before.kind == Kind::kNormalPassive) return;
    ASSERT_TRUE(in_startup(before.kind));
    EXPECT_EQ(event.kind, Event::kCycleStarted);
    // The gap may have been passed any number of times.
    std::vector<Kind> leading{Kind::kColdstartListen, Kind::kColdstartCollisionResolution};
    while (way.size() > leading.size() + 2) {
      leading.insert(leading.end(),
                     {Kind::kColdstartConsistencyCheck, Kind::kColdstartGap, Kind::kColdstartCollisionResolution});
    }
    leading.insert(leading.end(), {Kind::kColdstartConsistencyCheck, Kind::kNormalActive});
    const std::vector<Kind> following{way.front(), Kind::kInitialiseSchedule, Kind::kIntegrationColdstartCheck,
                                      Kind::kColdstartJoin, Kind::kNormalActive};
    const std::vector<Kind> integrating{Kind::kIntegrationListen, Kind::kInitialiseSchedule,
                                        Kind::kIntegrationConsistencyCheck, Kind::kNormalActive};
    if (!p.pKeySlotUsedForStartup) {
      EXPECT_EQ(way, integrating);
      EXPECT_GE(cycle_starts, 5);  // 2 and then four whole cycles
    } else if (way.size() > 1 && way[1] == Kind::kInitialiseSchedule) {
      EXPECT_EQ(way, following);
      EXPECT_GE(cycle_starts, 6);  // 2..7
    } else {
      EXPECT_EQ(way, leading);
      EXPECT_GE(cycle_starts, 7);  // 0..6
    }
  });
}

TEST(PocProperties, AttemptsAreRefilledByRunAndConfigurationOnly) {
  bool exhausted = false;
  walk([&](const PocParameters& p, const PocState& before, const PocEvent& event, const PocStep& step) {
    const int left = step.next.vRemainingColdstartAttempts;
    EXPECT_GE(left, 0);
    EXPECT_LE(left, p.gColdStartAttempts);
    if (left == 0) exhausted = true;
    if (left > before.vRemainingColdstartAttempts) {
      EXPECT_EQ(left, p.gColdStartAttempts);
      EXPECT_TRUE((event.kind == Event::kRun && before.kind == Kind::kReady) || event.kind == Event::kConfig ||
                  event.kind == Event::kPowerOn);
    }
    const bool attempt = step.next.kind == Kind::kColdstartGap ||
                         (before.kind == Kind::kColdstartListen && step.actions.has(PocAction::kSendCas));
    if (before.kind != step.next.kind && attempt) {
      EXPECT_EQ(left, before.vRemainingColdstartAttempts - 1);
    }
    if (step.next.kind == Kind::kColdstartListen) {
      EXPECT_TRUE(p.pKeySlotUsedForStartup);
      EXPECT_FALSE(step.next.vColdstartInhibit);
      EXPECT_GT(left, 1);
    }
    if (step.consequence == PocReason::kAttemptsExhausted) {
      EXPECT_LE(left, 1);
    }
  });
  EXPECT_TRUE(exhausted);
}

TEST(PocProperties, HaltIsLeftByConfigurationOrPowerOnOnly) {
  walk([](const PocParameters& p, const PocState& before, const PocEvent& event, const PocStep& step) {
    if (before.kind != Kind::kHalt || step.next.kind == Kind::kHalt) return;
    EXPECT_TRUE(event.kind == Event::kConfig || event.kind == Event::kPowerOn) << to_text(event.kind);
    EXPECT_EQ(step.next, poc_power_on(p));
  });
}

TEST(PocProperties, FreezeReachesHaltFromAnywhere) {
  walk([](const PocParameters& p, const PocState& before, const PocEvent&, const PocStep&) {
    for (const Event kind : {Event::kFreeze, Event::kFatalError}) {
      const PocStep step = poc_step(p, before, PocEvent{kind});
      EXPECT_EQ(step.next.kind, Kind::kHalt);
      EXPECT_TRUE(step.next.frozen);
      if (!before.frozen) {
        EXPECT_EQ(step.next.halted_from, before.kind);
      }
      EXPECT_EQ(mac_mode(step.next), MacMode::kNothing);
    }
  });
}

TEST(PocProperties, CountersStayWithinBounds) {
  int largest_failed = 0;
  walk([&](const PocParameters& p, const PocState&, const PocEvent&, const PocStep& step) {
    const PocState& s = step.next;
    EXPECT_GE(s.vClockCorrectionFailed, 0);
    EXPECT_LE(s.vClockCorrectionFailed, kMaxClockCorrectionFailed);
    largest_failed = std::max(largest_failed, s.vClockCorrectionFailed);
    EXPECT_GE(s.vAllowPassiveToActive, 0);
    EXPECT_LE(s.vAllowPassiveToActive, std::max(0, p.pAllowPassiveToActive - 1));
    if (s.kind != Kind::kNormalPassive && s.kind != Kind::kHalt) {
      EXPECT_EQ(s.vAllowPassiveToActive, 0);
    }
    if (in_startup(s.kind)) {
      EXPECT_EQ(s.vClockCorrectionFailed, 0);
    }
    EXPECT_GE(s.cycles, 0);
    EXPECT_LE(s.cycles, 6);
    EXPECT_LE(s.good_double_cycles, 1);
    if (s.halt_requested || s.ready_requested) {
      EXPECT_TRUE(s.kind == Kind::kNormalActive || s.kind == Kind::kNormalPassive || s.kind == Kind::kHalt);
    }
  });
  EXPECT_GT(largest_failed, 3);
}

TEST(PocProperties, OnlyFollowersHaveAReferenceInStartup) {
  walk([](const PocParameters&, const PocState&, const PocEvent&, const PocStep& step) {
    switch (step.next.kind) {
      case Kind::kInitialiseSchedule:
      case Kind::kIntegrationColdstartCheck:
      case Kind::kIntegrationConsistencyCheck:
      case Kind::kColdstartJoin: EXPECT_NE(step.next.reference, 0); break;
      case Kind::kDefaultConfig:
      case Kind::kConfig:
      case Kind::kReady:
      case Kind::kColdstartListen:
      case Kind::kIntegrationListen:
      case Kind::kColdstartCollisionResolution:
      case Kind::kColdstartConsistencyCheck:
      case Kind::kColdstartGap: EXPECT_EQ(step.next.reference, 0); break;
      default: break;
    }
  });
}

TEST(PocProperties, TheSameInputsGiveTheSameStep) {
  walk([](const PocParameters& p, const PocState& before, const PocEvent& event, const PocStep& step) {
    const PocStep again = poc_step(p, before, event);
    EXPECT_EQ(again.next, step.next);
    EXPECT_EQ(again.actions, step.actions);
    EXPECT_EQ(again.reason, step.reason);
    EXPECT_EQ(again.consequence, step.consequence);
  });
}

}  // namespace
}  // namespace ttf::bus::poc
