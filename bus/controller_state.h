// Inside the controller: its data, and the three things it does with them. controller.cc drives protocol operation
// control and the cycle, controller_send.cc sends, controller_receive.cc receives and judges.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "bus/controller.h"
#include "bus/dynamic_segment.h"
#include "bus/schedule_initialisation.h"
#include "bus/slot_table.h"
#include "bus/sync_collector.h"

namespace ttf::bus {

inline constexpr Microticks kNever{std::numeric_limits<std::int64_t>::max()};
inline constexpr std::array kChannels = {schedules::Channel::kA, schedules::Channel::kB};

struct FlexRayController::State {
  State(const schedules::Cluster& cluster, NodeId node, FlexRayPort& port, ControllerEvents& events);

  // --- what never changes
  const schedules::Cluster& cluster;
  const schedules::GlobalParameters& g;
  const schedules::NodeParameters& p;
  NodeId node;
  FlexRayPort& port;
  ControllerEvents& events;
  const PocParameters poc_parameters;
  const SlotTable slots;
  const MinislotGrid minislots;
  const timebase::CycleGeometry geometry;

  // --- where it stands
  PocState poc;
  Cni cni;
  std::optional<timebase::CycleClock> clock;
  int next_rate = 0;
  SyncCollector sync;
  ScheduleInitialisation initialisation;
  Microticks listen_timer = kNever, noise_timer = kNever, wakeup_sent = kNever;
  Microticks partner_overdue = kNever;     // while a schedule is being derived
  std::array<Microticks, 2> sending_from{kNever, kNever}, sending_to{};   // by channel: this node's last transmission

  // What was seen in one static slot of a cycle, per channel.
  struct Seen {
    std::array<bool, 2> valid{}, element{};
    std::array<std::uint8_t, 2> errors{};
  };
  std::vector<Seen> seen;                  // by slot - 1: in the segment under way
  std::vector<Seen> seen_last;             // ... in the one that is over
  SyncStatus sync_status;                  // without its counter, which is protocol operation control's

  // How far the cycle is.
  enum class Segment : std::uint8_t { kBefore, kStatic, kDynamic, kRest };   // kBefore: the first cycle is to start
  Segment segment = Segment::kStatic;
  std::size_t next_static = 0;             // in slots.own_static()
  struct Dynamic {
    DynamicSlotCounter counter;
    std::size_t next = 0;                  // in slots.own_dynamic()
    Microticks due = kNever;               // action point of that slot, as the counter stands
    int minislot = 0;                      // it begins in
  };
  std::array<Dynamic, 2> dynamic;          // by channel

  std::array<std::byte, wire::kMaxPayloadBytes> payload{};
  std::array<std::byte, wire::kMaxFrameBytes> frame{};

  // --- protocol operation control (controller.cc)
  void tell(const PocEvent& event, Microticks at);
  void act(const PocActions& actions, Microticks at);
  void begin_schedule(Microticks start, int rate, std::int64_t cycle);
  void drop_schedule();

  // --- the cycle (controller.cc)
  Microticks next_event() const;
  void handle(Microticks at);
  void start_cycle();
  void enter_cycle(const StartupFramesSeen& ended, Microticks at);
  void close_static_segment(Microticks at);
  void tell_slot_problems(Microticks at);
  int counter() const { return static_cast<int>(clock->cycle() % (g.gCycleCountMax + 1)); }
  Macroticks slot_start(int slot) const { return {static_cast<std::int64_t>(slot - 1) * g.gdStaticSlot}; }
  Macroticks action_point(int slot) const { return slot_start(slot) + Macroticks{g.gdActionPointOffset}; }
  Macroticks static_end() const { return slot_start(g.gNumberOfStaticSlots + 1); }
  Microticks bits(int count) const;        // gdBit, rounded up to whole microticks

  // --- sending (controller_send.cc)
  bool may_send(const schedules::FrameSlot& slot) const;
  void skip_to_own_static();
  void send_static(Microticks at);
  void plan_dynamic(schedules::Channel channel, Microticks now);
  void send_dynamic(schedules::Channel channel, Microticks at);
  void send_frame(const schedules::FrameSlot& slot, schedules::Channel channel, Microticks at, Microticks end,
                  const Cni::Fragment& content, bool null_frame, bool last);
  void send_symbol(Signal signal, schedules::Channel channel, Microticks at, Microticks end);
  void send_cas(Microticks at);
  void send_wakeup_pattern(Microticks at);

  // --- receiving (controller_receive.cc)
  void receive(const Reception& reception);
  void hear(const Reception& reception);                   // without a schedule
  void judge(const Reception& reception, bool conflict);   // within the schedule
  void judge_static(const Reception& reception, int slot, std::uint8_t errors);
  void judge_dynamic(const Reception& reception, std::uint8_t errors);
  bool store(const schedules::FrameSlot& slot, const Reception& reception);
  int static_slot_at(Microticks at) const;                 // 0 before, gNumberOfStaticSlots + 1 after the segment
};

}  // namespace ttf::bus
