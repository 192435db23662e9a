// The answers of protocol operation control: every pair of state and event, listed once. The compiler proves
// that each pair has exactly one answer.
#include <array>
#include <cstdint>
#include <initializer_list>

#include "bus/poc/states.h"
#include "core/check.h"

namespace ttf::bus::poc {
namespace {

// ---- sets of states and of events

constexpr std::size_t position(PocKind kind) {
  std::size_t at = 0;
  while (at < kAllPocKinds.size() && kAllPocKinds[at] != kind) ++at;
  return at;
}
constexpr std::size_t position(PocEventKind kind) { return static_cast<std::size_t>(kind); }

template <class Kind> class SetOf {
 public:
  constexpr SetOf(Kind one) : SetOf({one}) {}
  constexpr SetOf(std::initializer_list<Kind> some) {
    for (const Kind one : some) bits_ |= std::uint32_t{1} << position(one);
  }
  constexpr bool has(std::size_t at) const { return (bits_ >> at & 1u) != 0; }
  friend constexpr SetOf operator|(SetOf a, SetOf b) {
    a.bits_ |= b.bits_;
    return a;
  }

 private:
  std::uint32_t bits_ = 0;
};
using States = SetOf<PocKind>;
using Events = SetOf<PocEventKind>;

using K = PocKind;
using E = PocEventKind;
using R = PocReason;
using A = PocAction;

constexpr States kNotHalted{K::kDefaultConfig, K::kConfig, K::kReady};
constexpr States kDeaf = kNotHalted | K::kHalt;
constexpr States kWaking{K::kWakeupListen, K::kWakeupSend, K::kWakeupDetect};
constexpr States kLeading{K::kColdstartCollisionResolution, K::kColdstartConsistencyCheck, K::kColdstartGap};
constexpr States kFollowing{K::kInitialiseSchedule, K::kIntegrationColdstartCheck, K::kColdstartJoin,
                            K::kIntegrationConsistencyCheck};
constexpr States kListening{K::kColdstartListen, K::kIntegrationListen};
constexpr States kStarting = kListening | kLeading | kFollowing;
constexpr States kNormal{K::kNormalActive, K::kNormalPassive};
constexpr States kAtWork = kWaking | kStarting | kNormal;
// States that check all startup frames at the end of each cycle.
constexpr States kChecking{K::kColdstartConsistencyCheck, K::kIntegrationColdstartCheck, K::kColdstartJoin,
                           K::kIntegrationConsistencyCheck};

// ---- answers given by their arguments alone

template <PocReason why> PocStep ignores(const Now& now) { return ignore(now, why); }

template <PocReason why, PocAction action> PocStep stays(const Now& now) { return stay(now, why, action); }

template <PocKind kind, PocReason why, PocAction... actions> PocStep enters(const Now& now) {
  return enter(now, kind, why, (PocActions() | ... | PocActions(actions)));
}

template <PocStep (*step)(const ttf::bus::poc::Now&, ttf::bus::poc::PocReason), PocReason why>
PocStep does(const Now& now) {
  return step(now, why);
}

template <WakeupStatus status, PocReason why> PocStep ends_wakeup(const Now& now) {
  return end_wakeup(now, status, why);
}

// ---- the table

struct Rule {
  States states;
  Events events;
  Answer answer;
};

constexpr Rule kRules[] = {
    // Power supply, errors, and commands with the same answer in many states.
    {kDeaf | kAtWork, E::kPowerOn, power_on},
    {kNotHalted | kAtWork, E::kFreeze, does<freeze, R::kFreezeCommand>},
    {kNotHalted | kAtWork, E::kFatalError, does<freeze, R::kFatalError>},
    {kWaking | kStarting, E::kReady, does<ready, R::kReadyCommand>},
    {K::kReady | kWaking | kFollowing | kNormal, E::kAllowColdstart, allow_coldstart},

    // Receiver off, until the host commands otherwise.
    {K::kDefaultConfig, E::kConfig, enters<K::kConfig, R::kConfigCommand>},
    {K::kConfig, E::kConfigComplete, does<ready, R::kConfigured>},
    {K::kReady, E::kConfig, configure_again},
    {K::kReady, E::kRun, run},
    {K::kReady, E::kWakeup, wake},
    {K::kHalt, E::kConfig, leave_halt},
    {K::kHalt, E::kFreeze, does<freeze_halted, R::kFreezeCommand>},
    {K::kHalt, E::kFatalError, does<freeze_halted, R::kFatalError>},

    // Wake-up.
    {K::kWakeupListen, E::kChannelActive, stays<R::kListenTimerStopped, A::kStopListenTimer>},
    {K::kWakeupListen, E::kChannelsIdle, stays<R::kListenTimerRestarted, A::kRestartListenTimer>},
    {K::kWakeupListen, E::kWakeupPatternReceived,
     ends_wakeup<WakeupStatus::kReceivedPattern, R::kWakeupPatternReceived>},
    {K::kWakeupListen, E::kHeaderReceived, ends_wakeup<WakeupStatus::kReceivedHeader, R::kWakeupHeaderReceived>},
    {K::kWakeupListen, E::kListenTimeout, enters<K::kWakeupSend, R::kWakeupAfterSilence, A::kSendWakeupPattern>},
    {K::kWakeupListen, E::kNoiseTimeout, enters<K::kWakeupSend, R::kWakeupAfterNoise, A::kSendWakeupPattern>},
    {K::kWakeupSend, E::kWakeupSent, ends_wakeup<WakeupStatus::kTransmitted, R::kWakeupSent>},
    {K::kWakeupSend, E::kWakeupCollision, enters<K::kWakeupDetect, R::kWakeupCollision, A::kRestartListenTimer>},
    {K::kWakeupDetect, E::kWakeupPatternReceived,
     ends_wakeup<WakeupStatus::kCollisionPattern, R::kCollisionWithPattern>},
    {K::kWakeupDetect, E::kHeaderReceived, ends_wakeup<WakeupStatus::kCollisionHeader, R::kCollisionWithHeader>},
    {K::kWakeupDetect, E::kListenTimeout, ends_wakeup<WakeupStatus::kCollisionUnknown, R::kCollisionUnexplained>},

    // The leading coldstart node. A CAS or a header is no noise: another node starts or runs the cluster. A
    // leading node that receives one gives way, so that one leader remains.
    {K::kColdstartListen, E::kStartupFrame, derive_schedule},
    {K::kColdstartListen, E::kListenTimeout, does<attempt_coldstart, R::kColdstartAfterSilence>},
    {K::kColdstartListen, E::kNoiseTimeout, does<attempt_coldstart, R::kColdstartAfterNoise>},
    {K::kColdstartListen, E::kChannelActive, stays<R::kListenTimerStopped, A::kStopListenTimer>},
    {K::kColdstartListen, E::kChannelsIdle, stays<R::kListenTimerRestarted, A::kRestartListenTimer>},
    {K::kColdstartListen, {E::kCasReceived, E::kHeaderReceived}, stays<R::kNoiseTimerRestarted, A::kRestartNoiseTimer>},
    {K::kColdstartCollisionResolution, E::kCasReceived, does<listen, R::kCollisionCas>},
    {K::kColdstartCollisionResolution, E::kHeaderReceived, does<listen, R::kCollisionHeader>},
    {K::kColdstartCollisionResolution, E::kCycleStarted, resolution_cycle},
    {K::kColdstartConsistencyCheck, E::kClockCorrected, note_clock},
    {K::kColdstartConsistencyCheck, E::kCycleStarted, consistency_cycle},
    {K::kColdstartGap, E::kCasReceived, does<listen, R::kGapCas>},
    {K::kColdstartGap, E::kHeaderReceived, does<listen, R::kGapHeader>},
    // Entering the gap has taken the attempt off.
    {K::kColdstartGap, E::kCycleStarted, enters<K::kColdstartCollisionResolution, R::kGapOver, A::kSendCas>},

    // Nodes that take their schedule from another node.
    {K::kIntegrationListen, E::kAllowColdstart, allow_coldstart_listening},
    {K::kIntegrationListen, E::kStartupFrame, derive_schedule},
    {K::kInitialiseSchedule, E::kStartupFrame, second_frame},
    {K::kInitialiseSchedule, E::kScheduleNotDerived, does<listen, R::kScheduleNotDerived>},
    {K::kIntegrationColdstartCheck, E::kClockCorrected, note_clock_of_whole_cycles},
    {K::kIntegrationColdstartCheck, E::kCycleStarted, coldstart_check_cycle},
    {K::kColdstartJoin, E::kClockCorrected, note_clock},
    {K::kColdstartJoin, E::kCycleStarted, join_cycle},
    {K::kIntegrationConsistencyCheck, E::kClockCorrected, note_clock_of_whole_cycles},
    {K::kIntegrationConsistencyCheck, E::kCycleStarted, integration_cycle},

    // Normal operation.
    {kNormal, E::kHalt, request_halt},
    {kNormal, E::kReady, request_ready},
    {kNormal, E::kAllSlots, request_all_slots},
    {kNormal, E::kClockCorrected, count_clock},
    {K::kNormalActive, E::kCycleStarted, active_cycle},
    {K::kNormalPassive, E::kCycleStarted, passive_cycle},

    // Commands that the state does not accept. A coldstart node that listens or leads has coldstart allowed already.
    {K::kConfig | kAtWork, E::kConfig, ignores<R::kCommandNotAccepted>},
    {States{K::kDefaultConfig, K::kReady, K::kHalt} | kAtWork, E::kConfigComplete, ignores<R::kCommandNotAccepted>},
    {kDeaf, E::kReady, ignores<R::kCommandNotAccepted>},
    {States{K::kDefaultConfig, K::kConfig, K::kHalt} | kAtWork, {E::kRun, E::kWakeup}, ignores<R::kCommandNotAccepted>},
    {States{K::kDefaultConfig, K::kConfig, K::kHalt, K::kColdstartListen} | kLeading, E::kAllowColdstart,
     ignores<R::kCommandNotAccepted>},
    {kDeaf | kWaking | kStarting, {E::kAllSlots, E::kHalt}, ignores<R::kCommandNotAccepted>},

    // Receptions without meaning. While it sends, a node detects nothing but a collision.
    {kDeaf | K::kWakeupSend,
     {E::kChannelActive, E::kChannelsIdle, E::kCasReceived, E::kWakeupPatternReceived, E::kHeaderReceived,
      E::kStartupFrame},
     ignores<R::kReceiverOff>},
    {States{K::kWakeupDetect, K::kIntegrationListen} | kLeading | kFollowing | kNormal,
     {E::kChannelActive, E::kChannelsIdle},
     ignores<R::kNoTimerOnChannel>},
    {States{K::kWakeupListen, K::kWakeupDetect, K::kColdstartConsistencyCheck, K::kIntegrationListen} | kFollowing |
         kNormal,
     E::kCasReceived, ignores<R::kSymbolWithoutMeaning>},
    {kStarting | kNormal, E::kWakeupPatternReceived, ignores<R::kNoWakeupWanted>},
    {kChecking, {E::kHeaderReceived, E::kStartupFrame}, ignores<R::kJudgedAtCycleEnd>},
    {States{K::kIntegrationListen, K::kInitialiseSchedule} | kNormal, E::kHeaderReceived,
     ignores<R::kHeaderWithoutMeaning>},
    {kNormal, E::kStartupFrame, ignores<R::kHeaderWithoutMeaning>},
    {{K::kWakeupListen, K::kWakeupDetect, K::kColdstartCollisionResolution, K::kColdstartGap},
     E::kStartupFrame,
     ignores<R::kHeaderCameFirst>},

    // Events of a timer, a wake-up or a schedule that the state does not run.
    {States{K::kWakeupSend, K::kIntegrationListen} | kDeaf | kLeading | kFollowing | kNormal, E::kListenTimeout,
     ignores<R::kNoTimerRunning>},
    // Only the listen timer bounds the search for the cause of a collision with the pattern.
    {States{K::kWakeupSend, K::kWakeupDetect, K::kIntegrationListen} | kDeaf | kLeading | kFollowing | kNormal,
     E::kNoiseTimeout, ignores<R::kNoTimerRunning>},
    {States{K::kWakeupListen, K::kWakeupDetect} | kDeaf | kStarting | kNormal,
     {E::kWakeupSent, E::kWakeupCollision},
     ignores<R::kNotSendingWakeup>},
    {States{K::kIntegrationColdstartCheck, K::kColdstartJoin, K::kIntegrationConsistencyCheck} | kDeaf | kWaking |
         kListening | kLeading | kNormal,
     E::kScheduleNotDerived, ignores<R::kNotDerivingSchedule>},
    {kDeaf | kWaking | kListening, {E::kClockCorrected, E::kCycleStarted}, ignores<R::kNoSchedule>},
    {K::kInitialiseSchedule, {E::kClockCorrected, E::kCycleStarted}, ignores<R::kNotYetWholeCycle>},
    {{K::kColdstartCollisionResolution, K::kColdstartGap}, E::kClockCorrected, ignores<R::kOwnClockOnly>},
};

// ---- from the rules to the table

constexpr std::size_t kStateCount = kAllPocKinds.size(), kEventCount = kAllPocEventKinds.size();
static_assert(kStateCount <= 32 && kEventCount <= 32, "sets have 32 bits");

struct Table {
  std::array<std::array<Answer, kEventCount>, kStateCount> answers{};
  int pairs = 0;       // counted from the rules
  bool twice = false;  // a pair is listed more than once
};

constexpr Table made_of(const auto& rules) {
  Table table;
  for (const Rule& rule : rules)
    for (std::size_t state = 0; state < kStateCount; ++state)
      for (std::size_t event = 0; event < kEventCount; ++event) {
        if (!rule.states.has(state) || !rule.events.has(event)) continue;
        Answer& answer = table.answers[state][event];
        table.twice = table.twice || answer != nullptr;
        answer = rule.answer;
        ++table.pairs;
      }
  return table;
}

constexpr Table kTable = made_of(kRules);
static_assert(!kTable.twice, "a pair of state and event has two answers");
static_assert(kTable.twice || kTable.pairs == int{kStateCount * kEventCount},
              "a pair of state and event has no answer");

// The row of a state in the table, by its code.
constexpr std::size_t kCodes = 64;
constexpr auto kRows = [] {
  std::array<std::uint8_t, kCodes> rows{};
  for (std::size_t code = 0; code < kCodes; ++code)
    rows[code] = static_cast<std::uint8_t>(position(static_cast<PocKind>(code)));
  return rows;
}();

}  // namespace

Answer answer(PocKind state, PocEventKind event) {
  const auto code = static_cast<std::size_t>(state);
  TTF_CHECK(code < kCodes && kRows[code] < kStateCount && position(event) < kEventCount, "state {}, event {}", code,
            position(event));
  return kTable.answers[kRows[code]][position(event)];
}

}  // namespace ttf::bus::poc
