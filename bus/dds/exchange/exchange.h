// The exchange (bus/ports/exchange.h) over Cyclone DDS: between processes of one machine or of several.
//
//   dds::Exchange exchange({.name = "drive-17", .members = all}, self);
//   exchange.wait_ready(30s);                 // all members receive each other
//   exchange.send(...); exchange.receive();
//   exchange.leave();                         // or the destructor: the others are informed that it is gone
//
// L5 also holds for killed members. In a supervised session the supervisor announces them gone
// (bus/dds/exchange/exchange_supervisor.h), and all survivors receive exactly the same messages of them. In a
// session without supervisor only DDS notices an end. There a member that ends without leaving is an error for
// all others. The error comes after its lease and as long again, in which it may come back.
//
// An object belongs to one thread at a time.
#pragma once

#include <chrono>
#include <memory>
#include <span>

#include "bus/dds/common/session.h"
#include "bus/ports/exchange.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class Exchange final : public ports::Exchange {
 public:
  // Precondition: `self` is a member. Throws InputError on an invalid session, std::runtime_error if DDS does
  // not start.
  Exchange(const common::Session& session, NodeId self);
  // Leaves, if that has not been done.
  ~Exchange() override;

  // Returns once all members, and the supervisor, receive each other. It does not wait for members that have
  // gone; receive() reports those. Throws NotReady, naming the missing ones, after `patience`.
  void wait_ready(std::chrono::milliseconds patience);

  // Precondition: wait_ready() has returned.
  void send(std::span<const std::byte> message) override;
  // Besides the port's errors: throws std::runtime_error if samples were lost or if all others are gone. So it
  // does if the supervisor has gone or has announced this member gone.
  Received receive() override;

  // Says goodbye to the others. Waits until all have it, but only briefly for members that do not answer.
  void leave();

 private:
  class Member;
  std::unique_ptr<Member> member_;
};

}  // namespace ttf::bus::dds::exchange
