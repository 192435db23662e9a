// A made-up run for the measures: images, uses and truth by hand.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

inline TrueTime at(std::int64_t ms) { return TrueTime{} + Duration::milliseconds(ms); }

// An object of the image that stands still at (x, y), known to `sigma` metres and metres per second.
struct Shown {
  double x = 0, y = 0, sigma = 1.0;
};

inline void write_image(recording::records::Sink& sink, std::uint32_t sequence, GlobalTime valid_at,
                        const std::vector<Shown>& shown, const std::vector<MeasurementId>& newest = {}) {
  std::vector<recording::records::ImageObject> objects;
  for (const Shown& object : shown) {
    const std::array<double, 6> state{object.x, object.y, 0, 0, 0, 0};
    std::array<double, 36> covariance{};
    for (std::size_t k = 0; k < 6; ++k) covariance[7 * k] = object.sigma * object.sigma;
    recording::records::TrackState track{{}, 1, TrackId{0}, valid_at, state, covariance, true};
    sink.on(track);
    objects.push_back({TrackId{0}, object.x, object.y});
  }
  recording::records::ImageWritten image;
  image.sequence = sequence;
  image.valid_at = valid_at;
  image.objects = objects;
  image.newest = newest;
  sink.on(image);
}

inline void use_image(recording::records::Sink& sink, std::uint32_t sequence, TrueTime at,
                      const std::vector<Shown>& shown, bool fresh = true) {
  std::vector<recording::records::FeatureObject> objects;
  for (const Shown& object : shown) objects.push_back({{TrackId{0}, object.x, object.y}, 0, 0, false});
  recording::records::FeatureUsed used;
  used.stamp = {at, {}, GlobalTime{at.ns}, {}};
  used.image_sequence = sequence;
  used.image_valid_at = GlobalTime{at.ns};
  used.fresh = fresh;
  used.objects = objects;
  sink.on(used);
}

inline void truth_at(recording::records::Sink& sink, TrueTime at, std::uint16_t object, double x, double y) {
  recording::records::TruthState truth;
  truth.at = at;
  truth.object = ObjectId{object};
  truth.x = x;
  truth.y = y;
  sink.on(truth);
}

}  // namespace ttf::evaluation::accuracy
