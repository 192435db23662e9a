// The effect of a node's end on its launch, and the steps of a stop: pure functions of time.
//
// Times are durations since the launch began.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/time.h"

namespace ttf::cli::supervision {

enum class Policy : std::uint8_t {
  kRequired,  // its failure stops all nodes
  kRestart,   // it starts again after a back-off; after the last attempt it counts as kRequired
  kOptional,  // its failure is reported, and the others continue; only the ready barrier waits for it
};
std::string_view name_of(Policy policy);  // "required", "restart", "optional"
std::optional<Policy> policy_of(std::string_view name);

// The wait before each restart of one node: it doubles up to a limit, a limited number of times. Both start
// anew after a process has run for `settled`.
class Backoff {
 public:
  struct Limits {
    Duration first = Duration::milliseconds(500);
    Duration most = Duration::milliseconds(10'000);
    int count = 5;
    Duration settled = Duration::milliseconds(60'000);
  };
  explicit Backoff(const Limits& limits) : limits_(limits) {}

  // Returns the wait after a process that lasted `lasted`; no value after the last attempt.
  std::optional<Duration> next(Duration lasted);
  int tried() const { return tried_; }

 private:
  Limits limits_;
  int tried_ = 0;
};

// The signals of an ordered stop: SIGINT, SIGTERM after a grace, SIGKILL after another.
class StopOrder {
 public:
  struct Grace {
    Duration interrupt = Duration::milliseconds(5'000);
    Duration terminate = Duration::milliseconds(2'000);
  };
  explicit StopOrder(const Grace& grace) : grace_(grace) {}

  bool begun() const { return signal_ != 0; }
  // Returns the last signal due; 0 before the stop.
  int signal() const { return signal_; }
  // Returns SIGINT if the stop has not begun.
  std::optional<int> begin(Duration now);
  // Returns the next signal at once, for an impatient user; no value after SIGKILL.
  std::optional<int> hurry(Duration now);
  // Returns the next signal if its instant has come.
  std::optional<int> due(Duration now);
  std::optional<Duration> next_instant() const { return next_; }

 private:
  int signal_ = 0;
  Grace grace_;
  std::optional<Duration> next_;
};

}  // namespace ttf::cli::supervision
