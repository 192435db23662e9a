// Parts of Foxglove's scenes, from a drive's terms: places in the plane, boxes, texts, lines.
//
// Heights are not in a log. Boxes are kHeight_m high and stand on the plane.
#pragma once

#include <span>
#include <string>

#include "core/time.h"
#include "recording/exports/viewer/colour.h"
#include "recording/exports/viewer/foxglove.pb.h"
#include "recording/scene/viewed.h"

namespace ttf::recording::exports::viewer {

inline constexpr double kHeight_m = 1.5;

void set_stamp(google::protobuf::Timestamp& out, TrueTime at);
void set_pose(::foxglove::Pose& out, const scene::Place& place, double z = 0.0);

// Adds an entity that the viewer removes after its lifetime; one without a lifetime stays.
::foxglove::SceneEntity& add_entity(::foxglove::SceneUpdate& update, TrueTime at, const std::string& frame,
                                    const std::string& id, Duration lifetime);
void add_box(::foxglove::SceneEntity& entity, const scene::Place& place, double length, double width, Colour colour);
// Adds an arrow from place to place, if they are not too near.
void add_way(::foxglove::SceneEntity& entity, const scene::Place& from, const scene::Place& to, Colour colour);
void add_text(::foxglove::SceneEntity& entity, scene::Point at, const std::string& text, Colour colour);
void add_loop(::foxglove::SceneEntity& entity, std::span<const scene::Point> points, Colour colour);
// Adds an upright cross at each point.
void add_crosses(::foxglove::SceneEntity& entity, std::span<const scene::Point> points, Colour colour);

}  // namespace ttf::recording::exports::viewer
