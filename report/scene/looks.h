// How a scene is drawn: the one list of looks and limits for the still (still.cc) and for the canvas of a page, which
// has it in its data (packed.h). Lengths are in a still's units and a page's pixels. The still has a colour of its own for
// each kind of part, the page one of its theme.
#pragma once

#include <cstddef>
#include <string_view>

namespace ttf::report::scene {

struct Look {
  std::string_view part;
  double width = 0.0;          // a line's; 0: no line
  std::string_view dash = {};  // as stroke-dasharray
  double opacity = 1.0;        // the line's
  double covers = 0.0;         // the filling's opacity
};
inline constexpr Look kLooks[] = {{"field", 0.8, "6 4", 0.6, 0.05},
                                  {"truth", 1.1, {}, 1.0, 0.25},
                                  {"trail", 1.0, {}, 0.6},
                                  {"ellipse", 0.8},
                                  {"track", 1.6},
                                  {"coasting", 1.6, "4 3"},  // a track that was not observed of late
                                  {"velocity", 1.0},
                                  {"observation", 1.4},
                                  {"warning", 2.6},
                                  {"vehicle", 0.0, {}, 1.0, 1.0}};
// The name of a part that is not there does not compile.
consteval Look look_of(std::string_view part) {
  for (const Look& look : kLooks)
    if (look.part == part) return look;
  throw "no such part";
}

// With more tracks than kMostNamed, ids are left out. With more observations than kMostLarge, their markers are small.
inline constexpr std::size_t kMostNamed = 100, kMostLarge = 200;
inline constexpr double kLarge = 8.0, kSmall = 5.0;  // markers' sizes

// A track's velocity is its way in kAhead_s. A shorter way than kLeastWay_m is not drawn.
inline constexpr double kAhead_s = 1.0, kLeastWay_m = 0.1;

// The vehicle is an arrow head along x, about its origin: x to the right, y up.
inline constexpr double kVehicle[][2] = {{7, 0}, {-6, 6}, {-6, -6}};

}  // namespace ttf::report::scene
