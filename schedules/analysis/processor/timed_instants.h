// The instants at which time activates a node's chains of tasks, and how far they are apart by the node's own clock.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ttf::schedules::analysis::processor {

// A clock that follows global time: what its corrections may take away, external terms included.
struct ClockCorrections {
  std::int64_t cycle_ns = 1;
  std::int64_t microticks = 1;  // of a cycle
  std::int64_t rate = 0;        // of these, from every cycle at most
  std::int64_t offset_ns = 0;   // from every second cycle at most

  // A distance of global time by this clock, at the least.
  std::int64_t shortest(std::int64_t global_ns) const;
};

class TimedInstants {
 public:
  struct Instant {
    std::int64_t at = 0;  // nanoseconds of global time
    std::size_t chain = 0;
    auto operator<=>(const Instant&) const = default;
  };

  // A chain's instant, so far from another at the least, by the node's clock.
  struct Neighbour {
    std::int64_t distance = 0;
    std::size_t chain = 0;
  };

  enum Direction : bool { kBackward, kForward };

  TimedInstants() = default;
  // The instants of one round; no corrections for a node without global time.
  TimedInstants(std::vector<Instant> instants, std::int64_t round_ns, std::optional<ClockCorrections> corrections);

  bool empty() const { return instants_.empty(); }
  std::size_t size() const { return instants_.size(); }
  std::size_t chain(std::size_t instant) const { return instants_[instant].chain; }

  // Corrections that eat up rounds leave no clock to count on, and within() would not end.
  bool can_be_counted_on() const;

  // A distance of global time by the node's clock, at the least.
  std::int64_t shortest(std::int64_t global_ns) const;

  // From an instant on, or back from it, those that may be no more than `most` away from it, itself included: in the
  // order of global time, up to the first that is further away.
  std::vector<Neighbour> within(std::size_t instant, std::int64_t most, Direction direction) const;

 private:
  // Counted on beyond the round's last, and back below its first.
  Instant numbered(std::int64_t number) const;

  std::vector<Instant> instants_;
  std::int64_t round_ns_ = 0;
  std::optional<ClockCorrections> corrections_;
};

}  // namespace ttf::schedules::analysis::processor
