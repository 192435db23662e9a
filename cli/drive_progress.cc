#include "cli/drive_progress.h"

#include "recording/records/tee.h"

namespace ttf::cli {

void read_shown(const recording::merge::MergedLogs& drive, recording::records::Sink& sink) {
  TrueTime last{};
  for (const recording::merge::StoredLog& log : drive.logs())
    for (const recording::merge::StoredLog::Chunk& chunk : log.chunks()) last = std::max(last, chunk.last);
  DriveProgress progress(last, "read");
  recording::records::Tee tee({&sink, &progress});
  drive.read(tee);
}

}  // namespace ttf::cli
