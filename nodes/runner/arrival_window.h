// What has arrived in real time, put in its place on the node's own clock, and handed over in the order of those
// instants.
//
// FlexRay's own windows are microseconds; an ordinary kernel wakes a sender up later than that. So a medium in real
// time has an arrival window of its own (schedules::model::ArrivalWindow), and this is who judges it. A frame of the
// static segment says which slot it is of, and of which cycle. Within its window it is handed over where FlexRay
// expects it:
//
//   a sync frame        at the instant it would have come at had its sender been in time: arrival less what the sender
//                       says it left late by; so clock synchronisation measures clocks, not kernels. Never further from
//                       the action point than FlexRay's windows and the correction's limit reach: what is further is
//                       put an eighth before their end, so that within a double cycle there is room for what its
//                       deviations differ by, from which rates are measured. Were both put at the end, rates would
//                       seem equal, and clocks far apart would lose their rate corrections, and never meet
//   any other frame     exactly at the action point of its slot
//
// Before or behind its window it is not handed over: it is late (or early), which is told. A frame of the cycle that
// comes next on this node's clock waits for it. Frames that never came are told by the next one of their slot, as
// long as no more than kLongestGap cycles are between them: who is silent for longer was away.
//
// Without a clock of the cluster, or with a header that nobody can make out, a frame keeps the instant it came at.
//   L1  take() hands over in the order of due instants; of equal ones, in the order of arrival
//   L2  nothing is handed over before it is due; nothing allocates after construction
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/controller/slot_table.h"
#include "bus/ports/flexray_port.h"
#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "nodes/runner/held_stage.h"
#include "schedules/model/cluster.h"
#include "timebase/cycle_clock.h"

namespace ttf::nodes::runner {

class ArrivalEvents {
 public:
  virtual ~ArrivalEvents() = default;
  // A frame of another node was so much behind the action point of its slot (negative: before it).
  virtual void arrived(Microticks behind) { (void)behind; }
  // Outside its window, and not used.
  virtual void missed_window(std::int64_t cycle, int slot, schedules::model::Channel channel, Microticks behind) {
    (void)cycle, (void)slot, (void)channel, (void)behind;
  }
  // So many frames of the slot, before that cycle, never came.
  virtual void lost(std::int64_t cycle, int slot, schedules::model::Channel channel, std::uint32_t count) {
    (void)cycle, (void)slot, (void)channel, (void)count;
  }
};

class ArrivalWindow {
 public:
  static constexpr std::int64_t kLongestGap = 64;
  static constexpr std::size_t kMost = 1024;  // held at a time

  struct Width {
    Microticks early{}, late{};
  };
  ArrivalWindow(const schedules::model::Cluster& cluster, NodeId node, Width width, ArrivalEvents& events);

  // `at`: of the arrival, in this node's microticks. `late`: the same of what it says it left late by. `duration`: of a
  // symbol. `clock`: the controller's, null while it has none.
  void arrive(const bus::ports::LiveArrival& arrival, Microticks at, std::optional<Microticks> late,
              Microticks duration, const timebase::CycleClock* clock);

  // When something is due next; far in the future where nothing is.
  Microticks next() const;

  struct Due {
    bus::ports::LiveArrival::Kind kind{};
    bus::ports::Reception reception;  // of kFlexRay
    std::size_t can_bus = 0;          // of kCan
    bus::ports::CanFrame can;
    Microticks at{};
  };
  // The next that is due up to `now`; views are valid until the next call of anything here.
  std::optional<Due> take(Microticks now, const timebase::CycleClock* clock);

  // Something whose begin has come is still on its way.
  bool carrier(schedules::model::Channel channel, Microticks now) const;
  // How long after its end a frame in its window may still be handed over: it comes late, and its follow-up as late
  // again.
  Microticks handed_over_within() const { return {2 * width_.late.value}; }
  std::uint64_t held() const { return used_.size(); }
  // There was no room for them.
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Held {
    bus::ports::LiveArrival::Kind kind{};
    bus::ports::Signal signal{};
    schedules::model::Channel channel{};
    HeldStage stage{};
    std::uint64_t order = 0;
    Microticks at{}, due{};
    std::optional<Microticks> late;
    Microticks start{}, end{};  // once it is placed
    int slot = 0;
    std::size_t can_bus = 0;
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    std::size_t size = 0;

    std::span<const std::byte> content() const { return std::span<const std::byte>(bytes).first(size); }
  };
  // What a frame that is to be placed is found to be.
  struct Found {
    HeldEvent event{};
    // In or outside its window:
    bool sync = false;
    std::int64_t cycle = 0;
    Microticks expected{}, behind{};  // at the action point of its slot, and so much later
  };
  void follow_up(const bus::ports::LiveArrival& arrival, Microticks late, const timebase::CycleClock* clock);
  Found find(const Held& frame, const timebase::CycleClock* clock) const;
  void place(Held& frame, const Found& found, const timebase::CycleClock* clock);
  void place_as_it_came(Held& held, Microticks length);
  void place_in_slot(Held& frame, const Found& found);
  Microticks length_of(const Held& frame) const;
  Microticks within_reach(Microticks deviation, std::int64_t cycle, int slot, schedules::model::Channel channel);
  void count_gap(std::int64_t cycle, int slot, schedules::model::Channel channel);
  void forget_cycles();
  void drop(std::size_t place);  // in used_

  const schedules::model::Cluster& cluster_;
  const schedules::model::NodeParameters* parameters_;  // null: off FlexRay
  const bus::controller::SlotTable slots_;
  const Width width_;
  ArrivalEvents& events_;
  Microticks reach_{};  // a sync frame's from its action point, at most
  struct Deviation {
    std::int64_t cycle = -2;  // before any that an odd one follows
    Microticks measured{}, put{};
  };
  std::array<std::vector<Deviation>, 2> deviations_;  // by channel and slot - 1, the last one of a sync frame
  std::vector<Held> pool_;
  std::vector<std::uint16_t> free_, used_;
  std::optional<std::uint16_t> handed_over_;  // its views are out
  std::uint64_t order_ = 0, dropped_ = 0;
  std::array<std::vector<std::int64_t>, 2> heard_;  // by channel and slot - 1, the last cycle; kNotHeard
};

}  // namespace ttf::nodes::runner
