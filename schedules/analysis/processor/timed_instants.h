// The instants at which time activates a node's chains of tasks, and their distances on the node's own clock.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ttf::schedules::analysis::processor {

// A clock that follows global time: the most that its corrections can shorten, external terms included.
struct ClockCorrections {
  std::int64_t cycle_ns = 1;
  std::int64_t microticks = 1;  // in a cycle
  std::int64_t rate = 0;        // most microticks taken from a cycle
  std::int64_t offset_ns = 0;   // most time taken from every second cycle

  // Returns the shortest time on this clock for a distance of global time.
  std::int64_t shortest(std::int64_t global_ns) const;
};

class TimedInstants {
 public:
  struct Instant {
    std::int64_t at = 0;  // nanoseconds of global time
    std::size_t chain = 0;
    auto operator<=>(const Instant&) const = default;
  };

  // An instant of a chain, at least `distance` from another on the node's clock.
  struct Neighbour {
    std::int64_t distance = 0;
    std::size_t chain = 0;
  };

  enum Direction : bool { kBackward, kForward };

  TimedInstants() = default;
  // Takes the instants of one round; no corrections for a node without global time.
  TimedInstants(std::vector<Instant> instants, std::int64_t round_ns, std::optional<ClockCorrections> corrections);

  bool empty() const { return instants_.empty(); }
  std::size_t size() const { return instants_.size(); }
  std::size_t chain(std::size_t instant) const { return instants_[instant].chain; }

  // Returns false if corrections can shorten a round to less than half: within() might then not end.
  bool can_be_counted_on() const;

  // Returns the shortest time on the node's clock for a distance of global time.
  std::int64_t shortest(std::int64_t global_ns) const;

  // Returns the instants from one instant on, or back from it, that may be at most `most` away, itself included.
  // They are in the order of global time, up to the first that is further away.
  std::vector<Neighbour> within(std::size_t instant, std::int64_t most, Direction direction) const;

 private:
  // Returns an instant by its number, continued beyond the round's last and before its first.
  Instant numbered(std::int64_t number) const;

  std::vector<Instant> instants_;
  std::int64_t round_ns_ = 0;
  std::optional<ClockCorrections> corrections_;
};

}  // namespace ttf::schedules::analysis::processor
