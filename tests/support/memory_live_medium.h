// The live medium (bus/ports/live_medium.h) between members of one process, each in its own thread or all in
// one: the simplest lawful implementation.
//
//   MemoryLiveBus bus({.can_buses = {false, true}});
//   auto a = bus.join(), b = bus.join({0, 1, line_of_can(0)});       // all before the first send
//   a->send(...);  b->receive();
//
// A frame has arrived when send() returns. Each member has room for some signals on each line; further ones
// are lost, and counted by that member. A member that does not receive does not disturb others. A member may
// outlive the bus.
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/ports/live_medium.h"
#include "bus/wire/flexray_frame.h"
#include "core/check.h"

namespace ttf::test {

enum class Reported { kWithTheFrame, kInAFollowUp };  // how late a sync frame left

struct MemoryLiveBusOptions {
  std::vector<bool> can_buses;  // whether each carries CAN FD: only the laws use it
  Reported reported = Reported::kWithTheFrame;
  std::size_t room = 1024;  // signals and follow-ups on each line of each member
  std::function<bus::ports::MachineTime()> now = bus::ports::host_now;
};

class MemoryLiveBus {
 public:
  explicit MemoryLiveBus(MemoryLiveBusOptions options = {}) : hub_(std::make_shared<Hub>()) {
    hub_->options = std::move(options);
  }

  // One more member, on all lines or on some.
  std::unique_ptr<bus::ports::LiveMedium> join() {
    std::vector<bus::ports::Line> all(lines());
    for (bus::ports::Line line = 0; line < all.size(); ++line) all[line] = line;
    return join(all);
  }
  std::unique_ptr<bus::ports::LiveMedium> join(const std::vector<bus::ports::Line>& lines) {
    auto member = std::make_shared<Member>(this->lines(), lines, hub_->options.room);
    const std::scoped_lock lock(hub_->mutex);
    hub_->members.push_back(member);
    return std::make_unique<Endpoint>(hub_, std::move(member));
  }
  std::size_t lines() const { return bus::ports::line_of_can(hub_->options.can_buses.size()); }

  // Gives every member on that CAN a report, as of its own controller.
  void report(std::size_t can_bus, const bus::ports::CanReport& report) {
    const std::scoped_lock lock(hub_->mutex);
    bus::ports::LiveArrival arrival;
    arrival.kind = bus::ports::LiveArrival::Kind::kCanReport;
    arrival.at = arrival.received = hub_->options.now();
    arrival.can_bus = can_bus;
    arrival.report = report;
    for (const auto& member : hub_->members)
      if (Queue& queue = member->queues[bus::ports::line_of_can(can_bus)]; queue.event >= 0) queue.keep(arrival, {});
  }

  // Puts a foreign frame, or a malformed one in our form, on a line: all members there count it.
  void intrude(bus::ports::Line line, std::uint64_t bus::ports::LiveCounts::*counted) {
    const std::scoped_lock lock(hub_->mutex);
    for (const auto& member : hub_->members)
      if (member->is_on(line)) ++(member->counts.*counted);
  }

 private:
  struct Kept {
    bus::ports::LiveArrival arrival;  // its spans are empty
    std::size_t size = 0;
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
  };
  // The signals that wait on one line for one member: a ring of fixed size.
  struct Queue {
    std::vector<Kept> ring;
    std::size_t first = 0, count = 0;
    int event = -1;
    bool watched = false;

    // Precondition: there is room.
    void keep(const bus::ports::LiveArrival& arrival, std::span<const std::byte> bytes) {
      Kept& kept = ring[(first + count++) % ring.size()];
      kept.arrival = arrival;
      kept.size = bytes.size();
      std::copy(bytes.begin(), bytes.end(), kept.bytes.begin());
      ring_bell();
    }
    void ring_bell() const {
      if (watched && count > 0) eventfd_write(event, 1);
    }
    void silence() const {
      eventfd_t ignored = 0;
      eventfd_read(event, &ignored);
    }
  };
  struct Member {
    Member(std::size_t all, const std::vector<bus::ports::Line>& lines, std::size_t room) : queues(all) {
      for (const bus::ports::Line line : lines) {
        queues[line].ring.resize(room);
        queues[line].event = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
        TTF_CHECK(queues[line].event >= 0);
      }
    }
    ~Member() {
      for (const Queue& queue : queues)
        if (queue.event >= 0) close(queue.event);
    }
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;
    bool is_on(bus::ports::Line line) const { return queues[line].event >= 0; }

