// Finds the reasons of missing frames. A receiver cannot distinguish lost frames from frames that were not sent; the
// senders' logs can.
//
// A record of `count` lost frames covers the last `count` turns of its slot before its cycle. Each of these is
//
//   withheld   a sender recorded the slot as missed: it woke up too late
//   away       a sender recorded no frame in the turn, but some before and after it: it was not in operation
//   neither    the frame was lost on the way
//
// Two records are of one turn if slot, channel and cycle counter agree, and their instants differ by less than
// half a round of that counter. Each node numbers its rounds for itself, and anew after a restart, so running
// cycles and global times do not compare. True times do, on one scale (recording/merge/common_time.h): a
// record's true time minus its lateness is near enough to the instant at which the turn was due.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "schedules/model/round.h"

namespace ttf::evaluation::lateness {

// Counts of the frames that never came to a node, by reason.
struct MissingFramesCount {
  std::uint64_t withheld = 0, away = 0;
};

class MissingFrames {
 public:
  MissingFrames(const schedules::model::Cluster& cluster, std::int64_t time_scale_ppm)
      : cluster_(cluster), time_scale_ppm_(time_scale_ppm) {}

  // Takes the two kinds that matter, in any order; ignores others.
  void add(const recording::records::TimingProblem& problem);
  // Takes each node's frames in the order of time.
  void add(const recording::records::SlotFrameSent& frame);

  // Lists only nodes that lack frames.
  std::map<NodeId, MissingFramesCount> by_receiver() const;

 private:
  // A slot's turn: its instant in the drive's time, and its cycle by the node's own count.
  struct Turn {
    std::int64_t due_ns = 0;
    std::int64_t cycle = 0;
  };
  struct Silence {
    Turn before, behind;  // the last frame before it, and the first after it
  };
  // The known acts of a sender in a slot of a channel.
  struct Sender {
    std::bitset<schedules::model::kMostCycles> turns;  // by cycle counter
    std::vector<Turn> missed;
    std::vector<Silence> silences;  // in the order of time
    std::optional<Turn> last;       // the last one it sent
  };
  using Place = std::tuple<std::uint16_t, std::uint8_t, NodeId>;  // slot, channel, sender
  struct Lost {
    Turn came;  // the frame that showed the loss
    NodeId receiver{};
    std::uint16_t slot = 0;
    std::uint8_t channel = 0;
    std::uint32_t count = 0;
  };
  std::int64_t due_ns(const recording::records::TimingProblem& problem) const;
  std::int64_t turns_before(const Sender& sender, std::int64_t cycle, std::int64_t first_back,
                            std::int64_t last_back) const;
  Sender& sender_at(const Place& place);
  std::optional<std::int64_t> cycles_from(const Turn& earlier, const Turn& later) const;
  std::int64_t reach_of(const Lost& lost) const;
  MissingFramesCount count(const Lost& lost, std::int64_t reach, const Sender& sender) const;

  const schedules::model::Cluster& cluster_;
  const std::int64_t time_scale_ppm_;
  const std::int64_t cycles_ = cycles_per_round(cluster_.flexray);
  std::map<Place, Sender> senders_;
  std::vector<Lost> lost_;
};

}  // namespace ttf::evaluation::lateness
