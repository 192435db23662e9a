// Shows the progress of a drive by the time of its records.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "cli/progress.h"
#include "core/time.h"
#include "recording/merge/merge.h"
#include "recording/records/records.h"

namespace ttf::cli {

class DriveProgress final : public recording::records::Sink {
 public:
  // The drive's time runs from 0 to `end`; `what` follows the seconds: "of the drive".
  DriveProgress(TrueTime end, const std::string& what) : end_(end), shown_("s " + what) {}

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::TaskRun& run) override {
    if (run.end.true_time < next_) return;  // a look at the clock for each record would cost time
    next_ = run.end.true_time + Duration::milliseconds(10);
    const auto done = static_cast<std::uint64_t>(std::clamp<std::int64_t>(run.end.true_time.ns, 0, end_.ns) / kSecond);
    shown_(done, static_cast<std::uint64_t>(end_.ns / kSecond), done);
  }

 private:
  static constexpr std::int64_t kSecond = 1'000'000'000;

  TrueTime end_, next_{};
  Progress shown_;
};

// Passes every record of the logs to the sink, and shows the progress.
void read_shown(const recording::merge::MergedLogs& drive, recording::records::Sink& sink);

}  // namespace ttf::cli
