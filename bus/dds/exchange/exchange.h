// The exchange (bus/ports/exchange.h) over Cyclone DDS: between processes of one machine or of several.
//
//   dds::Exchange exchange({.name = "drive-17", .members = all}, self);
//   exchange.wait_ready(30s);                 // everybody hears everybody
//   exchange.send(...); exchange.receive();
//   exchange.leave();                         // or the destructor: the others hear that it is gone
//
// L5 holds for the killed, too: in a supervised session they are gone when the supervisor says so
// (bus/dds/exchange/exchange_supervisor.h), and all survivors hear exactly the same messages of them. In a session
// without supervisor DDS alone knows; then a member that ends without leaving is an error of everybody else's, after
// its lease and as long again in which it may come back.
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
  // Precondition: `self` is a member. Throws InputError on a session that is none, std::runtime_error where DDS
  // does not start.
  Exchange(const common::Session& session, NodeId self);
  // Leaves, if that has not been done.
  ~Exchange() override;

  // Returns once every member (and the supervisor) hears every other; who goes before that is not waited for, and
  // receive() says so. Throws NotReady, naming those who are missing, after `patience`.
  void wait_ready(std::chrono::milliseconds patience);

  // Precondition: wait_ready() has returned.
  void send(std::span<const std::byte> message) override;
  // Besides the port's: throws std::runtime_error where samples were lost, where nobody is left to be heard, where
  // the supervisor has gone, and where this member itself has been announced gone.
  Heard receive() override;

  // The last thing the others hear. Waits until all have it, but not for long for those who do not answer.
  void leave();

 private:
  class Member;
  std::unique_ptr<Member> member_;
};

}  // namespace ttf::bus::dds::exchange
