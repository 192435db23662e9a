#include "schedules/sequence/detections.h"

#include "core/check.h"

namespace ttf::schedules::sequence {

std::string letters(const Sequence& sequence, std::string_view names) {
  std::string text;
  for (const Detection& detection : sequence) {
    const char name = names.at(static_cast<std::size_t>(detection.sensor));
    text += detection.secondary ? static_cast<char>(name - 'A' + 'a') : name;
  }
  return text;
}

DetectionTimes::DetectionTimes(int sensors, Duration of_primary, Duration of_secondary)
    : primary(static_cast<std::size_t>(sensors), of_primary),
      secondary(static_cast<std::size_t>(sensors), of_secondary) {
  TTF_CHECK(of_primary > Duration{} && of_secondary >= Duration{}, "{} ns and {} ns", of_primary.ns, of_secondary.ns);
}

Duration DetectionTimes::of(const Detection& detection) const {
  return (detection.secondary ? secondary : primary)[static_cast<std::size_t>(detection.sensor)];
}

Duration frame_time(const Sequence& sequence, const DetectionTimes& times) {
  Duration sum{};
  for (const Detection& detection : sequence) sum += times.of(detection);
  return sum;
}

}  // namespace ttf::schedules::sequence
