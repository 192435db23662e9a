// The classes of objects in traffic, with the priors of their sizes.
//
// A class is a belief about an object before sensors have seen it: how long and wide such objects are, and how frequent. The
// tracker chooses among the classes of its configuration by its measurements of an object (fusion/tracks/parts/classes.h).
//
// Sources. Car: the mean of the world's car and its draws (docs/fusion/world.md). Van, truck, two-wheelers and pedestrian: the usual
// vehicles of the class, with the spread that a type approval allows (a truck from 7.5 t to a coach of 15 m). Shares: the labels of
// the KITTI object set (28,742 cars, 2,914 vans, 1,094 trucks and 511 trams, 1,627 cyclists, 4,487 pedestrians; Geiger, Lenz, Urtasun:
// Are we ready for autonomous driving?, CVPR 2012), rounded; motorbikes as half of the cyclists, as KITTI does not label them.
// Speeds: assumed, 20 m/s for traffic on roads, 5 m/s for cyclists, 1.5 m/s for pedestrians.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "fusion/sensors/observation.h"

namespace ttf::fusion::config {

// The prior of objects' length and width [m]. The defaults are a car's. An object keeps its size, so a wrong prior is a constant error until
// a sensor has seen both sides.
struct Sizes {
  double length = 4.4, length_sigma = 0.5;
  double width = 1.8, width_sigma = 0.15;
  double correlation = 0.0;
};

struct ClassPrior {
  std::string_view name;
  Sizes sizes;
  double share = 0.0;        // how frequent the class is, relative to the others
  double speed_sigma = 0.0;  // [m/s] over ground, of each component of a normal distribution about standing
  sensors::ClassId id = sensors::kNoClass;  // as observations report it; kNoClass: none does
};

// By the class code of the world and of a camera's boxes (sim/world/traffic/classes.h).
inline constexpr std::size_t kClassCount = 6;
inline constexpr std::array<ClassPrior, kClassCount> kClassPriors{{
    {"car", {4.4, 0.5, 1.8, 0.15, 0.0}, 0.72, 20.0, sensors::ClassId{0}},
    {"truck", {12.0, 2.5, 2.5, 0.1, 0.0}, 0.04, 20.0, sensors::ClassId{1}},
    {"van", {5.5, 0.5, 2.0, 0.1, 0.0}, 0.07, 20.0, sensors::ClassId{2}},
    {"motorbike", {2.2, 0.2, 0.8, 0.1, 0.0}, 0.02, 20.0, sensors::ClassId{3}},
    {"cyclist", {1.8, 0.1, 0.6, 0.1, 0.0}, 0.04, 5.0, sensors::ClassId{4}},
    {"pedestrian", {0.5, 0.1, 0.6, 0.1, 0.0}, 0.11, 1.5, sensors::ClassId{5}},
}};

// The id of a class is its place, which is the code on the bus.
static_assert([] {
  for (std::size_t k = 0; k < kClassCount; ++k)
    if (static_cast<std::size_t>(kClassPriors[k].id) != k) return false;
  return true;
}());

}  // namespace ttf::fusion::config
