// Written and used images, kept whole and compared in every field, bit for bit.
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <vector>

#include "recording/records/records.h"

namespace ttf::sim::drives {

inline bool same(const recording::records::Stamp& a, const recording::records::Stamp& b) {
  return a.true_time == b.true_time && a.local == b.local && a.global == b.global && a.node == b.node;
}

// Every field by name: a new field does not compile until it is compared, too.
inline auto bits(const recording::records::ImageObject& object) {
  const auto& [track, x, y, heading, speed, acceleration, length, width, sigma_x, sigma_y, correlation_xy,
               sigma_heading, sigma_speed, sigma_acceleration, sigma_length, sigma_width, status] = object;
  std::vector<std::uint64_t> all{index_of(track), static_cast<std::uint64_t>(status)};
  for (const double value : {x, y, heading, speed, acceleration, length, width, sigma_x, sigma_y, correlation_xy,
                             sigma_heading, sigma_speed, sigma_acceleration, sigma_length, sigma_width})
    all.push_back(std::bit_cast<std::uint64_t>(value));
  return all;
}

struct ImageCopy {
  recording::records::Stamp stamp;
  std::uint32_t sequence = 0;
  GlobalTime valid_at{}, newest_measurement{};
  std::vector<recording::records::ImageObject> objects;
  std::vector<MeasurementId> newest;

  ImageCopy() = default;
  explicit ImageCopy(const recording::records::ImageWritten& image) {
    const auto& [its_stamp, its_sequence, its_valid_at, its_newest_measurement, its_objects, its_newest] = image;
    stamp = its_stamp;
    sequence = its_sequence;
    valid_at = its_valid_at;
    newest_measurement = its_newest_measurement;
    objects.assign(its_objects.begin(), its_objects.end());
    newest.assign(its_newest.begin(), its_newest.end());
  }
};

inline bool same(const std::vector<recording::records::ImageObject>& a,
                 const std::vector<recording::records::ImageObject>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t o = 0; o < a.size(); ++o)
    if (bits(a[o]) != bits(b[o])) return false;
  return true;
}

inline bool same(const ImageCopy& a, const ImageCopy& b) {
  return same(a.stamp, b.stamp) && a.sequence == b.sequence && a.valid_at == b.valid_at &&
         a.newest_measurement == b.newest_measurement && a.newest == b.newest && same(a.objects, b.objects);
}

// The images of a whole drive.
struct Images final : recording::records::Sink {
  using recording::records::Sink::on;
  struct Use {
    std::uint32_t sequence = 0;
    GlobalTime valid_at{};
    bool fresh = false;
    std::vector<recording::records::ImageObject> objects;
  };
  std::map<std::uint32_t, ImageCopy> written;  // by sequence
  std::vector<Use> used;

  void on(const recording::records::ImageWritten& image) override { written[image.sequence] = ImageCopy(image); }
  void on(const recording::records::FeatureUsed& use) override {
    used.push_back({use.image_sequence, use.image_valid_at, use.fresh, {}});
    for (const recording::records::FeatureObject& object : use.objects) used.back().objects.push_back(object.image);
  }
};

}  // namespace ttf::sim::drives
