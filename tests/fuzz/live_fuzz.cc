// Any arrivals in real time, at any instant and in any order, at a working node
// (nodes/runner/arrival_window.h): frames of any slot and cycle, sound or broken, sync frames with and
// without follow-ups, symbols of any length, CAN frames and strobes. Laws: arrivals are handed over in order
// of their due instants, never earlier. They never stop the node, and its clock goes on.
//
// Input: the node's initial state (a byte), then acts: kind (a byte) and arguments.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "core/check.h"
#include "nodes/host/executive.h"
#include "nodes/host/node_clock.h"
#include "nodes/runner/arrival_window.h"
#include "schedules/file/loader.h"
#include "sim/drives/step_catalog.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;

const schedules::model::Cluster& the_cluster() {
  static const schedules::model::Cluster kCluster = [] {
    auto cluster = schedules::file::parse_cluster(fuzz::shipped_cluster("paper_synchronised"), "paper_synchronised");
    schedules::model::bind_ports(cluster, sim::drives::step_ports());
    return cluster;
  }();
  return kCluster;
}

struct Nobody final : nodes::host::SensorLines {
  void trigger(SensorId) override {}
  void strobe(SensorId, std::uint32_t) override {}
};
struct Deaf final : bus::ports::CanPort {
  void send(const bus::ports::CanFrame&) override {}
};
struct Idle final : nodes::host::Step {
  void run(nodes::host::StepContext&) override {}
};
struct Port final : bus::ports::FlexRayPort {
  const nodes::runner::ArrivalWindow* window = nullptr;
  Microticks now{};
  void transmit(const bus::ports::Transmission&) override {}
  bool carrier(schedules::model::Channel channel) const override { return window->carrier(channel, now); }
};

