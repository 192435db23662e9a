#include "bus/dds/exchange/waiter.h"

#include <dds/dds.h>

#include <algorithm>

namespace ttf::bus::dds::exchange {

Waiter::Waiter(const common::Participant& participant, const Channel& first, const Channel* second) {
  constexpr auto kWhat = "cannot wait";
  set_ = common::checked(dds_create_waitset(participant.handle()), kWhat);
  called_ = common::checked(dds_create_guardcondition(participant.handle()), kWhat);
  common::checked(dds_waitset_attach(set_, called_, 0), kWhat);
  for (const Channel* channel : {&first, second}) {
    if (channel == nullptr) continue;
    common::checked(dds_waitset_attach(set_, channel->reading(), 0), kWhat);
    common::checked(dds_waitset_attach(set_, channel->reader(), 0), kWhat);
  }
}

Waiter::~Waiter() = default;  // the participant ends it all

void Waiter::wait(std::optional<std::chrono::nanoseconds> patience) {
  const dds_duration_t timeout = patience ? std::max<dds_duration_t>(patience->count(), 0) : DDS_INFINITY;
  common::checked(dds_waitset_wait(set_, nullptr, 0, timeout), "cannot wait");
  bool called = false;
  common::checked(dds_take_guardcondition(called_, &called), "cannot wait");
}

void Waiter::call() { common::checked(dds_set_guardcondition(called_, true), "cannot wake up"); }

}  // namespace ttf::bus::dds::exchange
