// Who watches over an exchange (bus/dds/exchange/exchange.h): knows who has joined and left, and sees to it that all
// survivors hear the same of a member that died. It takes no part in the messages themselves, and so costs them
// nothing.
//
// Its word counts: who has been announced gone is gone for good, even if it should still live. Whoever started the
// processes announces each that has ended, in whatever way; where a member had left before, nothing changes.
//
// Works in a thread of its own. All functions may be called from any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "bus/dds/common/session.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class ExchangeSupervisor {
 public:
  enum class What : std::uint8_t {
    kJoined,  // it says hello
    kReady,   // it hears everybody
    kLeft,    // it said goodbye
    kLost,    // DDS has heard nothing of it for its lease; it may be dead, stopped or cut off
    kBack,    // DDS hears it again
    kGone,    // every survivor has heard that it is gone
  };
  struct Event {
    What what{};
    NodeId node{};
    // Of kGone: how many of its samples the survivors have heard, its hello and goodbye among them.
    std::uint64_t samples = 0;
  };

  // Precondition: session.supervised. Throws as dds::Exchange does.
  explicit ExchangeSupervisor(const common::Session& session);
  // Members that are still there hear that the supervisor has left, and stop.
  ~ExchangeSupervisor();

  // Returns once every member that is not gone hears every other; throws as Exchange::wait_ready() does.
  void wait_ready(std::chrono::milliseconds patience);
  // Returns at once; kGone follows. What is known already changes nothing.
  void announce_gone(NodeId node);
  // The next thing that happened; nothing after `patience`. Throws std::runtime_error where DDS is lost.
  std::optional<Event> next_event(std::chrono::milliseconds patience);

 private:
  class Watch;
  std::unique_ptr<Watch> watch_;
};

}  // namespace ttf::bus::dds::exchange
