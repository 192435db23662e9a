// The controller's fast ways against the plain one, on drawn receptions. One is a frame on both channels at
// once (receive_on_both()). The other is a frame without new content, taken in before it arrives (is_known(),
// receive_known()).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "tests/bus/alone.h"

namespace ttf::bus::controller {
namespace {

// All of a controller's reports to a host that wants no receptions.
struct Reported final : ControllerEvents {
  std::vector<std::int64_t> entries;
  int problems = 0;
  template <class... Numbers> void write(Numbers... numbers) {
    (entries.push_back(static_cast<std::int64_t>(numbers)), ...);
  }
  bool wants_receptions() const override { return false; }
  void cycle_started(std::int64_t cycle, Microticks at) override { write(1, cycle, at.value); }
  void slot_problem(std::int64_t cycle, int slot, Channel channel, SlotStatus status, Microticks at) override {
    write(2, cycle, slot, channel, status, at.value);
    ++problems;
  }
  void static_segment_ended(std::int64_t cycle, Microticks at) override { write(3, cycle, at.value); }
  // A known fragment need not be reported.
  void list_arrived(PduId pdu, cni::ArrivalEffect effect, std::uint32_t sequence, std::optional<std::uint32_t> torn,
                    Microticks at) override {
    if (effect != cni::ArrivalEffect::kDuplicate || torn)
      write(4, pdu, effect, sequence, torn ? std::int64_t{*torn} : -1, at.value);
  }
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks at) override {
    write(5, cycle, offset.value, rate.value, offset.missing, rate.missing, at.value);
  }
  void state_changed(poc::PocKind from, const poc::PocStep& step, Microticks at) override {
    write(6, from, step.next.kind, step.reason, at.value);
  }
};

// A reception on both channels, or on one.
struct Arrived {
  ports::Reception reception;
  bool on_a = true, on_b = true;
};

// Node 1: it receives the list of node 0 and sends in slots 2 and 9.
struct Seat {
  NoPort port;
  Reported reported;
  FlexRayController controller;

  explicit Seat(const schedules::model::Cluster& cluster) : controller(cluster, NodeId{1}, port, reported) {
    controller.start_integrated({{1000}, 0});
  }
  // Runs all events due before.
  void run_to(Microticks at) {
    while (controller.next_event() < at) controller.advance(controller.next_event());
  }
  void receive_plainly(const Arrived& arrived) {
    run_to(arrived.reception.end);
    if (arrived.on_a) controller.receive(arrived.reception);
    if (arrived.on_b) controller.receive(ports::on_b(arrived.reception));
  }
};

struct Counts {
  int on_both = 0, known = 0, problems = 0;
};

class Drawn {
 public:
  explicit Drawn(std::uint32_t index) : draw_({11, index, Purpose::kTest, 4, 0}) {}

  void run(Counts& counts) {
    for (std::int64_t cycle = 0; cycle < 8; ++cycle) {
      for (int slot = 1; slot <= 10; ++slot) {
        const bool own = slot == 2 || slot == 9 || slot == 10;  // or unassigned
        if (draw_.uniform() < (own ? 0.9 : 0.03)) continue;
        arrive(cycle, slot, counts);
        if (draw_.uniform() < 0.05) arrive(cycle, slot, counts);
      }
      // Behind the static segment, and before the next one.
      const Microticks behind = Alone::at(cycle, 900);
      for (Seat* const seat : {&plain_, &both_, &early_}) seat->run_to(behind);
      compare_status();
    }
    counts.problems += plain_.reported.problems;
  }

