// Drives the part of an experiment that its store lacks, on several workers.
//
// The final store is the same for any number of workers and interruptions. Every result is a function of its
// key, and the stop rule judges a point only after a whole batch of its replications.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "experiments/results/shard.h"
#include "experiments/results/store.h"
#include "experiments/sweep/drives.h"

namespace ttf::experiments::sweep {

struct SweepProgress {
  std::uint64_t done = 0, all = 0;  // drives of this shard; a stop rule may end before `all`
  std::uint64_t driven = 0;         // driven in this call, not found in the store
};

// Drives in other processes, beside the workers here. The engine calls it now and then, on its own thread.
class Elsewhere {
 public:
  // Returns the next keys to drive, valid during the call; empty at the end.
  using Grab = std::function<std::span<const results::RowKey>()>;
  using Deposit = std::function<void(std::vector<ttf::experiments::results::Row>)>;

  virtual ~Elsewhere() = default;
  // Hands out keys to idle processes, and deposits their results. Returns how many drives are still under way.
  virtual std::size_t turn(const Grab& grab, const Deposit& deposit) = 0;
};

// Drives one key after the other. Neighbours of one point and paradigm share their preparation, which takes
// half as long as a drive.
class Driver {
 public:
  explicit Driver(const SweepDrives& drives) : drives_(drives) {}
  void drive(std::span<const results::RowKey> wanted, const std::function<void(ttf::experiments::results::Row)>& take);

 private:
  const SweepDrives& drives_;
  std::optional<results::RowKey> newest_;  // the key driven last
  std::optional<PreparedDrive> prepared_;  // for that key; absent if preparation failed, or if each replication draws
                                           // values
};

// Throws std::runtime_error if the store cannot take a result; its earlier rows remain. `progress` is called
// now and then on the calling thread. A stop rule and a shard exclude each other. `elsewhere` may be null.
void run_sweep(const SweepDrives& drives, results::Store& store, results::Shard shard, unsigned workers,
               const std::function<void(const ttf::experiments::sweep::SweepProgress&)>& progress,
               Elsewhere* elsewhere = nullptr);

}  // namespace ttf::experiments::sweep
