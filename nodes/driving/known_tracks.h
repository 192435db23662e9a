// How long an image has had a track. A new track may be a second one of an object that is there already, and its speed
// is hardly more than the tracker's prior: it looks like an approach. Where no track was before, as in a service's
// first image, a new one is no second one.
#pragma once

#include <cstddef>
#include <vector>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::nodes::driving {

class KnownTracks {
 public:
  static constexpr Duration kLong = Duration::milliseconds(3'600'000);

  explicit KnownTracks(std::size_t most) {
    now_.reserve(most);
    before_.reserve(most);
  }
  // Begins a new image; tracks that are not added to it are forgotten.
  void begin(LocalTime at) {
    at_ = at;
    now_.swap(before_);
    now_.clear();
  }
  // Adds a track of this image. Beyond `most` of them the rest is new in each image.
  void add(TrackId track) {
    if (now_.size() >= now_.capacity()) return;
    now_.push_back({track, before_.empty() ? at_ - kLong : since(before_, track, at_)});
  }
  // Returns the time between the first and the newest of the images in a row that have the track; zero, if it is in
  // none. It is long, if the image before the first one had no track.
  Duration known_for(TrackId track) const { return at_ - since(now_, track, at_); }

 private:
  struct Known {
    TrackId track{};
    LocalTime since{};
  };
  static LocalTime since(const std::vector<Known>& known, TrackId track, LocalTime otherwise) {
    for (const Known& one : known)
      if (one.track == track) return one.since;
    return otherwise;
  }

  std::vector<Known> now_, before_;
  LocalTime at_{};
};

}  // namespace ttf::nodes::driving