class Node {
 public:
  explicit Node(bool integrated) : window_(the_cluster(), kNode, {Microticks{4'000}, Microticks{20'000}}, events_) {
    const schedules::model::Cluster& cluster = the_cluster();
    const timebase::Oscillator oscillator(25'000, 0, 0);
    const TrueTime first{1'000'000};
    port_.window = &window_;
    now_ = oscillator.ticks_at(first);
    const nodes::host::ExecutiveConfig config{
        &cluster,
        kNode,
        oscillator,
        integrated ? std::optional(nodes::host::integrated_clock(oscillator, cluster, cluster.node(kNode), first))
                   : std::nullopt,
        1,
        0,
        now_,
        {},
        {},
        nullptr};
    std::vector<std::shared_ptr<nodes::host::Step>> steps(cluster.node(kNode).tasks.size());
    for (auto& step : steps) step = std::make_shared<Idle>();
    std::vector<bus::ports::CanPort*> cans;
    for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
      cans.push_back(schedules::model::is_on_can(cluster.node(kNode), b) ? &can_ : nullptr);
    executive_ =
        std::make_unique<nodes::host::Executive>(config, std::move(steps), &port_, std::move(cans), lines_, sink_);
  }

  const timebase::CycleClock* clock() const {
    const auto& clock = executive_->controller()->clock();
    return clock ? &*clock : nullptr;
  }
  std::int64_t cycle() const { return clock() != nullptr ? clock()->cycle() : 0; }
  Microticks now() const { return now_; }

  void arrive(const bus::ports::LiveArrival& arrival, Microticks at, std::optional<Microticks> late,
              Microticks duration) {
    window_.arrive(arrival, at, late, duration, clock());
  }

  // As Runner::do_due() does it.
  void go_on(Microticks until) {
    const auto next = [this] { return std::min(executive_->next_event(), window_.next()); };
    for (Microticks due = next(); due <= until; due = next()) {
      now_ = std::max(now_, due);
      port_.now = now_;
      if (const auto arrived = window_.take(now_, clock())) {
        if (arrived->kind == bus::ports::LiveArrival::Kind::kFlexRay) {
          TTF_CHECK(arrived->reception.end <= now_, "handed over {} microticks before its end",
                    (arrived->reception.end - now_).value);
          executive_->receive(arrived->reception);
        } else {
          executive_->receive_can(arrived->can_bus, arrived->can, now_);
        }
      } else if (executive_->next_event() <= now_) {
        executive_->advance(now_);
      }
    }
    now_ = std::max(now_, until);
    TTF_CHECK(clock() == nullptr || clock()->cycle_end() > now_ - Microticks{400'000}, "the clock stands still");
  }

  void strobe(std::uint32_t sequence, Microticks at) { executive_->strobe(SensorId{0}, sequence, at); }

 private:
  static constexpr NodeId kNode{4};  // the gateway: on both channels, and on a CAN
  nodes::runner::ArrivalEvents events_;
  nodes::runner::ArrivalWindow window_;
  Nobody lines_;
  Deaf can_;
  Port port_;
  recording::records::Sink sink_;
  std::unique_ptr<nodes::host::Executive> executive_;
  Microticks now_{};
};

void signal_arrives(Node& node, fuzz::Source& input, bool follow_up) {
  bus::ports::LiveArrival arrival;
  arrival.kind = follow_up ? bus::ports::LiveArrival::Kind::kFollowUp : bus::ports::LiveArrival::Kind::kFlexRay;
  const auto kind = input.take<std::uint8_t>();
  arrival.signal.channel = (kind & 1) != 0 ? schedules::model::Channel::kB : schedules::model::Channel::kA;
  arrival.signal.slot = 1 + static_cast<int>(input.below(45));
  const std::int64_t cycle = node.cycle() + input.take<std::int8_t>() % 4;
  arrival.cycle_counter = static_cast<std::uint8_t>(cycle & 63);
  const Microticks at = node.now() + Microticks{input.take<std::int16_t>() * 8};
  const auto late = (kind & 2) != 0 || follow_up ? std::optional(Microticks{input.take<std::int16_t>()}) : std::nullopt;
  std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
  std::size_t size = 0;
  Microticks duration{};
  if (!follow_up && (kind & 4) != 0) {
    arrival.signal.signal = static_cast<bus::ports::Signal>(1 + (kind >> 3) % 3);
    duration = Microticks{input.take<std::uint16_t>() * 16};
  } else if (!follow_up && (kind & 8) != 0) {
    const auto raw = input.bytes(8 + input.below(bus::wire::kMaxFrameBytes - 7));
    size = std::max<std::size_t>(raw.size(), 8);
    std::copy(raw.begin(), raw.end(), bytes.begin());
  } else if (!follow_up) {
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>((kind & 64) != 0 ? 1 + input.below(2047) : arrival.signal.slot);
    header.cycle = arrival.cycle_counter;
    header.sync = (kind & 16) != 0;
    header.startup = header.sync && (kind & 32) != 0;
    header.null_frame = (kind & 128) != 0;
    std::array<std::byte, 56> payload{};
    const auto content = input.bytes(56);
    std::copy(content.begin(), content.end(), payload.begin());
    size = bus::wire::encode_frame(header, arrival.signal.channel, payload, bytes);
  }
  arrival.signal.bytes = std::span<const std::byte>(bytes).first(size);
  node.arrive(arrival, at, late, duration);
}

void can_arrives(Node& node, fuzz::Source& input) {
  bus::ports::LiveArrival arrival;
  arrival.kind = bus::ports::LiveArrival::Kind::kCan;
  const auto& cluster = the_cluster();
  arrival.can_bus = cluster.can_buses.size() - 1;
  const auto& messages = cluster.can_buses[arrival.can_bus].messages;
  const std::size_t which = input.below(messages.size() + 1);
  arrival.can.identifier = which < messages.size() ? messages[which].identifier : input.take<std::uint16_t>() & 0x7FFu;
  arrival.can.flexible_data_rate = input.take<std::uint8_t>() % 8 != 0;
  std::array<std::byte, 64> data{};
  const auto content = input.bytes(64);
  std::copy(content.begin(), content.end(), data.begin());
  arrival.can.data = std::span<const std::byte>(data).first(input.take<std::uint8_t>() % 4 == 0 ? content.size() : 64);
  node.arrive(arrival, node.now() + Microticks{input.take<std::int16_t>()}, {}, {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source input(data, size);
  Node node(input.take<std::uint8_t>() % 4 != 0);
  for (int acts = 0; !input.empty() && acts < 400; ++acts) {
    switch (input.take<std::uint8_t>() % 8) {
      case 0:
      case 1:
      case 2: signal_arrives(node, input, false); break;
      case 3: signal_arrives(node, input, true); break;
      case 4: can_arrives(node, input); break;
      case 5: node.strobe(input.take<std::uint32_t>(), node.now() + Microticks{input.take<std::int16_t>() * 16}); break;
      case 6: node.go_on(node.now() + Microticks{input.take<std::uint16_t>()}); break;
      case 7: node.go_on(node.now() + Microticks{input.take<std::uint16_t>() * 8}); break;
    }
  }
  node.go_on(node.now() + Microticks{400'000});
  return 0;
}
