// The use that `run --input` made of its recording, for people and for scripts.
#pragma once

#include <string>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "fusion/config/tracker_config.h"
#include "recording/records/records.h"
#include "sim/drives/played_recording.h"

namespace ttf::cli::drive {

// Tells whether a drive ever confirmed a track.
class TrackWatch final : public recording::records::Sink {
 public:
  bool wants_frames() const override { return false; }
  using Sink::on;
  void on(const recording::records::FusionStep& step) override { any_ = any_ || step.confirmed > 0; }
  bool any() const { return any_; }

 private:
  bool any_ = false;
};

// Returns the sentences of all strategies, those of equal ones once; empty without a recording.
std::string recordings_text(const std::vector<StrategyResult>& results);

// Returns the reasons why a drive did not do its work with its recording, in sentences: most rows are beyond
// its end, it dropped most lists as too old, or it made no track. Empty otherwise, and without a recording. Rows between
// the schedule's instants are no loss: a fast recording has most of them there.
std::vector<std::string> recording_reasons(const StrategyResult& result, const fusion::config::TrackerConfig& tracker);

}  // namespace ttf::cli::drive
