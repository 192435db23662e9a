// Merges the logs of one drive: the records of all, in one canonical order.
//
// Each process of a node set writes a log of its own nodes' records; merged, these are the log of the drive.
// One log and many logs, in any order, give the same sequence of records, as both go through the merge.
// The order is that of recording/merge/record_place.h and docs/reference/log_format.md.
// The true times of different machines are on one scale (recording/merge/common_time.h).
//
// The merge is exact for any order within the logs. Logs have the order of reports, not of true time. A task's
// execution is reported at its end but stamped with its start; a FlexRay list's hop `sent` is reported when its
// frame begins but stamped with its end. A reference fix is reported when the fusion node takes it in: seconds
// later, without a bound. A sort within a time window thus does not suffice. Every log is read through once for
// the first and last time of each chunk. Then a chunk is unpacked when its time has come, and dropped after its
// last record. Memory holds the logs' bytes as on disk, and the chunks of one instant: mostly one or two per
// log, at worst all. A drive of a minute among 25 vehicles, 70 MB of logs, takes at most 110 to 150 MB
// resident, and twice the time of reading it unmerged.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recording/log/manifest.h"
#include "recording/log/reader.h"
#include "recording/merge/common_time.h"
#include "recording/merge/stored_log.h"
#include "recording/records/records.h"

namespace ttf::recording::merge {

class MergedLogs {
 public:
  // Throws InputError if a log is unreadable, is given twice, or is of another drive than the first (a key of
  // the manifest differs, other than checksum and host). A log with a damaged manifest is assumed to belong to
  // the others. Other damage is left out, with a warning in that log's info. A log with the records of all
  // others together, such as a merged one in the same folder, is ignored with a warning.
  explicit MergedLogs(std::vector<StoredLog> logs);
  explicit MergedLogs(const std::vector<std::string>& paths);

  const std::vector<StoredLog>& logs() const { return logs_; }  // as given, without an ignored one
  const log::LogManifest& manifest() const { return manifest_; }
  std::vector<log::Attachment> attachments() const;  // each once, in the order of the logs, then by name and bytes
  log::ContentHash content_hash() const;             // over all records, as the logs have them
  std::vector<std::string> warnings() const;         // the logs', as given, then the merge's

  // Passes every record to the sink, at each call. Throws InputError if one log is a part of another: both hold
  // the same record of a node.
  void read(records::Sink& sink) const;

 private:
  std::vector<StoredLog> logs_;
  log::LogManifest manifest_;
  std::vector<CommonTime> times_;      // by log
  std::vector<std::string> warnings_;  // the merge's
};

// Groups logs by drive, in the order in which each drive's first log is given, and merges each group. A log
// with a damaged manifest joins the others if they are of one drive; else it stands alone. Throws as MergedLogs
// does.
std::vector<MergedLogs> merge_by_drive(std::vector<StoredLog> logs);

// Writes the records as one log, the same bytes for the same records. Throws as read() does, InputError if
// `path` is one of the logs, and std::runtime_error if it cannot be written; then the file does not exist.
void write_merged(const MergedLogs& merged, const std::string& path);

}  // namespace ttf::recording::merge
