#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "cli/drive_progress.h"
#include "cli/exports/formats.h"
#include "cli/output.h"
#include "recording/log/writer.h"
#include "recording/records/tee.h"

namespace ttf::cli::exports {

using recording::osi::OsiCounts;
using recording::osi::OsiExport;

OsiCounts export_osi(const recording::merge::MergedLogs& drive, const std::string& out) {
  bool created = false;
  try {
    recording::log::LogWriter log(out, drive.manifest());
    created = true;
    for (const recording::log::Attachment& one : drive.attachments()) log.attach(one.name, one.media_type, one.bytes);
    const recording::osi::OsiChannels channels = recording::osi::declare_osi(log);
    OsiExport trace(
        [&](TrueTime at, std::string_view message) { log.add_foreign(channels.sensor_data, at, message); },
        [&](TrueTime at, std::string_view message) { log.add_foreign(channels.ground_truth, at, message); });
    recording::records::Tee both({&log, &trace});
    read_shown(drive, both);
    trace.finish();
    log.close();
    return trace.counts();
  } catch (const std::exception&) {
    std::error_code none;
    if (created && std::filesystem::is_regular_file(out, none)) std::filesystem::remove(out, none);
    throw;
  }
}

OsiCounts export_osi_files(const recording::merge::MergedLogs& drive, const std::string& folder,
                           std::vector<std::string>& files) {
  std::string data, truth;
  OsiExport trace([&](TrueTime, std::string_view message) { data += recording::osi::framed(message); },
                  [&](TrueTime, std::string_view message) { truth += recording::osi::framed(message); });
  read_shown(drive, trace);
  trace.finish();
  const std::string name = fmt::format("{}_{}", drive.manifest().scenario_name, drive.manifest().strategy);
  files = {recording::osi::osi_file_name("sd", trace.counts().images, name),
           recording::osi::osi_file_name("gt", trace.counts().truths, name)};
  create_folder(folder);
  write_file(folder + "/" + files[0], data);
  write_file(folder + "/" + files[1], truth);
  return trace.counts();
}

}  // namespace ttf::cli::exports
