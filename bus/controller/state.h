// The controller's data and its work on them. controller.cc drives protocol operation control and the cycle,
// send.cc sends, receive.cc receives and judges, symbol_window.cc has the symbol window.
#pragma once

#include <array>
#include <vector>

#include "bus/controller/controller.h"
#include "bus/controller/dynamic_segment.h"
#include "bus/controller/network_management.h"
#include "bus/controller/schedule_initialisation.h"
#include "bus/controller/slot_board.h"
#include "bus/controller/slot_table.h"
#include "bus/controller/sync_collector.h"

namespace ttf::bus::controller {

struct FlexRayController::State {
  State(const schedules::model::Cluster& cluster, NodeId node, ports::FlexRayPort& port, ControllerEvents& events);

  // --- constants
  const schedules::model::Cluster& cluster;
  const schedules::model::GlobalParameters& g;
  const schedules::model::NodeParameters& p;
  NodeId node;
  ports::FlexRayPort& port;
  ports::ContentPort* const by_content;  // null: every frame is sent in bytes
  ControllerEvents& events;
  const poc::PocParameters poc_parameters;
  const SlotTable slots;
  const MinislotGrid minislots;
  const timebase::CycleGeometry geometry;
  const bool wants_receptions;           // the host wants every reception
  const timebase::Divisor nominal_slot;  // a static slot's microticks, give or take one
  const Microticks static_frame;         // a static frame's length
  const Microticks longest_cas;          // a longer low phase is no collision avoidance symbol
  const bool pattern_wakes;              // a receiver recognises this cluster's wake-up pattern

  // --- the present state
  poc::PocState poc;
  cni::Cni cni;
  NetworkManagement network_management;
  std::optional<timebase::CycleClock> clock;
  int next_rate = 0;
  int extern_offset = 0, extern_rate = 0;  // [uT], set by the host
  SyncCollector sync;
  ScheduleInitialisation initialisation;
  Microticks listen_timer = kNever<Microticks>, noise_timer = kNever<Microticks>, wakeup_sent = kNever<Microticks>;
  Microticks partner_overdue = kNever<Microticks>;  // while a schedule is being derived
  // This node's last transmission, by channel.
  std::array<Microticks, 2> sending_from{kNever<Microticks>, kNever<Microticks>}, sending_to{};

  SlotBoard board;
  std::array<bool, 2> going_on{};  // by channel: activity at the end of the last static segment still goes on
  SyncStatus sync_status;          // without its counter, which protocol operation control has

  // The static slot of this cycle that was looked up last. The other channel's frame of it comes next, then
  // that of the slot after it. Slot 0 comes before the first.
  struct SlotAt {
    int slot = 0;
    Microticks from{}, to{};                                       // [from, to); empty: no slot
    int counter = 0;                                               // the cycle's
    std::array<const schedules::model::FrameSlot*, 2> expected{};  // by channel, from SlotTable
  };
  SlotAt slot_at;
  // The static slots on the clock: beginning and action point within the cycle.
  struct GridLine {
    Microticks from{}, action_point{};
  };
  std::vector<GridLine> grid;    // by slot - 1; after the last slot, its end
  std::optional<int> grid_rate;  // the clock's rate for which the grid was made
  int counter = 0;               // the clock's cycle: 0..gCycleCountMax

  // The part of the cycle that is under way. kBefore: the first cycle has not started. kDynamic includes the
  // symbol window.
  enum class Segment : std::uint8_t { kBefore, kStatic, kDynamic, kRest };
  Segment segment = Segment::kStatic;
  Microticks due = kNever<Microticks>;  // next_event(); a reception in a static slot leaves it unchanged
  std::size_t next_static = 0;          // in slots.own_static()
  struct Dynamic {
    DynamicSlotCounter counter;
    std::size_t next = 0;                 // in slots.own_dynamic()
    Microticks due = kNever<Microticks>;  // action point of that slot, by the present counter
    int minislot = 0;                     // in which that slot begins
  };
  std::array<Dynamic, 2> dynamic;  // by channel

  // The symbol window, planned when the static segment ends; never if there is none.
  Microticks window_from = kNever<Microticks>, window_to = kNever<Microticks>, symbol_point = kNever<Microticks>;
  std::optional<schedules::model::Channels> symbol_request;  // a media access test symbol to be sent in the window
  std::array<SymbolWindowSeen, 2> window_seen, window_last;  // by channel: the running and the last finished one
  std::array<bool, 2> window_element{};                      // a communication element has begun in the window

  std::array<std::byte, wire::kMaxPayloadBytes> payload{};
  std::array<std::byte, wire::kMaxFrameBytes> frame{};

  // --- protocol operation control (controller.cc)
  void apply(const poc::PocEvent& event, Microticks at);
  void act(const poc::PocActions& actions, Microticks at);
  void begin_schedule(Microticks start, int rate, std::int64_t cycle);
  void lay_cycle();  // computes `counter` and `grid` from the clock
  void drop_schedule();

  // --- the cycle (controller.cc)
  Microticks next_event() const;
  void handle(Microticks at);
  void start_cycle();
  void enter_cycle(const poc::StartupFramesSeen& ended, Microticks at);
  void close_static_segment(Microticks at);
  void note_what_goes_on();
  void report_slot_problems(Microticks at);
  Macroticks slot_start(int slot) const { return {static_cast<std::int64_t>(slot - 1) * g.gdStaticSlot}; }
  Macroticks action_point(int slot) const { return slot_start(slot) + Macroticks{g.gdActionPointOffset}; }
  Macroticks static_end() const { return slot_start(g.gNumberOfStaticSlots + 1); }
  const GridLine& line(int slot) const {
    return grid[static_cast<std::size_t>(slot - 1)];
  }                                  // valid up to one slot after the last
  Microticks bits(int count) const;  // gdBit, rounded up to whole microticks

