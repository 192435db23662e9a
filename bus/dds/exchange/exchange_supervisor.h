// The exchange supervisor watches over an exchange (bus/dds/exchange/exchange.h). It has the members that
// have joined and left. It brings all survivors to receive the same of a member that died. It takes no part in
// the messages, and so costs them nothing.
//
// Its announcements are final: an announced member is gone, even if it still lives. The process that started the
// members announces each that has ended, in whatever way. An announcement has no effect if the member had left before.
//
// It works in a thread of its own. All functions may be called from any thread.
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
    kJoined,  // it said hello
    kReady,   // it receives all others
    kLeft,    // it said goodbye
    kLost,    // DDS has received nothing of it for its lease; it may be dead, stopped or cut off
    kBack,    // DDS receives it again
    kGone,    // every survivor has received its end
  };
  struct Event {
    What what{};
    NodeId node{};
    // For kGone: the number of its samples that the survivors have received, hello and goodbye included.
    std::uint64_t samples = 0;
  };

  // Precondition: session.supervised. Throws as dds::Exchange does.
  explicit ExchangeSupervisor(const common::Session& session);
  // Remaining members receive the supervisor's goodbye, and stop.
  ~ExchangeSupervisor();

  // Returns once all members that are not gone receive each other; throws as Exchange::wait_ready() does.
  void wait_ready(std::chrono::milliseconds patience);
  // Returns at once; kGone follows. A known end has no effect.
  void announce_gone(NodeId node);
  // Returns the next event; no value after `patience`. Throws std::runtime_error if DDS is lost.
  std::optional<Event> next_event(std::chrono::milliseconds patience);

 private:
  class Watch;
  std::unique_ptr<Watch> watch_;
};

}  // namespace ttf::bus::dds::exchange