 private:
  // Mostly the schedule's frame, now and then another.
  void arrive(std::int64_t cycle, int slot, Counts& counts) {
    Frame frame = Frame::status(slot, cycle);
    if (slot >= 5 && slot <= 8) {
      // A list lasts for two cycles, so every second time it is already complete.
      MadeList list(cluster_.pdu(kList), static_cast<std::uint32_t>(cycle / 2), 10, 100);
      std::ranges::copy(list.fragment(slot - 5), frame.payload.begin());
      frame.header.null_frame = draw_.uniform() < 0.1;
    }
    frame.start += draw_.integer(-20, 20);
    if (odd()) frame.start += draw_.integer(-800, 2600);
    if (odd()) frame.header.cycle = static_cast<std::uint8_t>((frame.header.cycle + 1) % 64);
    if (odd()) frame.header.frame_id = static_cast<std::uint16_t>(draw_.integer(1, 10));
    if (odd()) frame.header.payload_preamble = !frame.header.null_frame;
    if (odd()) frame.payload.resize(14);
    if (odd()) frame.header.sync = true;
    frame.start = std::max(frame.start, free_from_);
    free_from_ = frame.start + frame.length;
    const auto bytes = frame.bytes();
    Arrived arrived{received(Channel::kA, {frame.start}, {frame.start + frame.length}, bytes)};
    if (odd()) arrived.reception.signal = draw_.uniform() < 0.5 ? ports::Signal::kUndecodable : ports::Signal::kCas;
    if (odd()) (draw_.uniform() < 0.5 ? arrived.on_a : arrived.on_b) = false;
    receive(arrived, counts);
  }
  bool odd() { return draw_.uniform() < 0.02; }

  void receive(const Arrived& arrived, Counts& counts) {
    plain_.run_to(arrived.reception.end);
    const Microticks due = plain_.controller.next_event();
    const poc::PocKind kind = plain_.controller.state().kind;
    plain_.receive_plainly(arrived);
    const bool changes = plain_.controller.next_event() != due || plain_.controller.state().kind != kind;
    if (!arrived.on_a || !arrived.on_b) {
      both_.receive_plainly(arrived);
      early_.receive_plainly(arrived);
    } else {
      ++counts.on_both;
      both_.run_to(arrived.reception.end);
      EXPECT_EQ(both_.controller.receive_on_both(arrived.reception), changes);
      early_.run_to(arrived.reception.start);
      if (early_.controller.is_known(arrived.reception)) {
        ++counts.known;
        EXPECT_FALSE(changes);
        early_.controller.receive_known(arrived.reception);
        early_.run_to(arrived.reception.end);
      } else {
        early_.receive_plainly(arrived);
      }
    }
    for (Seat* const seat : {&both_, &early_}) {
      ASSERT_EQ(seat->controller.next_event(), plain_.controller.next_event());
      ASSERT_EQ(seat->controller.state().kind, plain_.controller.state().kind);
      ASSERT_EQ(seat->reported.entries, plain_.reported.entries);
    }
  }

  void compare_status() {
    for (Seat* const seat : {&both_, &early_}) {
      ASSERT_EQ(seat->reported.entries, plain_.reported.entries);
      for (int slot = 1; slot <= 10; ++slot)
        for (const Channel channel : {Channel::kA, Channel::kB})
          ASSERT_EQ(seat->controller.slot_status(slot, channel), plain_.controller.slot_status(slot, channel)) << slot;
      ASSERT_EQ(seat->controller.sync_status(), plain_.controller.sync_status());
      const auto list = seat->controller.incoming(kList).latest(), as = plain_.controller.incoming(kList).latest();
      ASSERT_EQ(list.has_value(), as.has_value());
      if (!list) continue;
      ASSERT_EQ(list->sequence, as->sequence);
      ASSERT_TRUE(std::ranges::equal(list->bytes, as->bytes));
    }
  }

  schedules::model::Cluster cluster_ = small_cluster(4);
  RandomStream draw_;
  std::int64_t free_from_ = 0;
  Seat plain_{cluster_}, both_{cluster_}, early_{cluster_};
};

TEST(ControllerFastWays, AreAsThePlainOne) {
  Counts counts;
  for (std::uint32_t index = 0; index < 400 && !testing::Test::HasFailure(); ++index) {
    SCOPED_TRACE(index);
    Drawn(index).run(counts);
  }
  EXPECT_GT(counts.on_both, 10'000);
  EXPECT_GT(counts.known, 1'000);
  EXPECT_LT(counts.known, counts.on_both - 1'000);
  EXPECT_GT(counts.problems, 1'000);
}

}  // namespace
}  // namespace ttf::bus::controller
