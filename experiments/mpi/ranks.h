// An experiment's runs on many machines: the processes that mpirun has started (OpenMPI).
//
// Every rank reads the experiment for itself. Rank 0 has the store and hands out runs, a few at a time, to whoever has
// none; the others drive them and send back what they came to. As a run is a function of its key, the store holds what
// one process alone would have put there. A rank that dies ends them all, as mpirun has it: what rank 0 has written by
// then stays, and a resumed experiment goes on from there.
//
// All ranks must be of one byte order and one program; that they read the same files is checked.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "experiments/sweep/engine.h"
#include "experiments/sweep/run.h"

namespace ttf::experiments::mpi {

class Ranks final : public sweep::Elsewhere {
 public:
  // Of a process that mpirun did not start: it is alone, and MPI is not begun.
  Ranks();
  // Of rank 0: the others are done, too.
  ~Ranks() override;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  // Called by all, with what is wrong on this one, "" if nothing is: what is wrong on the first rank where something
  // is, the same for all.
  std::string first_problem(const std::string& mine) const;
  // Called by all: whether this rank has the same text as rank 0.
  bool same_as_first(const std::string& text) const;

  // On every rank but 0: drives what it is handed, until rank 0 is done.
  void serve(const sweep::SweepDrives& drives);
  // On rank 0: the others serve, or will.
  void are_served() { served_ = true; }
  std::size_t turn(const Grab& grab, const Deposit& deposit) override;

 private:
  void hand_out(int rank, std::span<const results::RunKey> keys);

  int rank_ = 0, size_ = 1;
  bool served_ = false;
  std::vector<int> idle_;               // ranks that have nothing to drive
  std::vector<std::size_t> under_way_;  // runs, by rank
};

}  // namespace ttf::experiments::mpi
