#include <fmt/format.h>

#include <exception>
#include <optional>
#include <string>

#include "cli/experiment/options.h"
#include "core/errors.h"
#include "experiments/sweep/drives.h"
#include "experiments/sweep/file.h"

namespace ttf::cli::experiment {

int run_on_ranks(const ExperimentOptions& given, experiments::mpi::Ranks& ranks) {
  ExperimentOptions options = given;
  std::optional<experiments::sweep::SweepFile> sweep;
  std::optional<nodes::foreign::StepFolder> folder;
  std::optional<experiments::sweep::SweepDrives> drives;
  std::exception_ptr mine;
  std::string words;
  try {
    const auto refuse = [](bool asked, const char* option, const char* why) {
      if (asked) throw InputError({"command line", 0, option, "", why});
    };
    refuse(options.jobs > 0, "--jobs", "must not be given under mpirun: each rank is a worker");
    refuse(options.replay.has_value(), "--replay", "needs no mpirun: it is one run");
    refuse(!options.merge.empty(), "--merge", "needs no mpirun: nothing is driven");
    if (kind_of(options) != ExperimentKind::kSweep)
      throw InputError(
          {options.file, 0, "kind", "fault_campaign", "must be sweep under mpirun: a campaign has --shard"});
    sweep.emplace(experiments::sweep::read_sweep(file_with_seed(options.file, options.seed)));
    if (ranks.rank() == 0) settle_replications(options, *sweep);  // rank 0 sends the others their drives
    folder = drive::step_folder(options.steps);
    drives.emplace(*sweep, drive::pointer_to(folder));
  } catch (const InputError& error) {
    mine = std::current_exception();
    words = error.findings().front().sentence();
  } catch (const std::exception& error) {
    mine = std::current_exception();
    words = error.what();
  }
  std::string first = ranks.first_problem(words);
  if (first.empty()) {
    const bool same = ranks.same_as_first(drives->identity() + TTF_VERSION);
    words = fmt::format("rank {}: reads other files than rank 0, or is another version", ranks.rank());
    first = ranks.first_problem(same ? "" : words);
  }
  if (!first.empty()) {
    // mpirun ends all ranks as soon as one fails, perhaps before rank 0 has reported: only rank 0 fails.
    if (ranks.rank() != 0) return 0;
    if (mine) std::rethrow_exception(mine);
    throw InputError({options.file, 0, "", "", first});
  }
  if (ranks.rank() != 0) {
    ranks.serve(*drives);
    return 0;
  }
  ranks.are_served();
  return drive_and_answer(options, *drives, ranks);
}

}  // namespace ttf::cli::experiment
