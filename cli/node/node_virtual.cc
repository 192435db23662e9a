#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "bus/dds/exchange/exchange.h"
#include "cli/live_media/dds_configuration.h"
#include "cli/node/node_command.h"
#include "cli/node_set/node_drive.h"
#include "cli/node_set/session.h"
#include "cli/output.h"
#include "cli/supervision/control.h"
#include "cli/supervision/folder_lock.h"
#include "core/errors.h"

namespace ttf::cli::node {

// Waits for the others first, so that a ready node receives all of them.
int run_node_virtual(const NodeOptions& options) {
  const node_set::NodeSet& set = options.set;
  auto supervisor = supervision::ControlLine::from_environment();
  if (!supervisor) {
    live_media::check_dds_configuration();
    supervision::FolderLock::refuse_if_held(set.folder);
  }
  create_folder(set.folder);
  // Without a supervisor, this process ensures that its log has one writer. A missing log is created after the wait.
  std::optional<supervision::FileLock> log;
  const auto take_log = [&] {
    if (!supervisor && !log && !(log = supervision::FileLock::take(options.log)))
      throw InputError({"command line", 0, "--out", set.folder,
                        fmt::format("must be another folder: another process writes {}", options.log)});
  };
  if (std::filesystem::exists(options.log)) take_log();
  bus::dds::exchange::Exchange exchange(session_of(set, supervisor.has_value()), options.node);
  exchange.wait_ready(node_set::kOthersPatience);
  take_log();
  if (supervisor) {
    supervisor->ready();
    if (!supervisor->wait_for_start()) throw std::runtime_error("the supervisor ended before the start");
  }
  const drive::Recording none;
  const node_set::NodeDrive drive{&set.scenario, &set.cluster, set.strategy,
                                  set.seed,      &none,        drive::pointer_to(set.steps),
                                  options.node,  options.log};
  const sim::drives::DriveOutcome outcome = run_node_drive(drive, exchange);
  exchange.leave();
  const nlohmann::ordered_json json = node_set::outcome_json(outcome);
  if (supervisor) supervisor->done(json);
  if (options.json) fmt::print("{}\n", json.dump(2));
  if (!supervisor) say_written(options.log);
  return 0;
}

}  // namespace ttf::cli::node
