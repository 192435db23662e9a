// The ages of measurements in drives, from their records.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "recording/records/records.h"

namespace ttf::sim::drives::ages {

struct AgeRange {
  Duration best{}, worst{};
  std::size_t count = 0;
  void add(Duration age) {
    best = count == 0 ? age : std::min(best, age);
    worst = count == 0 ? age : std::max(worst, age);
    ++count;
  }
};

// When fused: of every list. When used: of the newest measurement of each sensor in the used image, at every
// use.
struct Ages final : recording::records::Sink {
  using recording::records::Sink::on;
  std::map<SensorId, AgeRange> fused, used;
  std::size_t uses_without_image = 0;

  void on(const recording::records::ListFused& list) override {
    if (list.disposition != recording::records::Disposition::kFused &&
        list.disposition != recording::records::Disposition::kFusedLate)
      return;
    fused[list.id.sensor].add(list.stamp.global - list.measured);
    measured_[list.id] = list.measured;
  }
  void on(const recording::records::ImageWritten& image) override {
    newest_[image.sequence].assign(image.newest.begin(), image.newest.end());
  }
  void on(const recording::records::FeatureUsed& use) override {
    const auto image = newest_.find(use.image_sequence);
    if (image == newest_.end())
      ++uses_without_image;
    else
      for (const MeasurementId& id : image->second) used[id.sensor].add(use.stamp.global - measured_.at(id));
  }
  // Drives count their images and measurements from 0 again.
  void next_drive() {
    measured_.clear();
    newest_.clear();
  }

 private:
  std::map<MeasurementId, GlobalTime> measured_;
  std::map<std::uint32_t, std::vector<MeasurementId>> newest_;
};

}  // namespace ttf::sim::drives::ages
