// A waiter sleeps until a DDS channel has samples, or until another thread calls.
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

  // Returns when a channel has samples to take, when its connections have changed, when call() was called
  // since, or after `patience`, if given. The cause must be dealt with, or the next wait() returns at once.
  void wait(std::optional<std::chrono::nanoseconds> patience);
  // Ends or prevents the next sleep; from any thread.
  void call();

 private:
  common::Handle set_ = 0;
  common::Handle called_ = 0;
};

}  // namespace ttf::bus::dds::exchange
