// Drives what an experiment asks for and its store does not have yet, on as many workers as there are.
//
// What a store holds in the end is the same for any number of workers, and however often it was interrupted: every run
// is a function of its key, and a point is looked at, for the stop rule, only when a whole batch of its replications is
// there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "experiments/results/shard.h"
#include "experiments/results/store.h"
#include "experiments/sweep/run.h"

namespace ttf::experiments::sweep {

struct SweepProgress {
  std::uint64_t done = 0, all = 0;  // runs of this shard; with a stop rule `all` may not be needed
  std::uint64_t driven = 0;         // of them now, not found in the store
};

// Who drives runs beside the workers here, in other processes: asked now and then, on the engine's thread.
class Elsewhere {
 public:
  // The next runs for one of them, valid as long as the call; none: there are no more.
  using Grab = std::function<std::span<const results::RunKey>()>;
  using Deposit = std::function<void(std::vector<ttf::experiments::results::Run>)>;

  virtual ~Elsewhere() = default;
  // Hands out runs to whoever has none, and gives back what they came to. How many runs are still under way.
  virtual std::size_t turn(const Grab& grab, const Deposit& deposit) = 0;
};

// Drives runs one after the other; neighbours of one point and paradigm are prepared once, as that takes half as long
// as a drive.
class Driver {
 public:
  explicit Driver(const SweepDrives& drives) : drives_(drives) {}
  void drive(std::span<const results::RunKey> wanted, const std::function<void(ttf::experiments::results::Run)>& take);

 private:
  const SweepDrives& drives_;
  std::optional<results::RunKey> newest_;  // that was driven
  std::optional<PreparedDrive> prepared_;  // what for; nothing where it could not be, or something is drawn for each
};

// Throws std::runtime_error where the store cannot take what was driven; what it has stays. `progress` is called now
// and then by the calling thread. A stop rule and a shard exclude each other. `elsewhere` may be null.
void run_sweep(const SweepDrives& drives, results::Store& store, results::Shard shard, unsigned workers,
               const std::function<void(const ttf::experiments::sweep::SweepProgress&)>& progress,
               Elsewhere* elsewhere = nullptr);

}  // namespace ttf::experiments::sweep
