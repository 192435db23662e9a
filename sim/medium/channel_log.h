// Logs the channels of the simulated FlexRay: each frame as a controller sent it, its fate on the way, and a
// decoder's result at the arrival. A frame that differs from the one sent, or that no controller sent, becomes
// a records::ChannelFrame once it has arrived everywhere.
//
// The medium reports each signal's way and asks nothing: a run is the same with and without the log. Only
// frames and undecodable activity have a way here, symbols do not. A frame counts as the best-placed receiver
// had it. It is undecodable only if it was so for all its receivers (a node that sends at the same time cannot
// decode it). It is changed only if all nodes that can decode it have the same other bytes. Nothing allocates
// after construction while there is room.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "bus/ports/flexray_port.h"
#include "bus/wire/flexray_frame.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/flexray_parameters.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::medium {

class ChannelLog {
 public:
  using Id = std::uint16_t;
  static constexpr Id kNone = std::numeric_limits<Id>::max();  // a signal without a way here; it is ignored

  // `room` is for signals on their way at once. It grows if there are more; they are fewer than kNone.
  ChannelLog(const schedules::model::GlobalParameters& flexray, std::size_t room, recording::records::Sink& sink);

  // Begin a way: with a controller's transmission and its true instants at the sender, or without a controller.
  Id sent(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  Id appears(const Leaving& signal);

  // The signal is like this on the channel, from its sender on. Without bytes here, its bytes are unchanged.
  void leaves(Id id, const Leaving& signal);
  // A signal that arrived at a star's coupler as `arrived` goes on as `forwarded`, later by `branch` than at
  // its sender.
  void regenerated(Id id, const Leaving& arrived, const Leaving& forwarded, Duration branch);
  // The node's signal breaks off at `at`, by the sender's instants.
  void breaks_off(NodeId sender, TrueTime at);

  // The signal spreads to `receivers`. One of them cannot decode it, does not receive it, or has other bytes.
  void spreads(Id id, int receivers);
  void lost(Id id);
  void not_received(Id id);
  void changed(Id id, std::span<const std::byte> bytes);

  // End a way: nowhere, or at its last receiver. The id is free from then on.
  void withheld(Id id);
  void arrived(Id id);

 private:
  struct Bytes {
    std::array<std::byte, bus::wire::kMaxFrameBytes> room{};
    std::size_t size = 0;
    std::span<const std::byte> all() const { return std::span<const std::byte>(room).first(size); }
    void set(std::span<const std::byte> bytes);
  };
  struct Way {
    recording::records::ChannelFrame record;  // without state and bytes
    Bytes bytes;                              // as it left
    Bytes other;                              // as receivers had it, if `changed` > 0
    TrueTime breaks_off{};                    // at or after its end: it does not break off
    int receivers = 0, lost = 0, changed = 0;
    bool used = false;
    bool frame = false;    // a decodable one, so far
    bool altered = false;  // differs from the one sent
    bool unlike = false;   // receivers have different bytes
  };
  void add_ways(std::size_t count);
  Way& take(Id& id);
  void report(Way& way);
  std::size_t bytes_until_break(const Way& way) const;

  const std::int64_t bit_ps_;
  const std::int64_t bits_before_bytes_;  // the transmission and frame start sequences
  recording::records::Sink& sink_;
  std::vector<Way> ways_;
  std::vector<Id> free_;
};

}  // namespace ttf::sim::medium
