#include "recording/exports/viewer/scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

namespace ttf::recording::exports::viewer {
namespace {

constexpr double kTextSize_px = 14.0, kLine_px = 2.0, kCross_m = 0.25;
constexpr double kShort_m = 0.1;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

void set_colour(::foxglove::Color& out, Colour colour) {
  out.set_r(colour.r);
  out.set_g(colour.g);
  out.set_b(colour.b);
  out.set_a(colour.a);
}

void add_point(::foxglove::LinePrimitive& line, double x, double y) {
  ::foxglove::Point3& out = *line.add_points();
  out.set_x(x);
  out.set_y(y);
}

::foxglove::LinePrimitive& add_line(::foxglove::SceneEntity& entity, ::foxglove::LinePrimitive::Type type,
                                    Colour colour) {
  ::foxglove::LinePrimitive& line = *entity.add_lines();
  line.set_type(type);
  set_pose(*line.mutable_pose(), {});
  line.set_thickness(kLine_px);
  line.set_scale_invariant(true);
  set_colour(*line.mutable_color(), colour);
  return line;
}

}  // namespace

Colour colour_of(std::string_view text) {
  unsigned rgb = 0;
  if (text.size() != 7 || text[0] != '#') return {};
  const auto [end, failure] = std::from_chars(text.data() + 1, text.data() + text.size(), rgb, 16);
  if (failure != std::errc{} || end != text.data() + text.size()) return {};
  const auto part = [rgb](unsigned shift) { return static_cast<double>(rgb >> shift & 0xffu) / 255.0; };
  return {part(16), part(8), part(0), 1.0};
}

void set_stamp(google::protobuf::Timestamp& out, TrueTime at) {
  out.set_seconds(at.ns / kSecond_ns);
  out.set_nanos(static_cast<std::int32_t>(at.ns % kSecond_ns));
}

void set_pose(::foxglove::Pose& out, const scene::Pose& place, double z) {
  out.mutable_position()->set_x(place.x);
  out.mutable_position()->set_y(place.y);
  out.mutable_position()->set_z(z);
  out.mutable_orientation()->set_z(std::sin(0.5 * place.heading));
  out.mutable_orientation()->set_w(std::cos(0.5 * place.heading));
}

::foxglove::SceneEntity& add_entity(::foxglove::SceneUpdate& update, TrueTime at, const std::string& frame,
                                    const std::string& id, Duration lifetime) {
  ::foxglove::SceneEntity& entity = *update.add_entities();
  set_stamp(*entity.mutable_timestamp(), at);
  entity.set_frame_id(frame);
  entity.set_id(id);
  entity.mutable_lifetime()->set_seconds(lifetime.ns / kSecond_ns);
  entity.mutable_lifetime()->set_nanos(static_cast<std::int32_t>(lifetime.ns % kSecond_ns));
  entity.set_frame_locked(true);
  return entity;
}

void add_box(::foxglove::SceneEntity& entity, const scene::Pose& place, double length, double width, Colour colour) {
  ::foxglove::CubePrimitive& box = *entity.add_cubes();
  set_pose(*box.mutable_pose(), place, 0.5 * kHeight_m);
  box.mutable_size()->set_x(length);
  box.mutable_size()->set_y(width);
  box.mutable_size()->set_z(kHeight_m);
  set_colour(*box.mutable_color(), colour);
}

void add_way(::foxglove::SceneEntity& entity, const scene::Pose& from, const scene::Pose& to, Colour colour) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > kShort_m)) return;
  const double head = std::min(0.3 * length, 1.0);
  ::foxglove::ArrowPrimitive& arrow = *entity.add_arrows();
  set_pose(*arrow.mutable_pose(), {from.x, from.y, std::atan2(to.y - from.y, to.x - from.x)}, kHeight_m);
  arrow.set_shaft_length(length - head);
  arrow.set_shaft_diameter(0.15);
  arrow.set_head_length(head);
  arrow.set_head_diameter(0.4);
  set_colour(*arrow.mutable_color(), colour);
}

void add_text(::foxglove::SceneEntity& entity, scene::Point at, const std::string& text, Colour colour) {
  ::foxglove::TextPrimitive& out = *entity.add_texts();
  set_pose(*out.mutable_pose(), {at.x, at.y, 0.0}, 1.5 * kHeight_m);
  out.set_billboard(true);
  out.set_font_size(kTextSize_px);
  out.set_scale_invariant(true);
  set_colour(*out.mutable_color(), colour);
  out.set_text(text);
}

void add_loop(::foxglove::SceneEntity& entity, std::span<const scene::Point> points, Colour colour) {
  ::foxglove::LinePrimitive& line = add_line(entity, ::foxglove::LinePrimitive::LINE_LOOP, colour);
  for (const scene::Point& point : points) add_point(line, point.x, point.y);
}

void add_crosses(::foxglove::SceneEntity& entity, std::span<const scene::Point> points, Colour colour) {
  ::foxglove::LinePrimitive& line = add_line(entity, ::foxglove::LinePrimitive::LINE_LIST, colour);
  for (const scene::Point& point : points) {
    add_point(line, point.x - kCross_m, point.y);
    add_point(line, point.x + kCross_m, point.y);
    add_point(line, point.x, point.y - kCross_m);
    add_point(line, point.x, point.y + kCross_m);
  }
}

}  // namespace ttf::recording::exports::viewer
