#include "cli/logs/export_tables.h"

#include <array>
#include <deque>
#include <limits>
#include <string_view>

#include "cli/drive_progress.h"
#include "cli/logs/told_uses.h"
#include "cli/output.h"
#include "recording/exports/frames.h"
#include "recording/exports/tables.h"
#include "recording/records/tee.h"

namespace ttf::cli::logs {

std::vector<std::pair<std::string, std::uint64_t>> export_tables(const recording::merge::MergedLogs& drive,
                                                                 const std::string& out) {
  using recording::exports::Table;
  create_folder(out);
  std::vector<std::pair<std::string, std::uint64_t>> written;
  std::deque<OutputFile> files;
  for (const std::string_view name : recording::exports::kTableNames) {
    written.emplace_back(std::string(name) + ".csv", 0);
    for (const recording::merge::StoredLog& log : drive.logs())
      refuse_overwriting(log.name(), out + "/" + written.back().first, "--out");
    files.emplace_back(out + "/" + written.back().first);
  }
  recording::exports::TableExport tables(
      recording::exports::LogNames(drive.manifest()),
      [&](Table table, std::string_view text) { files[static_cast<std::size_t>(table)].write(text); });
  ToldUses uses(
      [&](const ToldUses::Use& use, ToldUses::Ages ages) {
        for (const evaluation::accuracy::SensorAge& one : ages)
          tables.age(use.stamp.true_time, use.image_sequence, one.sensor, one.age);
      },
      [&](const evaluation::accuracy::JudgedUse& use) {
        constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
        for (const evaluation::accuracy::UsedObject& one : use.objects)
          tables.error({use.at, one.object, one.error,
                        one.belief ? one.belief->sigma : std::array{kUnknown, kUnknown, kUnknown, kUnknown},
                        one.box.heading_rad, one.box.length_m, one.box.width_m,
                        one.belief ? one.belief->nees : kUnknown});
      });
  recording::exports::FrameCollector frames;
  recording::records::Tee all({&tables, &uses, &frames});
  read_shown(drive, all);
  uses.finish();
  tables.frames(frames);
  for (OutputFile& file : files) file.finish();
  for (std::size_t t = 0; t < written.size(); ++t) written[t].second = tables.rows()[t];
  return written;
}

}  // namespace ttf::cli::logs
