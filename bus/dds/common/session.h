// A session: the members of one launch on DDS, with or without an exchange supervisor.
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
  std::string name;             // separates launches on one domain: 1 to 64 letters, digits, '_', '-', '.'
  std::vector<NodeId> members;  // all members, each once, this one included
  bool supervised = true;       // an ExchangeSupervisor runs, and only it announces members gone
  // A participant that is silent for that long counts as gone (unless CYCLONEDDS_URI says otherwise).
  std::chrono::milliseconds lease{10'000};
};

// Throws InputError with one finding for each value out of range; returns the session.
const Session& validate(const Session& session);

// Some members were not ready in time.
class NotReady : public std::runtime_error {
 public:
  // `absent`: not received. `deaf`: not receiving all others yet; empty if a member is absent. kNoNode stands for
  // the supervisor.
  NotReady(const Session& session, std::chrono::milliseconds waited, std::vector<NodeId> absent,
           std::vector<NodeId> deaf);
  const std::vector<NodeId>& absent() const { return absent_; }
  const std::vector<NodeId>& deaf() const { return deaf_; }

 private:
  std::vector<NodeId> absent_;
  std::vector<NodeId> deaf_;
};

}  // namespace ttf::bus::dds::common
