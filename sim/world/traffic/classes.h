// Classes of objects, with their usual sizes and radar cross-sections at 77 GHz.
//
// Sizes are nominal. Cross-sections are assumed, of the order that measurements show. A car has 10 m^2, a lorry ten times as much,
// a pedestrian less than 1 m^2. They vary with the aspect by ten decibels and more.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ttf::sim::world::traffic {

enum class ObjectClass : std::uint8_t { kCar, kTruck, kVan, kMotorbike, kCyclist, kPedestrian };

struct ClassTraits {
  std::string_view name;
  double length, width, height;  // [m]
  double cross_section;          // [m^2]
};
// By ObjectClass. The car is a Volkswagen Touran, the paper's.
inline constexpr std::array<ClassTraits, 6> kClasses{{{"car", 4.39, 1.79, 1.5, 10.0},
                                                      {"truck", 12.0, 2.5, 3.5, 100.0},
                                                      {"van", 5.5, 2.0, 2.3, 30.0},
                                                      {"motorbike", 2.2, 0.8, 1.5, 5.0},
                                                      {"cyclist", 1.8, 0.6, 1.8, 2.0},
                                                      {"pedestrian", 0.5, 0.6, 1.75, 0.5}}};
constexpr const ClassTraits& traits_of(ObjectClass kind) { return kClasses[static_cast<std::size_t>(kind)]; }

}  // namespace ttf::sim::world::traffic
