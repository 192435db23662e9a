// The incoming half of a line: a reader, and the arrivals that wait to be handed over.
//
// DDS' own threads take and stamp arrivals. A sample from the same machine (bus/dds/common/host_identity.h)
// arrives when its sender hands it to DDS. The clock is the same, and the reader's late wake-up says nothing
// about the sender's clock. A sample from another machine arrives at that instant by its sender's clock plus
// the recent least delay from there (bus/dds/live/arrival_instant.h). If the machines cannot be distinguished, it
// arrives when it is taken.
#pragma once

#include <array>
#include <atomic>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/live/arrival_instant.h"
#include "bus/dds/live/numbering.h"
#include "bus/dds/live/queue.h"
#include "bus/ports/live_medium.h"
#include "core/ids.h"

namespace ttf::bus::dds::live {

enum class Delivery {
  kBestEffort,  // lost samples are counted, not repeated
  kReliable,    // missing samples are repeated from the writer's last kHistory; the writer never waits
};

// Slots and identifiers of a CAN.
using Identifiers = std::bitset<2048>;

class Reception {
 public:
  struct Setting {
    ports::Line line = 0;
    std::vector<NodeId> nodes;          // the senders of the line
    NodeId self = kNoNode;              // the receiver, if it is one of them
    std::optional<Identifiers> only{};  // a listener's: of these frames the malformed ones are arrivals, too
  };
  // Throws std::runtime_error if DDS cannot.
  Reception(const common::Participant& participant, const std::string& session, const std::string& topic,
            Setting setting, Delivery delivery);
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  LiveQueue& queue() { return queue_; }
  const LiveQueue& queue() const { return queue_; }

  std::uint64_t lost() const { return lost_.load(); }
  std::uint64_t foreign() const { return foreign_.load(); }
  std::uint64_t malformed() const { return malformed_.load(); }
  std::int32_t error() const { return take_error_.load(); }  // DDS' return code, 0 without one

  // Returns the nodes whose writers this reader has found.
  std::vector<NodeId> senders() const;

 private:
  struct Boxes;  // DDS' own form of a sample

  static void on_data(common::Handle reader, void* self);
  void take(common::Handle reader);
  void accept(std::size_t box, ports::MachineTime now);
  void refuse(std::size_t box, ports::MachineTime now);
  LiveItem* room_for(std::size_t box);

  const std::string topic_;
  const Setting setting_;
  const std::uint64_t host_;
  std::array<bool, 256> is_on_{};  // by node
  const std::unique_ptr<Boxes> boxes_;
  LiveQueue queue_;
  LiveNumbering numbering_;  // used by DDS' threads only, as the next
  ArrivalInstant from_afar_;
  std::atomic<std::uint64_t> lost_{0}, foreign_{0}, malformed_{0};
  std::atomic<std::int32_t> take_error_{0};
  common::Handle reader_ = 0;
};

}  // namespace ttf::bus::dds::live
