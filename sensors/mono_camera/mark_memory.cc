#include "sensors/mono_camera/mark_memory.h"

#include <algorithm>
#include <cmath>

namespace ttf::sensors::mono_camera {

MarkCalibration load_mark_calibration(YamlMap& yaml) {
  MarkCalibration c;
  c.offset_sigma_m = yaml.number_or("offset_sigma", c.offset_sigma_m, {0.001, 5.0}, "m");
  c.heading_sigma_rad = yaml.number_or("heading_sigma", c.heading_sigma_rad, {1e-5, 0.5}, "rad");
  c.curvature_sigma_per_m = yaml.number_or("curvature_sigma", c.curvature_sigma_per_m, {1e-6, 0.1}, "1/m");
  return c;
}

MarkMemory::MarkMemory(std::size_t most_marks) {
  before_.reserve(most_marks);
  now_.reserve(most_marks);
}

void MarkMemory::judge(std::span<SeenMark> marks) {
  constexpr double kStep = 1.0 / kLists;
  now_.clear();
  for (SeenMark& mark : marks) {
    const SeenMark* same = nullptr;
    for (const SeenMark& old : before_) {
      const double apart = std::abs(old.offset - mark.offset);
      if (apart < kOffset_m && std::abs(old.heading - mark.heading) < kHeading_rad &&
          (same == nullptr || apart < std::abs(same->offset - mark.offset)))
        same = &old;
    }
    mark.validity = std::min(1.0, kStep + (same == nullptr ? 0.0 : same->validity));
    now_.push_back(mark);
  }
  std::swap(before_, now_);
}

}  // namespace ttf::sensors::mono_camera
