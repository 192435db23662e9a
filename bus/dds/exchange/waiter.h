// Sleeps until one of some channels has something, or somebody calls.
#pragma once

#include <chrono>
#include <optional>

#include "bus/dds/common/participant.h"
#include "bus/dds/exchange/channel.h"

namespace ttf::bus::dds::exchange {

class Waiter {
 public:
  Waiter(const common::Participant& participant, const Channel& first, const Channel* second);
  ~Waiter();
  Waiter(const Waiter&) = delete;
  Waiter& operator=(const Waiter&) = delete;

  // Returns when a channel has something to take, or its connections have changed, or call() was called since, or
  // after `patience`, if given. Whatever woke it must be seen to, else it does not sleep next time.
  void wait(std::optional<std::chrono::nanoseconds> patience);
  // From any thread.
  void call();

 private:
  common::Handle set_ = 0;
  common::Handle called_ = 0;
};

}  // namespace ttf::bus::dds::exchange
