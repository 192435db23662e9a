// A drive as ASAM OSI messages: its images as SensorData, its truth as GroundTruth.
//
//   SensorData     one an image, at the instant to which it is predicted: a detected object a track, with its standard
//                  deviations as base_rmse. A coasting track is PREDICTED. The sensor is the whole fusion, which
//                  stands at the vehicle's origin. OSI has no covariances, an image no probability of existence.
//   GroundTruth    one an instant with a record of the truth: a moving object for each, with its number in the log, and the
//                  host vehicle kHostVehicle, whose size is a car's. The frame is the ground.
//
// Stamps are true times since the start of the drive. They ascend in each stream: a message that does not is left out,
// as may happen after a restart of the fusion node. The same records in the same order give the same bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/time.h"
#include "recording/log/writer.h"
#include "recording/scene/moments.h"

namespace ttf::recording::osi {

inline constexpr std::uint64_t kHostVehicle = 65'535;  // no object's number

struct OsiCounts {
  std::uint64_t images = 0, truths = 0;  // messages
  std::uint64_t left_out = 0;
};

// Takes records in the order of MergedLogs::read(); call finish() at the end.
class OsiExport final : public scene::Moments {
 public:
  using Write = std::function<void(TrueTime at, std::string_view message)>;
  OsiExport(Write sensor_data, Write ground_truth);

  const OsiCounts& counts() const { return counts_; }

 private:
  void truth(TrueTime at, std::span<const records::TruthState> states) override;
  void list(const scene::SeenList&) override {}
  void image(TrueTime valid_at, const records::ImageWritten& image) override;
  void use(TrueTime, const records::FeatureUsed&) override {}

  Write sensor_data_, ground_truth_;
  TrueTime last_image_{-1}, last_truth_{-1};
  OsiCounts counts_;
};

// Declares the OSI trace within a log: its metadata and its two channels.
struct OsiChannels {
  std::uint16_t sensor_data = 0, ground_truth = 0;
};
OsiChannels declare_osi(log::LogWriter& log);

// Returns the name that OSI recommends for a file of one type: "19700101T000000Z_sd_380_32112_250_paper.osi". `type` is
// "sd" or "gt".
std::string osi_file_name(std::string_view type, std::uint64_t messages, std::string_view name);

// Returns a message behind its length, as `.osi` has it.
std::string framed(std::string_view message);

}  // namespace ttf::recording::osi
