// Protocol operation control: every pair of state and event has its listed next state.
#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>

#include "recording/records/enumerations.h"
#include "tests/bus/poc/poc_script.h"

namespace ttf::bus::poc {
namespace {

struct Code {
  const char* code;
  Kind kind;
};
constexpr Code kCodes[] = {
    {"dc", Kind::kDefaultConfig},
    {"cf", Kind::kConfig},
    {"rd", Kind::kReady},
    {"ha", Kind::kHalt},
    {"wl", Kind::kWakeupListen},
    {"ws", Kind::kWakeupSend},
    {"wd", Kind::kWakeupDetect},
    {"cl", Kind::kColdstartListen},
    {"cr", Kind::kColdstartCollisionResolution},
    {"cc", Kind::kColdstartConsistencyCheck},
    {"ga", Kind::kColdstartGap},
    {"cj", Kind::kColdstartJoin},
    {"il", Kind::kIntegrationListen},
    {"is", Kind::kInitialiseSchedule},
    {"ic", Kind::kIntegrationColdstartCheck},
    {"in", Kind::kIntegrationConsistencyCheck},
    {"na", Kind::kNormalActive},
    {"np", Kind::kNormalPassive},
};

Kind kind_of(const std::string& code) {
  for (const Code& entry : kCodes)
    if (code == entry.code) return entry.kind;
  ADD_FAILURE() << "no state " << code;
  return Kind::kHalt;
}

// The columns: every event, those that carry something in several forms.
std::vector<PocEvent> columns(int next_cycle) {
  using E = Event;
  std::vector<PocEvent> events;
  for (const E kind : {E::kPowerOn, E::kConfig, E::kConfigComplete, E::kReady, E::kRun, E::kAllowColdstart, E::kWakeup,
                       E::kAllSlots, E::kHalt, E::kFreeze, E::kFatalError, E::kChannelActive, E::kChannelsIdle,
                       E::kCasReceived, E::kWakeupPatternReceived, E::kHeaderReceived})
    events.push_back(PocEvent{kind});
  events.push_back(PocEvent::startup_frame(kReference, 2));
  events.push_back(PocEvent::startup_frame(kReference, 3));
  events.push_back(PocEvent::startup_frame(kReference + 1, 3));
  for (const E kind :
       {E::kListenTimeout, E::kNoiseTimeout, E::kWakeupSent, E::kWakeupCollision, E::kScheduleNotDerived})
    events.push_back(PocEvent{kind});
  events.push_back(PocEvent::clock_corrected(false, false));
  events.push_back(PocEvent::clock_corrected(true, false));
  events.push_back(PocEvent::clock_corrected(false, true));
  events.push_back(PocEvent::cycle_started(next_cycle, kNobody));
  events.push_back(PocEvent::cycle_started(next_cycle, kTwoNodes));
  return events;
}

struct Row {
  const char* start;  // the state's code
  const char* what;
  PocParameters parameters;
  std::function<void(ttf::bus::poc::PocScript&)> lead;  // there
  const char* next;                                     // by column; "--" is the same state
};

PocParameters with_attempts(int attempts) {
  PocParameters parameters = coldstart_node();
  parameters.gColdStartAttempts = attempts;
  return parameters;
}

//   PO CF CC RD RN AC WK AS HL FZ FE  CA CI CS WP HD  even odd other  LT NT WS WC SN  clock  nobody two
const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {"dc", "after power-on", coldstart_node(), [](PocScript&) {},
       "dc cf -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"cf", "", coldstart_node(), [](PocScript& s) { s.apply(Event::kConfig); },
       "dc -- rd -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"rd", "inhibited", coldstart_node(), [](PocScript& s) { s.to_ready(); },
       "dc cf -- -- il -- wl -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"rd", "coldstart allowed", coldstart_node(), [](PocScript& s) { s.to_ready().apply(Event::kAllowColdstart); },
       "dc cf -- -- cl -- wl -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"rd", "no coldstart node", other_node(), [](PocScript& s) { s.to_ready().apply(Event::kAllowColdstart); },
       "dc cf -- -- il -- wl -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"wl", "", coldstart_node(), [](PocScript& s) { s.to_ready().apply(Event::kWakeup); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- rd rd  -- -- --  ws ws -- -- --  -- -- --  -- --"},
      {"ws", "", coldstart_node(),
       [](PocScript& s) { s.to_ready().apply(Event::kWakeup).apply(Event::kListenTimeout); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- rd wd --  -- -- --  -- --"},
      {"wd", "", coldstart_node(),
       [](PocScript& s) {
         s.to_ready().apply(Event::kWakeup).apply(Event::kNoiseTimeout).apply(Event::kWakeupCollision);
       },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- rd rd  -- -- --  rd -- -- -- --  -- -- --  -- --"},
      {"cl", "", coldstart_node(), [](PocScript& s) { s.to_listen(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  is -- --  cr cr -- -- --  -- -- --  -- --"},
      {"cr", "before cycle 0", coldstart_node(), [](PocScript& s) { s.to_collision_resolution(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- cl -- cl  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"cr", "in cycle 3", coldstart_node(), [](PocScript& s) { s.to_collision_resolution().cycles(4, kNobody); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- cl -- cl  -- -- --  -- -- -- -- --  -- -- --  cc cc"},
      {"cr", "last attempt but one", with_attempts(2), [](PocScript& s) { s.to_collision_resolution(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- il -- il  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"cc", "in cycle 4", coldstart_node(), [](PocScript& s) { s.to_consistency_check(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  ga --"},
      {"cc", "in cycle 5", coldstart_node(),
       [](PocScript& s) { s.to_consistency_check().cycle(kTwoNodes).correct_clock(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl na"},
      {"cc", "in cycle 5, without a verdict on the clock", coldstart_node(),
       [](PocScript& s) { s.to_consistency_check().cycle(kTwoNodes); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl cl"},
      {"cc", "no attempt left", with_attempts(2), [](PocScript& s) { s.to_gap().cycle().cycles(5, kNobody); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  il --"},
      {"ga", "", coldstart_node(), [](PocScript& s) { s.to_gap(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- cl -- cl  -- -- --  -- -- -- -- --  -- -- --  cr cr"},
      {"il", "no coldstart node", other_node(), [](PocScript& s) { s.to_listen(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  is -- --  -- -- -- -- --  -- -- --  -- --"},
      {"il", "inhibited", coldstart_node(), [](PocScript& s) { s.to_ready().apply(Event::kRun); },
       "dc -- -- rd -- cl -- -- -- ha ha  -- -- -- -- --  is -- --  -- -- -- -- --  -- -- --  -- --"},
      {"il", "attempts exhausted", with_attempts(2),
       [](PocScript& s) { s.to_collision_resolution().apply(Event::kCasReceived); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  is -- --  -- -- -- -- --  -- -- --  -- --"},
      {"is", "coldstart node", coldstart_node(), [](PocScript& s) { s.to_initialise_schedule(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- ic --  -- -- -- -- cl  -- -- --  -- --"},
      {"is", "no coldstart node", other_node(), [](PocScript& s) { s.to_initialise_schedule(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- in --  -- -- -- -- il  -- -- --  -- --"},
      {"ic", "in cycle 1", coldstart_node(), [](PocScript& s) { s.to_check(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"ic", "in cycle 2", coldstart_node(), [](PocScript& s) { s.to_check().cycle(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl --"},
      {"ic", "in cycle 3", coldstart_node(),
       [](PocScript& s) { s.to_check().cycle().cycle(kLeaderOnly).correct_clock(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl cj"},
      {"cj", "in cycle 4", coldstart_node(), [](PocScript& s) { s.to_join(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl --"},
      {"cj", "in cycle 5", coldstart_node(), [](PocScript& s) { s.to_join().cycle(kTwoNodes).correct_clock(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl --"},
      {"cj", "in cycle 6", coldstart_node(), [](PocScript& s) { s.to_join().cycles(2, kTwoNodes); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  cl na"},
      {"in", "in cycle 1", other_node(), [](PocScript& s) { s.to_check(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"in", "in cycle 2", other_node(), [](PocScript& s) { s.to_check().cycle(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  il --"},
      {"in", "in cycle 3", other_node(), [](PocScript& s) { s.to_check().cycle().cycle(kLeaderOnly).correct_clock(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  il --"},
      {"in", "in cycle 4", other_node(), [](PocScript& s) { s.to_check().cycle().cycles(2, kLeaderOnly); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  il --"},
      {"in", "in cycle 7", other_node(),
       [](PocScript& s) { s.to_check().cycle().cycles(2, kLeaderOnly).cycles(3, kTwoNodes).correct_clock(); },
       "dc -- -- rd -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  il na"},
      {"na", "", coldstart_node(), [](PocScript& s) { s.to_active(); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"na", "HALT pending", coldstart_node(), [](PocScript& s) { s.to_active().apply(Event::kHalt); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  ha ha"},
      {"na", "READY pending", coldstart_node(), [](PocScript& s) { s.to_active().apply(Event::kReady); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  rd rd"},
      {"na", "READY and HALT pending", coldstart_node(),
       [](PocScript& s) { s.to_active().apply(Event::kReady).apply(Event::kHalt); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  ha ha"},
      {"na", "clock beyond its limit", coldstart_node(),
       [](PocScript& s) { s.to_active().apply(PocEvent::clock_corrected(false, true)); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  ha ha"},
      {"np", "", coldstart_node(), [](PocScript& s) { s.to_passive(); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"np", "HALT pending", coldstart_node(), [](PocScript& s) { s.to_passive().apply(Event::kHalt); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  ha ha"},
      {"np", "READY pending", coldstart_node(), [](PocScript& s) { s.to_passive().apply(Event::kReady); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  rd rd"},
      {"np", "clock in order long enough", coldstart_node(),
       [](PocScript& s) { s.to_passive().double_cycles(2, false).correct_clock(); },
       "dc -- -- -- -- -- -- -- -- ha ha  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  na na"},
      {"ha", "by HALT", coldstart_node(), [](PocScript& s) { s.to_active().apply(Event::kHalt).cycle(kTwoNodes); },
       "dc dc -- -- -- -- -- -- -- -- --  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
      {"ha", "by FREEZE", coldstart_node(), [](PocScript& s) { s.to_listen().apply(Event::kFreeze); },
       "dc dc -- -- -- -- -- -- -- -- --  -- -- -- -- --  -- -- --  -- -- -- -- --  -- -- --  -- --"},
  };
  return all;
}

// The actions due at a change of state, derived from the two states alone.
PocActions due(const PocState& before, const PocState& after) {
  const auto listens = [](Kind kind) {
    return kind == Kind::kColdstartListen || kind == Kind::kWakeupListen || kind == Kind::kWakeupDetect;
  };
  PocActions actions;
  if (before.kind == after.kind) return actions;
  if (listens(before.kind) && !listens(after.kind)) actions |= PocAction::kStopTimers;
  if (has_schedule(before.kind) && !has_schedule(after.kind)) actions |= PocAction::kDropSchedule;
  if (listens(after.kind)) actions |= PocAction::kRestartListenTimer;
  if (listens(after.kind) && after.kind != Kind::kWakeupDetect) actions |= PocAction::kRestartNoiseTimer;
  if (after.kind == Kind::kWakeupSend) actions |= PocAction::kSendWakeupPattern;
  if (after.kind == Kind::kColdstartCollisionResolution) actions |= PocAction::kSendCas;
  if (after.kind == Kind::kInitialiseSchedule) actions |= PocAction::kDeriveSchedule;
  return actions;
}

TEST(PocTable, EveryPairHasItsListedNextState) {
  for (const Row& row : rows()) {
    PocScript script(row.parameters);
    row.lead(script);
    ASSERT_EQ(script.state.kind, kind_of(row.start)) << row.start << ' ' << row.what;
    const auto events = columns(script.last_cycle + 1);
    std::istringstream list(row.next);
    std::vector<std::string> next{std::istream_iterator<std::string>(list), {}};
    ASSERT_EQ(next.size(), events.size()) << row.start << ' ' << row.what;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const PocStep step = poc_step(script.parameters, script.state, events[i]);
      const Kind expected = next[i] == "--" ? script.state.kind : kind_of(next[i]);
      EXPECT_EQ(to_text(step.next.kind), to_text(expected))
          << to_text(script.state.kind) << " (" << row.what << "), " << to_text(events[i].kind) << ", column " << i;
    }
  }
}

TEST(PocTable, RowsAndColumnsAreComplete) {
  std::set<Kind> kinds;
  for (const Row& row : rows()) kinds.insert(kind_of(row.start));
  EXPECT_EQ(kinds.size(), kAllPocKinds.size());
  EXPECT_EQ((std::set<Kind>(kAllPocKinds.begin(), kAllPocKinds.end())), kinds);
  std::set<Event> events;
  for (const PocEvent& event : columns(0)) events.insert(event.kind);
  EXPECT_EQ((std::set<Event>(kAllPocEventKinds.begin(), kAllPocEventKinds.end())), events);
  EXPECT_EQ(events.size(), static_cast<std::size_t>(Event::kCycleStarted) + 1);
}

TEST(PocTable, EveryStepSaysWhyAndDoesWhatTheChangeNeeds) {
  for (const Row& row : rows()) {
    PocScript script(row.parameters);
    row.lead(script);
    for (const PocEvent& event : columns(script.last_cycle + 1)) {
      const PocStep step = poc_step(script.parameters, script.state, event);
      const std::string where =
          std::string(to_text(script.state.kind)) + " (" + row.what + "), " + std::string(to_text(event.kind));
      EXPECT_FALSE(to_text(step.reason).empty()) << where;
      if (is_ignored(step.reason)) {
        EXPECT_EQ(step.next, script.state) << where;
        EXPECT_TRUE(step.actions.empty()) << where;
      }
      if (step.next.kind != script.state.kind) {
        EXPECT_FALSE(is_ignored(step.reason)) << where;
        EXPECT_EQ(step.actions, due(script.state, step.next)) << where;
      }
      const bool listens = step.next.kind == Kind::kColdstartListen || step.next.kind == Kind::kIntegrationListen;
      EXPECT_EQ(step.consequence != PocReason::kNone, listens && step.next.kind != script.state.kind) << where;
    }
  }
}

TEST(PocTable, OnlyTheListenTimersFollowTheChannel) {
  for (const Row& row : rows()) {
    PocScript script(row.parameters);
    row.lead(script);
    const bool listens = script.state.kind == Kind::kColdstartListen || script.state.kind == Kind::kWakeupListen;
    const auto actions = [&](Event kind) { return poc_step(script.parameters, script.state, PocEvent{kind}).actions; };
    EXPECT_EQ(listen_timer_follows_channels(script.state.kind), listens) << row.start;
    EXPECT_EQ(actions(Event::kChannelActive), listens ? PocActions(PocAction::kStopListenTimer) : PocActions())
        << row.start;
    EXPECT_EQ(actions(Event::kChannelsIdle), listens ? PocActions(PocAction::kRestartListenTimer) : PocActions())
        << row.start;
    if (script.state.kind == Kind::kColdstartListen) {
      EXPECT_EQ(actions(Event::kCasReceived), PocActions(PocAction::kRestartNoiseTimer));
      EXPECT_EQ(actions(Event::kHeaderReceived), PocActions(PocAction::kRestartNoiseTimer));
    }
  }
}

TEST(PocTable, NodesSendOnlyInThreeStartupStatesAndNormalActive) {
  for (const Row& row : rows()) {
    PocScript script(row.parameters);
    row.lead(script);
    const std::string start = row.start;
    const MacMode expected = start == "cr" || start == "cc" || start == "cj" ? MacMode::kStartupFrame
                             : start == "na"                                 ? MacMode::kAll
                                                                             : MacMode::kNothing;
    EXPECT_EQ(mac_mode(script.state), expected) << start << ' ' << row.what;
  }
}

TEST(PocTable, ScheduleAndClockCorrectionFollowFromTheState) {
  const std::set<std::string> corrects{"cc", "ic", "cj", "in", "na", "np"};
  const std::set<std::string> only_schedule{"cr", "ga", "is"};
  const std::set<std::string> startup{"cl", "cr", "cc", "ga", "cj", "il", "is", "ic", "in"};
  for (const Code& entry : kCodes) {
    EXPECT_EQ(corrects_clock(entry.kind), corrects.contains(entry.code)) << entry.code;
    EXPECT_EQ(has_schedule(entry.kind), corrects.contains(entry.code) || only_schedule.contains(entry.code))
        << entry.code;
    EXPECT_EQ(in_startup(entry.kind), startup.contains(entry.code)) << entry.code;
  }
}

TEST(PocTable, EachStateEventAndReasonHasItsOwnWords) {
  std::set<std::string_view> words;
  for (const Kind kind : kAllPocKinds) words.insert(to_text(kind));
  EXPECT_EQ(words.size(), kAllPocKinds.size());
  words.clear();
  for (const Event kind : kAllPocEventKinds) words.insert(to_text(kind));
  EXPECT_EQ(words.size(), kAllPocEventKinds.size());
  EXPECT_FALSE(words.contains(""));
  words.clear();
  const int reasons = static_cast<int>(PocReason::kNotYetWholeCycle) + 1;
  for (int i = 0; i < reasons; ++i) words.insert(to_text(static_cast<PocReason>(i)));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(reasons));
}

}  // namespace
}  // namespace ttf::bus::poc
