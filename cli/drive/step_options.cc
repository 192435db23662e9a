#include "cli/drive/step_options.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

#include "cli/argument_checks.h"
#include "cli/decimal_option.h"
#include "core/errors.h"
#include "core/strict_yaml.h"

namespace ttf::cli::drive {
namespace {

constexpr std::int64_t kStepNsPerSecond = 1'000'000'000;
constexpr Range<std::int64_t> kLimits_ns{kStepNsPerSecond / 10, 3600 * kStepNsPerSecond};

}  // namespace

std::vector<std::string> StepOptions::arguments() const {
  std::vector<std::string> list;
  if (folder) list.insert(list.end(), {"--steps", *folder});
  if (limit) list.insert(list.end(), {"--step-limit", *limit});
  return list;
}

void add_step_options(CLI::App& command, StepOptions& options) {
  command
      .add_option("--steps", options.folder,
                  "Folder of the libraries that the cluster names as steps; without it none is loaded")
      ->check(named());
  command.add_option("--step-limit", options.limit,
                     "Seconds by the wall within which a library's step must return (default: 10)");
}

std::optional<nodes::foreign::StepFolder> step_folder(const StepOptions& options) {
  if (!options.folder) {
    if (options.limit) throw InputError({"command line", 0, "--step-limit", *options.limit, "goes with --steps"});
    return std::nullopt;
  }
  std::error_code none;
  if (!std::filesystem::is_directory(*options.folder, none))
    throw InputError({"command line", 0, "--steps", *options.folder, "must be a folder"});
  nodes::foreign::StepFolder folder{*options.folder, nodes::foreign::StepFolder::kUsualLimit};
  if (options.limit)
    folder.limit = Duration{decimal_option("--step-limit", *options.limit, kStepNsPerSecond, kLimits_ns, " s")};
  return folder;
}

}  // namespace ttf::cli::drive
