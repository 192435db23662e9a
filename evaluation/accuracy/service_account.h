// Compares the images that the feature service used with the schedule's promise: an image at every use, and no
// measurement older than the analysis bounds it. Late or lost frames that change neither do the service no harm.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/image_uses.h"
#include "recording/records/binned_durations.h"

namespace ttf::evaluation::accuracy {

struct ServiceFindings {
  std::uint64_t uses = 0;     // images that the service used or refused
  std::uint64_t refused = 0;  // as too old
  // Uses at which a sensor's newest measurement was older than its bound. An image without one has the age of the last
  // one before. Without any, the age counts from the begin of the judged part: a sensor may need its bound to begin.
  struct Older {
    std::uint64_t uses = 0;
    Duration worst{}, bound{};
    std::uint64_t missing = 0;  // uses of images without a measurement of the sensor
  };
  std::map<SensorId, Older> older;  // only sensors with such uses
  // The longest time without a use, if it is more than three times the median; begin and end of the judged part count.
  std::optional<Duration> gap;

  bool as_promised() const { return uses > 0 && refused == 0 && older.empty() && !gap; }
};

class ServiceAccount final : public ImageUses {
 public:
  // Ignores uses before `from`. Sensors without a bound are not judged.
  ServiceAccount(TrueTime from, std::map<SensorId, Duration> bounds);

  // `end`: the drive's. Call it once, at the end.
  ServiceFindings finish(TrueTime end);

  bool wants_frames() const override { return false; }

 private:
  void fused(SensorId, Duration) override {}
  bool used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
            std::span<const SensorAge> ages) override;
  void judged(const JudgedUse&) override {}

  TrueTime last_;
  TrueTime from_;
  std::map<SensorId, Duration> bounds_;
  std::map<SensorId, TrueTime> newest_;  // in any used image
  recording::records::BinnedDurations gaps_;
  ServiceFindings findings_;
};

}  // namespace ttf::evaluation::accuracy
