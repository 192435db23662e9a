// What was on the channels of the simulated FlexRay, for the log: of every frame what a controller sent, what became of
// it on its way, and what a decoder makes of what arrived. Where that is not the frame as it was sent, and where no
// controller sent it, it becomes a records::ChannelFrame once it has arrived everywhere.
//
// The medium tells it of each signal's way and asks nothing: a run is the same with and without it. Only frames and
// activity that nobody can make out have a way here; symbols have none. A frame counts as what the best-placed
// receiver had: as one that nobody can make out only if that befell it at all who hear it (who sends at the same time
// does not make it out), as changed only if all who can make it out have the same other bytes. Nothing here allocates
// after construction, while there is room.
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
  static constexpr Id kNone = std::numeric_limits<Id>::max();  // of what has no way here: told of, it is ignored

  // `room`: for signals on their way at once. Where there are more, it takes more; they are fewer than kNone.
  ChannelLog(const schedules::model::GlobalParameters& flexray, std::size_t room, recording::records::Sink& sink);

  // A way begins: with what a controller sends, and its true instants at the sender; or with no controller.
  Id sent(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  Id appears(const Leaving& signal);

  // So it is on the channel, from its sender on; no bytes: they are as they were.
  void leaves(Id id, const Leaving& signal);
  // What arrived at a star's coupler as `arrived` goes on as `forwarded`: later by `branch` than at its sender.
  void regenerated(Id id, const Leaving& arrived, const Leaving& forwarded, Duration branch);
  // What the node is sending breaks off at `at`, by the sender's instants.
  void breaks_off(NodeId sender, TrueTime at);

  // One of `receivers` of it: cannot make it out; does not hear it at all; has other bytes.
  void spreads(Id id, int receivers);
  void lost(Id id);
  void unheard(Id id);
  void changed(Id id, std::span<const std::byte> bytes);

  // A way ends: nowhere, or with the last receiver. The id is another's from now on.
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
    Bytes other;                              // as receivers had it, where `changed` > 0
    TrueTime breaks_off{};                    // at or after its end: it does not
    int receivers = 0, lost = 0, changed = 0;
    bool used = false;
    bool frame = false;    // a decodable one, so far
    bool altered = false;  // not as it was sent
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
