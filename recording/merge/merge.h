// Several logs of one run as one: the records of all, in one canonical order.
//
// The processes of a node set write a log each, of their own nodes' records. Merged they are the log of the run: the
// same sequence of records comes out whether the run was one process with one log, or many in whatever order their logs
// are given; the one merge is applied to both. What that order is: recording/merge/record_place.h and
// docs/log_format.md.
//
// The true times of different hosts' clocks are put on one scale: recording/merge/common_time.h.
//
// Exact, whatever the order within the logs. Records stand there as they were reported, which is not the order of true
// time: a task's run is reported at its end and stamped with its start (off by the task's execution), a FlexRay list's
// hop `sent` when its frame begins and stamped with its end (a slot), and a reference fix when the fusion node takes it
// in, or the next one that runs again: its latency, which is seconds, has no bound. So nothing is sorted within a
// window: every log is read through once to learn from when to when the records of each chunk are, then a chunk is
// unpacked when its time has come and dropped with its last record. In memory are the logs' bytes as they are on disk,
// and the chunks of one instant: mostly one or two a log, all of them at worst. A minute's drive among 25 vehicles, 70
// MB of logs: 110 to 150 MB resident at most, in twice the time that reading it takes as it is.
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
  // Throws InputError where a log cannot be read at all, is given twice, or is of another run than the first: any key
  // of the manifest but checksum and host differs. A log whose manifest is damaged is taken to belong to the others.
  // What else is damaged is missing and has its warning in that log's info; all others are read whole. One that holds
  // what all others hold together, as a folder has it where they were merged, is passed over, which is a warning.
  explicit MergedLogs(std::vector<StoredLog> logs);
  explicit MergedLogs(const std::vector<std::string>& paths);

  const std::vector<StoredLog>& logs() const { return logs_; }  // as given, but for one passed over
  const log::LogManifest& manifest() const { return manifest_; }
  std::vector<log::Attachment> attachments() const;  // each once, in the order of the logs, then by name and bytes
  log::ContentHash content_hash() const;             // of all records, as they are in the logs
  std::vector<std::string> warnings() const;         // of all logs, as given, and of what they are together

  // Drives the sink with every record, as often as it is called. Throws InputError where two logs hold the same record
  // of a node: one is a part of the other.
  void read(records::Sink& sink) const;

 private:
  std::vector<StoredLog> logs_;
  log::LogManifest manifest_;
  std::vector<CommonTime> times_;      // by log
  std::vector<std::string> warnings_;  // of all together
};

// Logs of several runs, put together by run, in the order in which each run's first log is given. One whose manifest is
// damaged belongs to the one run of the others, and stands alone where they are of several. Throws as MergedLogs does.
std::vector<MergedLogs> merge_by_run(std::vector<StoredLog> logs);

// Writes them as one log, the same bytes for the same records. Throws as read() does, InputError where `path` is one of
// the logs, and std::runtime_error where it cannot be written; then there is no such file.
void write_merged(const MergedLogs& merged, const std::string& path);

}  // namespace ttf::recording::merge
