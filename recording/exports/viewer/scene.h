// Parts of Foxglove's scenes, from a drive's terms: places in the plane, boxes, texts, lines.
//
// Heights are not in a log. Boxes are kHeight_m high and stand on the plane.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/time.h"
#include "recording/exports/viewer/foxglove.pb.h"
#include "recording/scene/viewed.h"

namespace ttf::recording::exports::viewer {

// Red, green, blue and opacity, each 0..1.
struct Colour {
  double r = 1.0, g = 1.0, b = 1.0, a = 1.0;
};
// Returns the colour of "#d55e00"; white for other texts.
Colour colour_of(std::string_view text);
constexpr Colour with_opacity(Colour colour, double a) { return {colour.r, colour.g, colour.b, a}; }

inline constexpr double kHeight_m = 1.5;

void set_stamp(google::protobuf::Timestamp& out, TrueTime at);
void set_pose(::foxglove::Pose& out, const scene::Pose& place, double z = 0.0);

// Adds an entity that the viewer removes after its lifetime; one without a lifetime stays.
::foxglove::SceneEntity& add_entity(::foxglove::SceneUpdate& update, TrueTime at, const std::string& frame,
                                    const std::string& id, Duration lifetime);
void add_box(::foxglove::SceneEntity& entity, const scene::Pose& place, double length, double width, Colour colour);
// Adds an arrow from place to place, if they are not too near.
void add_way(::foxglove::SceneEntity& entity, const scene::Pose& from, const scene::Pose& to, Colour colour);
void add_text(::foxglove::SceneEntity& entity, scene::Point at, const std::string& text, Colour colour);
void add_loop(::foxglove::SceneEntity& entity, std::span<const scene::Point> points, Colour colour);
// Adds an upright cross at each point.
void add_crosses(::foxglove::SceneEntity& entity, std::span<const scene::Point> points, Colour colour);

}  // namespace ttf::recording::exports::viewer
