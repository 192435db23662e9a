#include "cli/exports/tables.h"

#include <array>
#include <deque>
#include <limits>
#include <string_view>
#include <utility>

#include "cli/drive_progress.h"
#include "cli/exports/table_database.h"
#include "cli/exports/told_uses.h"
#include "cli/output.h"
#include "recording/exports/frames.h"
#include "recording/exports/tables.h"
#include "recording/records/tee.h"

namespace ttf::cli::exports {

namespace {

using recording::exports::Table;
using recording::exports::TableExport;

TableRows tell_tables(const recording::merge::MergedLogs& drive, TableExport::Write write) {
  TableExport tables(recording::exports::LogNames(drive.manifest()), std::move(write));
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
  TableRows rows;
  for (const std::string_view name : recording::exports::kTableNames)
    rows.emplace_back(name, tables.rows()[rows.size()]);
  return rows;
}

}  // namespace

TableRows export_tables(const recording::merge::MergedLogs& drive, const std::string& out) {
  create_folder(out);
  std::vector<std::string> names;
  std::deque<OutputFile> files;
  for (const std::string_view table : recording::exports::kTableNames) {
    const std::string path = out + "/" + names.emplace_back(std::string(table) + ".csv");
    for (const recording::merge::StoredLog& log : drive.logs()) refuse_overwriting(log.name(), path, "--out");
    files.emplace_back(path);
  }
  TableRows rows = tell_tables(
      drive, [&](Table table, std::string_view text) { files[static_cast<std::size_t>(table)].write(text); });
  for (OutputFile& file : files) file.finish();
  for (std::size_t t = 0; t < rows.size(); ++t) rows[t].first = names[t];
  return rows;
}

TableRows export_sqlite(const recording::merge::MergedLogs& drive, const std::string& file) {
  TableDatabase database(file);
  TableRows rows = tell_tables(drive, [&](Table table, std::string_view line) { database.write(table, line); });
  database.finish();
  return rows;
}

}  // namespace ttf::cli::exports
