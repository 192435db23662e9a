// A scene as JSON for the page's script (report/page/scene_data.js). Numbers are columns of little-endian integers in base64:
//
//   at       float64 [s]      one a moment; "count", uint16, has the parts of each. The newest moment is shown: one that
//                             ends before the next (view.h) is followed by an empty one
//   x, y     int16            in units of "unit" [m]
//   heading  int16            [pi / 32768]
//   speed    int16 [cm/s], yaw_rate float32 [rad/s], length and width uint16 [cm], sigma_x and sigma_y uint16 [cm],
//   correlation int8 [1/127], word uint16: the place of a warning's words in "words"
//
// Values beyond their type are shown at its end. "rules" has the looks, limits and outlines (looks.h), the trail [s], the
// ellipse (recording/scene/geometry.h) and the bits of a track's status. So the script decides nothing: it interpolates,
// moves tracks on by the formula of recording::scene::moved_on(), and paints.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "report/drawing/names.h"
#include "report/scene/scene.h"

namespace ttf::report::scene {

// Bytes of a moment with so many parts, before base64. Those of a warning include its share of "words". The
// end of a moment that ends alone, 10 more, does not count.
template <class Part> constexpr std::size_t packed_bytes(std::size_t parts) {
  constexpr std::size_t kMoment = 10;
  constexpr std::size_t kPart = std::is_same_v<Part, TrueObject>   ? 8
                                : std::is_same_v<Part, ShownTrack> ? 20
                                : std::is_same_v<Part, OwnMotion>  ? 6
                                : std::is_same_v<Part, Warning>    ? 10
                                                                   : 4;
  return kMoment + kPart * parts;
}

// `colour` is the drive's number on the page.
nlohmann::ordered_json packed(const Scene& scene, const drawing::Names& names, const std::string& label, int colour);

}  // namespace ttf::report::scene
