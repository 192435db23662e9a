// An experiment's drives on many machines: the processes that mpirun has started (OpenMPI).
//
// Every rank reads the experiment for itself. Rank 0 has the store and hands out a few drives at a time to idle
// ranks, which send back the results. A result is a function of its key, so the store is the same as from one
// process. If a rank dies, mpirun ends them all; the store remains, and a resumed experiment goes on from
// there.
//
// All ranks must be of one byte order and one program. A check ensures that they read the same files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "experiments/sweep/drives.h"
#include "experiments/sweep/engine.h"

namespace ttf::experiments::mpi {

class Ranks final : public sweep::Elsewhere {
 public:
  // A process that mpirun did not start is alone, and does not initialise MPI.
  Ranks();
  // On rank 0: also ends the other ranks.
  ~Ranks() override;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  // A collective call: each rank passes its problem, or "". Returns the problem of the first rank that has one,
  // the same on all ranks.
  std::string first_problem(const std::string& mine) const;
  // A collective call: returns whether this rank has the same text as rank 0.
  bool same_as_first(const std::string& text) const;

  // On every rank but 0: drives the keys that rank 0 hands out, until it ends.
  void serve(const sweep::SweepDrives& drives);
  // On rank 0: the others serve, or will.
  void are_served() { served_ = true; }
  std::size_t turn(const Grab& grab, const Deposit& deposit) override;

 private:
  void hand_out(int rank, std::span<const results::RowKey> keys);

  int rank_ = 0, size_ = 1;
  bool served_ = false;
  std::vector<int> idle_;               // ranks without a drive
  std::vector<std::size_t> under_way_;  // number of drives, by rank
};

}  // namespace ttf::experiments::mpi
