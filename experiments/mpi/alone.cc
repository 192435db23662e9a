// Ranks in a build without MPI (TTF_WITH_MPI): a process is alone, and mpirun is refused.
#include <cstdlib>

#include "core/errors.h"
#include "experiments/mpi/ranks.h"

namespace ttf::experiments::mpi {

Ranks::Ranks() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr)
    throw InputError(
        Finding{"mpirun", 0, "", "", "needs a ttfusion with MPI: this one was built with -DTTF_WITH_MPI=OFF"});
}

Ranks::~Ranks() = default;

std::string Ranks::first_problem(const std::string& mine) const { return mine; }

bool Ranks::same_as_first(const std::string& /*text*/) const { return true; }

void Ranks::serve(const sweep::SweepDrives& /*drives*/) {}

void Ranks::hand_out(int /*rank*/, std::span<const results::RowKey> /*keys*/) {}

std::size_t Ranks::turn(const Grab& /*grab*/, const Deposit& /*deposit*/) { return 0; }

}  // namespace ttf::experiments::mpi
