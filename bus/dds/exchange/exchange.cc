#include "bus/dds/exchange/exchange.h"

#include <exception>

#include "bus/dds/exchange/member.h"

namespace ttf::bus::dds::exchange {

Exchange::Exchange(const common::Session& session, NodeId self) : member_(std::make_unique<Member>(session, self)) {}

Exchange::~Exchange() {
  try {
    member_->leave();
  } catch (const std::exception&) {
    // DDS is lost; DDS or the supervisor reports that to the others.
  }
}

void Exchange::wait_ready(std::chrono::milliseconds patience) { member_->wait_ready(patience); }

void Exchange::send(std::span<const std::byte> message) { member_->send(message); }

ports::Exchange::Received Exchange::receive() { return member_->receive(); }

void Exchange::leave() { member_->leave(); }

}  // namespace ttf::bus::dds::exchange