    std::vector<Queue> queues;
    bus::ports::LiveCounts counts;
  };
  struct Hub {
    MemoryLiveBusOptions options;
    std::mutex mutex;
    std::vector<std::shared_ptr<Member>> members;  // guarded by mutex, including their contents
  };

  class Endpoint final : public bus::ports::LiveMedium {
   public:
    Endpoint(std::shared_ptr<Hub> hub, std::shared_ptr<Member> self) : hub_(std::move(hub)), self_(std::move(self)) {}

    bus::ports::LiveStatus send(const bus::ports::LiveSignal& signal, bus::ports::MachineTime due) override {
      const std::scoped_lock lock(hub_->mutex);
      const bus::ports::MachineTime now = hub_->options.now();
      bus::ports::LiveArrival arrival;
      arrival.at = arrival.received = now;
      arrival.left = now;
      arrival.signal = signal;
      arrival.signal.bytes = {};
      const bool states = signal.states_late;
      const bool follows = states && hub_->options.reported == Reported::kInAFollowUp;
      if (states && !follows) arrival.late = now - due;
      carry(arrival, bus::ports::line_of(signal.channel), signal.bytes);
      if (follows) {
        bus::ports::LiveArrival follow_up = arrival;
        follow_up.kind = bus::ports::LiveArrival::Kind::kFollowUp;
        follow_up.cycle_counter = bus::wire::header_of(signal.bytes).value_or(bus::wire::FrameHeader{}).cycle;
        follow_up.late = now - due;
        carry(follow_up, bus::ports::line_of(signal.channel), {});
      }
      ++self_->counts.sent;
      return bus::ports::LiveStatus::kDone;
    }
    bus::ports::LiveStatus send_can(std::size_t can_bus, const bus::ports::CanFrame& frame) override {
      const std::scoped_lock lock(hub_->mutex);
      bus::ports::LiveArrival arrival;
      arrival.kind = bus::ports::LiveArrival::Kind::kCan;
      arrival.at = arrival.received = hub_->options.now();
      arrival.left = arrival.at;
      arrival.can_bus = can_bus;
      arrival.can = frame;
      arrival.can.data = {};
      carry(arrival, bus::ports::line_of_can(can_bus), frame.data);
      ++self_->counts.sent;
      return bus::ports::LiveStatus::kDone;
    }

    std::optional<bus::ports::LiveArrival> receive() override {
      const std::scoped_lock lock(hub_->mutex);
      for (Queue& queue : self_->queues) {
        if (queue.count == 0) continue;
        last_ = queue.ring[queue.first];  // it stays until the next call
        queue.first = (queue.first + 1) % queue.ring.size();
        if (--queue.count == 0) queue.silence();
        const auto bytes = std::span(last_.bytes).first(last_.size);
        bus::ports::LiveArrival arrival = last_.arrival;
        if (arrival.kind == bus::ports::LiveArrival::Kind::kCan)
          arrival.can.data = bytes;
        else
          arrival.signal.bytes = bytes;
        self_->counts.received += arrival.kind != bus::ports::LiveArrival::Kind::kFollowUp;
        return arrival;
      }
      return {};
    }

    int descriptor(bus::ports::Line line) const override { return self_->queues[line].event; }
    void watch(bus::ports::Line line, bool on) override {
      const std::scoped_lock lock(hub_->mutex);
      self_->queues[line].watched = on;
      self_->queues[line].ring_bell();
    }
    bus::ports::LiveCounts counts() const override {
      const std::scoped_lock lock(hub_->mutex);
      return self_->counts;
    }
    const std::string& failure() const override { return failure_; }

   private:
    void carry(const bus::ports::LiveArrival& arrival, bus::ports::Line line, std::span<const std::byte> bytes) {
      TTF_CHECK(self_->is_on(line) && bytes.size() <= bus::wire::kMaxFrameBytes, "line {}, {} bytes", line,
                bytes.size());
      for (const auto& member : hub_->members) {
        Queue& queue = member->queues[line];
        if (member == self_ || queue.event < 0) continue;
        if (queue.count == queue.ring.size()) {
          member->counts.lost += arrival.kind != bus::ports::LiveArrival::Kind::kFollowUp;
          continue;
        }
        queue.keep(arrival, bytes);
      }
    }

    std::shared_ptr<Hub> hub_;
    std::shared_ptr<Member> self_;
    Kept last_;
    std::string failure_;
  };

  std::shared_ptr<Hub> hub_;
};

}  // namespace ttf::test
