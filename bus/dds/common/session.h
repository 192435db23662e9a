// Who talks to whom over DDS: the members of one launch, and whether somebody watches over them.
#pragma once

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/ids.h"

namespace ttf::bus::dds::common {

struct Session {
  std::uint32_t domain = 0;     // 0..231 (kMaxDomain)
  std::string name;             // keeps launches on one domain apart: 1 to 64 letters, digits, '_', '-', '.'
  std::vector<NodeId> members;  // all of them, each once, whoever reads this
  bool supervised = true;       // there is an ExchangeSupervisor, and nobody is gone until it says so
  // A participant from which nothing has come for so long is taken to be gone (unless CYCLONEDDS_URI says otherwise).
  std::chrono::milliseconds lease{10'000};
};

// Throws InputError with one finding for each value out of range; returns the session.
const Session& validate(const Session& session);

// Not everybody was there in time.
class NotReady : public std::runtime_error {
 public:
  // `absent`: not heard; `deaf`, if none is absent: do not hear everybody yet. kNoNode stands for the supervisor.
  NotReady(const Session& session, std::chrono::milliseconds waited, std::vector<NodeId> absent,
           std::vector<NodeId> deaf);
  const std::vector<NodeId>& absent() const { return absent_; }
  const std::vector<NodeId>& deaf() const { return deaf_; }

 private:
  std::vector<NodeId> absent_;
  std::vector<NodeId> deaf_;
};

}  // namespace ttf::bus::dds::common
