// What becomes of a launch when one of its nodes ends, and how a launch is stopped: pure steps over time.
//
// Times are durations since the launch began.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/time.h"

namespace ttf::cli::supervision {

enum class Policy : std::uint8_t {
  kRequired,  // its failure stops all
  kRestart,   // it is started again, after a back-off; when that has been tried often enough, it is as kRequired
  kOptional,  // its failure is said, and the others go on; nobody waits for it longer than the ready barrier lasts
};
std::string_view name_of(Policy policy);  // "required", "restart", "optional"
std::optional<Policy> policy_of(std::string_view name);

// How long to wait before each restart of one node: doubling, capped, limited in number. Both begin anew once a process
// has kept going for `settled`.
class Backoff {
 public:
  struct Limits {
    Duration first = Duration::milliseconds(500);
    Duration most = Duration::milliseconds(10'000);
    int count = 5;
    Duration settled = Duration::milliseconds(60'000);
  };
  explicit Backoff(const Limits& limits) : limits_(limits) {}

  // After a process that lasted `lasted`; nothing: it has been tried often enough.
  std::optional<Duration> next(Duration lasted);
  int tried() const { return tried_; }

 private:
  Limits limits_;
  int tried_ = 0;
};

// The signals of an ordered stop: SIGINT, after a grace SIGTERM, after another SIGKILL, which needs none.
class StopOrder {
 public:
  struct Grace {
    Duration interrupt = Duration::milliseconds(5'000);
    Duration terminate = Duration::milliseconds(2'000);
  };
  explicit StopOrder(const Grace& grace) : grace_(grace) {}

  bool begun() const { return signal_ != 0; }
  // The last signal that was due; 0 before the stop.
  int signal() const { return signal_; }
  // SIGINT, if the stop has not begun.
  std::optional<int> begin(Duration now);
  // The next signal at once: somebody is impatient. Nothing after SIGKILL.
  std::optional<int> hurry(Duration now);
  // The next signal, if its instant has come.
  std::optional<int> due(Duration now);
  std::optional<Duration> next_instant() const { return next_; }

 private:
  int signal_ = 0;
  Grace grace_;
  std::optional<Duration> next_;
};

}  // namespace ttf::cli::supervision
