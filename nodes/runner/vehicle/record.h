// The record of a vehicle that commands drive. In real time each process that needs the vehicle's state has one. The
// vehicle's way is a pure function of its actuations (sim/world/vehicle/driven.h). So processes send each other
// actuations, not states. They travel beside the bus (nodes/runner/vehicle/line.h).
//
// An actuation is known a dead time before it begins. A message may take that long.
//   lost        each message repeats the actuations before it, kRepeated in all; so the next one makes it good
//   late        earlier looks at its instant or beyond were without it, later ones are with it; counted
//   twice, or in another order      no difference
//   more lost than are repeated     the record is not whole: the process asks, and processes with a whole one answer
//   a process that begins later     likewise
//
// This is the pure part: messages in, messages out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/world/vehicle/driven.h"

namespace ttf::nodes::runner::vehicle {

struct Counts {
  std::uint64_t reported = 0, received = 0;  // actuations: of this process; of others, each once
  std::uint64_t late = 0;                    // among those received
  std::uint64_t gaps = 0;                    // times that the record was found not to be whole
  std::uint64_t malformed = 0;               // messages
  bool whole = true;                         // now
};

class Record {
 public:
  static constexpr std::size_t kRepeated = 8, kPage = 256;
  static constexpr std::size_t kHead = 24, kEach = 24;  // bytes
  static constexpr std::size_t kLargest = kHead + kPage * kEach;

  // `driven` outlives this.
  explicit Record(sim::world::vehicle::Driven& driven) : driven_(driven) {}

  // The process begins later than the drive, so that it lacks what was before.
  void begins_later() { counts_.whole = false; }

  // Adds an actuation of this process. Returns the message for all others; valid until the next call of a member.
  std::span<const std::byte> report(const sim::world::vehicle::Actuation& actuation);
  // Returns the question about missing actuations, to all others.
  std::span<const std::byte> ask();

  struct Reaction {
    std::span<const std::byte> answer;  // to the sender of the message; empty: none
    bool asks = false;                  // ask() is due
  };
  // Takes a message of another process.
  Reaction take(std::span<const std::byte> message);

  bool whole() const { return counts_.whole; }
  const Counts& counts() const { return counts_; }

 private:
  using Actuation = sim::world::vehicle::Actuation;
  enum class Kind : std::uint32_t { kReported = 1, kQuestion = 2, kAnswer = 3, kLastAnswer = 4 };
  struct Message {
    Kind kind{};
    std::int64_t after = 0;  // [ns]: questions and answers are about actuations after this instant
    std::size_t count = 0;
    std::array<Actuation, kPage> actuations;
  };
  std::span<const std::byte> written(Kind kind, std::int64_t after, std::span<const Actuation> actuations);
  bool read(std::span<const std::byte> bytes);
  bool has(const Actuation& actuation) const;
  void add(std::span<const Actuation> received);
  Reaction reported(std::span<const Actuation> received);
  std::span<const std::byte> answer(std::int64_t after);

  sim::world::vehicle::Driven& driven_;
  Counts counts_;
  std::array<Actuation, kRepeated> newest_{};  // this process's own, oldest first
  // [ns]: nothing is missing up to the first instant; the record is whole once that is so up to the second.
  std::int64_t complete_to_ = 0, needed_to_ = 0;
  Message in_;
  std::array<std::byte, kLargest> out_{};
};

}  // namespace ttf::nodes::runner::vehicle
