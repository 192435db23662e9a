// Drives what an experiment asks for and its store does not have yet, on as many workers as there are.
//
// What a store holds in the end is the same for any number of workers, and however often it was interrupted: every run is a
// function of its key, and a point is looked at, for the stop rule, only when a whole batch of its replications is there.
#pragma once

#include <cstdint>
#include <functional>

#include "experiments/results/store.h"
#include "experiments/shard.h"
#include "experiments/sweep_drive.h"

namespace ttf::experiments {

struct SweepProgress {
  std::uint64_t done = 0, all = 0;    // runs of this shard; with a stop rule `all` may not be needed
  std::uint64_t driven = 0;           // of them now, not found in the store
};

// Throws std::runtime_error where the store cannot take what was driven; what it has stays. `progress` is called now and
// then by the calling thread. A stop rule and a shard exclude each other.
void run_sweep(const SweepDrives& drives, results::Store& store, Shard shard, unsigned workers,
               const std::function<void(const SweepProgress&)>& progress);

}  // namespace ttf::experiments