  // --- the symbol window (symbol_window.cc)
  bool request_media_test_symbol(schedules::model::Channels channels);
  Macroticks window_start() const;
  void plan_symbol_window();
  void send_media_test_symbol(Microticks at);
  void judge_symbol_window(const ports::Reception& reception, bool conflict);
  void close_symbol_window();

  // --- sending (send.cc)
  void skip_to_own_static();
  void send_static(Microticks at);
  void plan_dynamic(schedules::model::Channel channel, Microticks now);
  void send_dynamic(schedules::model::Channel channel, Microticks at);
  std::size_t preamble_bytes(const schedules::model::FrameSlot& slot) const {
    return static_cast<std::size_t>(schedules::model::preamble_bytes(g, slot));
  }
  // Returns the frame of a slot, built in `payload`.
  wire::DecodedFrame frame_of(const schedules::model::FrameSlot& slot, const cni::Cni::Fragment& content,
                              bool null_frame);
  // Returns whether the medium or the log needs the next frame's bytes.
  bool in_bytes(schedules::model::Channel channel) const {
    return by_content == nullptr || by_content->wants_bytes(channel) || events.wants_bytes();
  }
  // Returns false if it was too late to send.
  bool send_frame(const schedules::model::FrameSlot& slot, schedules::model::Channel channel, Microticks at,
                  Microticks end, const cni::Cni::Fragment& content, bool null_frame, bool last);
  void send_on_both(const schedules::model::FrameSlot& slot, Microticks at, Microticks end,
                    const cni::Cni::Fragment& content, bool null_frame);
  void send_symbol(ports::Signal signal, schedules::model::Channel channel, Microticks at, Microticks end);
  Microticks cas_length() const;
  void send_cas(Microticks at);
  void send_wakeup_pattern(Microticks at);

  // --- receiving (receive.cc)
  void receive(const ports::Reception& reception);
  bool receive_on_both(const ports::Reception& reception);
  bool judge_on_both(const ports::Reception& reception);
  bool in_operation() const { return poc::in_operation(poc.kind); }
  const schedules::model::FrameSlot* first_of_slot_on_both(const ports::Reception& reception) const;
  bool is_known(const ports::Reception& reception);
  void receive_known(const ports::Reception& reception);
  void receive_sync(const ports::Reception& reception, int slot, schedules::model::Channels channels);
  bool talks_over(const ports::Reception& reception, std::size_t channel) const {
    return sending_from[channel] != kNever<Microticks> && reception.start < sending_to[channel] &&
           reception.end > sending_from[channel];
  }
  void receive_in_startup(const ports::Reception& reception, bool conflict);  // or without a schedule
  void receive_startup_frame(const ports::Reception& reception);              // without a schedule
  void judge(const ports::Reception& reception, bool conflict);               // within the schedule
  void judge_static(const ports::Reception& reception, int slot, SlotStatus errors);
  // A valid frame decodes without error, lies within its slot, and has a header that is right there.
  static bool is_frame(const ports::Reception& reception) {
    return reception.signal == ports::Signal::kFrame && reception.frame.error == wire::FrameError::kNone;
  }
  // A longer low phase is no symbol (FlexRay 2.1A, chapter 3.2). Overlapping symbols may make one.
  bool is_cas(const ports::Reception& reception) const {
    return reception.signal == ports::Signal::kCas && reception.end - reception.start <= longest_cas;
  }
  bool is_of_slot(const wire::FrameHeader& header, int slot, int of_counter) const {
    return header.frame_id == slot && header.cycle == of_counter && header.payload_words == g.gPayloadLengthStatic &&
           (header.sync || !header.startup);
  }
  bool is_of_dynamic_slot(const wire::FrameHeader& header, int slot) const {
    return header.frame_id == slot && header.cycle == counter && !header.sync && !header.startup && !header.null_frame;
  }
  // Takes in a valid static frame; `expected` is the one that the schedule has there, null without one.
  void accept(const ports::Reception& reception, schedules::model::Channel channel, int slot,
              const schedules::model::FrameSlot* expected);
  bool is_as_expected(const wire::DecodedFrame& received, const schedules::model::FrameSlot* expected) const;
  void judge_elsewhere(const ports::Reception& reception, int slot, SlotStatus errors, bool conflict);
  void cross_slots(const ports::Reception& reception, int slot, int last);
  void judge_dynamic(const ports::Reception& reception, int minislot, SlotStatus errors);
  int count_minislots(const ports::Reception& reception);
  bool store(const schedules::model::FrameSlot& slot, const ports::Reception& reception);
  // Returns 0 before the segment and gNumberOfStaticSlots + 1 after it; any other slot is in slot_at then.
  int static_slot_at(Microticks at) {
    return at >= slot_at.from && at < slot_at.to ? slot_at.slot : look_up_static_slot(at);
  }
  // A signal that ends in the microtick it began in lies in one slot.
  int last_static_slot_of(const ports::Reception& reception) {
    const Microticks last = reception.end - Microticks{1};
    return static_slot_at(last > reception.start ? last : reception.start);
  }
  int look_up_static_slot(Microticks at);
};

}  // namespace ttf::bus::controller
