// A CAN without time, for tests of its contents: frames go one after the other, in order of the port's laws.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bus/ports/can_port.h"

namespace ttf::bus {

class TestCan {
 public:
  // Called for each controller that a frame reaches.
  using Receive = std::function<void(std::size_t controller, const ttf::bus::ports::CanFrame& frame)>;

  TestCan(std::size_t controllers, Receive receive) : receive_(std::move(receive)) {
    for (std::size_t c = 0; c < controllers; ++c) ports_.push_back(std::make_unique<Port>(*this, c));
  }
  std::size_t controllers() const { return ports_.size(); }
  ports::CanPort& port(std::size_t controller) { return *ports_[controller]; }

  // On an idle bus the next frame begins; it can no longer be displaced.
  void begin() {
    if (sending_ || waiting_.empty()) return;
    // The oldest of equals, which is the order they were handed over in.
    const auto winner = std::min_element(waiting_.begin(), waiting_.end(), [](const Frame& a, const Frame& b) {
      return a.identifier != b.identifier ? a.identifier < b.identifier : a.sender < b.sender;
    });
    sending_ = std::move(*winner);
    waiting_.erase(winner);
  }
  // The frame on the bus, if any, ends.
  void end() {
    if (!sending_) return;
    const Frame frame = std::move(*sending_);
    sending_
        .reset();  // the bus is idle before any node receives the frame, so an answer takes part in the next arbitration
    for (std::size_t c = 0; c < ports_.size(); ++c)
      if (c != frame.sender) receive_(c, {frame.identifier, frame.flexible_data_rate, frame.data});
  }
  void run_until_idle() {
    for (begin(); sending_; begin()) end();
  }

 private:
  struct Frame {
    std::size_t sender = 0;
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::vector<std::byte> data;
  };
  struct Port final : ports::CanPort {
    TestCan& bus;
    std::size_t controller;
    Port(TestCan& b, std::size_t c) : bus(b), controller(c) {}
    void send(const ports::CanFrame& frame) override {
      bus.waiting_.push_back(
          {controller, frame.identifier, frame.flexible_data_rate, {frame.data.begin(), frame.data.end()}});
    }
  };

  Receive receive_;
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<Frame> waiting_;
  std::optional<Frame> sending_;
};

}  // namespace ttf::bus
