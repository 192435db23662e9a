// Puts arrivals in real time in their place on the node's own clock, and hands them over in the order of those
// instants.
//
// FlexRay's own windows are microseconds, but an ordinary kernel wakes a sender up later. So a medium in real
// time has an arrival window (schedules::model::ArrivalWindow), which this class applies. A frame of the static
// segment says its slot and its cycle. A frame within its window is handed over where FlexRay expects it:
//
//   a sync frame        at its arrival less the lateness that its sender reports: as if the sender had been in time. So
//                       clock synchronisation measures clocks, not kernels. The distance from the action point stays
//                       within FlexRay's windows and the limit of the correction. A larger one is put an eighth before
//                       that limit. The eighth leaves room within a double cycle for the difference of the deviations,
//                       from which rates are measured. With both at the limit, rates would seem equal: clocks far apart
//                       would lose their rate corrections, and never meet
//   any other frame     exactly at the action point of its slot
//
// A frame outside its window is reported as late or early, and not handed over. A frame of the next cycle on
// this node's clock waits for that cycle. The next frame of a slot reports how many before it never came, if
// the gap is at most kLongestGap cycles; after a longer silence the sender was away.
//
// Without a clock of the cluster, or with an unreadable header, a frame keeps the instant of its arrival.
//   L1  take() hands over in the order of due instants, and of arrival where these are equal
//   L2  a frame is never handed over before it is due; nothing allocates after construction
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
  // A frame of another node came so much after the action point of its slot (negative: before it).
  virtual void arrived(Microticks behind) { (void)behind; }
  // A frame came outside its window and was not used.
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
  static constexpr std::size_t kMost = 1024;  // arrivals held at a time

  struct Width {
    Microticks early{}, late{};
  };
  ArrivalWindow(const schedules::model::Cluster& cluster, NodeId node, Width width, ArrivalEvents& events);

  // Takes an arrival in. `at` is its instant in this node's microticks, `late` the lateness of its departure as
  // its sender reports it, `duration` the length of a symbol. `clock` is the controller's, null while it has none.
  void arrive(const bus::ports::LiveArrival& arrival, Microticks at, std::optional<Microticks> late,
              Microticks duration, const timebase::CycleClock* clock);

  // Returns the next due instant; far in the future if there is none.
  Microticks next() const;

  struct Due {
    bus::ports::LiveArrival::Kind kind{};
    bus::ports::Reception reception;  // for kFlexRay
    std::size_t can_bus = 0;          // for kCan
    bus::ports::CanFrame can;
    Microticks at{};
  };
  // Returns the next arrival that is due up to `now`. Its views are valid until the next call of any function here.
  std::optional<Due> take(Microticks now, const timebase::CycleClock* clock);

  // Returns whether something that has begun is still on its way.
  bool carrier(schedules::model::Channel channel, Microticks now) const;
  // How long after its end a frame in its window may still be handed over: it comes late, and its follow-up as
  // late again.
  Microticks handed_over_within() const { return {2 * width_.late.value}; }
  std::uint64_t held() const { return used_.size(); }
  // The number of arrivals dropped for lack of room.
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
    Microticks start{}, end{};  // once placed
    int slot = 0;
    std::size_t can_bus = 0;
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
    std::size_t size = 0;

    std::span<const std::byte> content() const { return std::span<const std::byte>(bytes).first(size); }
  };
  // The judgement of a frame that is to be placed.
  struct Found {
    HeldEvent event{};
    // In or outside its window:
    bool sync = false;
    std::int64_t cycle = 0;
    Microticks expected{}, behind{};  // at the action point of its slot, and how much later it came
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
  void drop(std::size_t place);  // `place` is in used_

  const schedules::model::Cluster& cluster_;
  const schedules::model::NodeParameters* parameters_;  // null off FlexRay
  const bus::controller::SlotTable slots_;
  const Width width_;
  ArrivalEvents& events_;
  Microticks reach_{};  // the largest distance of a sync frame from its action point
  struct Deviation {
    std::int64_t cycle = -2;  // initially before any cycle that an odd one follows
    Microticks measured{}, put{};
  };
  std::array<std::vector<Deviation>, 2> deviations_;  // by channel and slot - 1, the last one of a sync frame
  std::vector<Held> pool_;
  std::vector<std::uint16_t> free_, used_;
  std::optional<std::uint16_t> handed_over_;  // its views are in use
  std::uint64_t order_ = 0, dropped_ = 0;
  std::array<std::vector<std::int64_t>, 2> received_;  // by channel and slot - 1, the last cycle; kNotReceived
};

}  // namespace ttf::nodes::runner
