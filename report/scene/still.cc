#include "report/scene/still.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "recording/scene/geometry.h"
#include "report/drawing/axes.h"
#include "report/scene/looks.h"
#include "report/scene/view.h"

namespace ttf::report::scene {
namespace {

using drawing::LegendEntry;
constexpr double kBeside = 90;  // units left and right of the plot
constexpr std::string_view kTruth = "#777777", kTrack = drawing::kBlack, kWarning = "#d00000";

double wide(float value) { return static_cast<double>(value); }

drawing::Paint line_of(const Look& look, std::string_view colour) {
  return {.stroke = colour, .width = look.width, .dash = look.dash, .opacity = look.opacity};
}

recording::records::ImageObject image_of(const ShownTrack& track) {
  recording::records::ImageObject object;
  object.x = wide(track.x);
  object.y = wide(track.y);
  object.sigma_x = wide(track.sigma_x);
  object.sigma_y = wide(track.sigma_y);
  object.correlation_xy = wide(track.correlation);
  return object;
}
template <class Object> std::array<Point, 4> corners(const Object& one) {
  return recording::scene::rectangle({wide(one.x), wide(one.y), wide(one.heading)}, wide(one.length), wide(one.width));
}

struct Window {
  drawing::Extent x, y;
  double scale = 1.0;  // user units per metre
};

// The wider extent fills its side of at most 1100 x 760 on a screen; the vehicle at the origin is always there.
Window window_of(const View& view, const drawing::Sheet& sheet) {
  Window window;
  const auto take = [&](const auto& points) {
    for (const auto& p : points) window.x.add(p.x), window.y.add(p.y);
  };
  take(std::array{Point{0.0, 0.0}});
  for (const TrueObject& one : view.truth) take(corners(one));
  for (const ShownTrack& one : view.tracks) take(corners(one));
  for (const auto& points : view.lists) take(points);
  for (const auto& points : view.trails) take(points);
  window.x = window.x.padded(0.04, 8.0);
  window.y = window.y.padded(0.06, 8.0);
  const bool on_paper = sheet.on_paper();
  const double widest = sheet.plot_width(1100, kBeside), highest = on_paper ? 0.8 * widest : 760.0;
  window.scale = std::min(widest / window.x.size(), highest / window.y.size());
  window.x = window.x.padded(0.0, (on_paper ? widest : 420.0) / window.scale);
  window.y = window.y.padded(0.0, (on_paper ? 90.0 : 200.0) / window.scale);
  return window;
}

std::vector<LegendEntry> legend_of(const Scene& scene, const View& view, const drawing::Names& names) {
  std::vector<LegendEntry> legend;
  const auto add = [&](LegendEntry::Kind kind, std::string text, std::string_view colour) {
    legend.push_back({kind, std::move(text), std::string(colour)});
  };
  if (!view.truth.empty()) add(LegendEntry::Kind::kBox, "true object", kTruth);
  if (!view.tracks.empty()) {
    const bool named = view.tracks.size() <= kMostNamed;
    add(LegendEntry::Kind::kBox,
        fmt::format("track, with {}ellipse of {:g} sigma and trail of {:g} s; arrow: its way in {:g} s{}",
                    named ? "its id, " : "", recording::scene::kEllipseSigmas, kTrail.seconds(), kAhead_s,
                    scene.own.empty() ? "" : ", as the vehicle sees it"),
        kTrack);
    const auto coasts = [](const ShownTrack& one) {
      return has(one.status, recording::records::ImageStatus::kCoasting);
    };
    if (std::ranges::any_of(view.tracks, coasts)) add(LegendEntry::Kind::kBox, "dashed: not observed of late", kTrack);
  }
  if (!view.warnings.empty()) add(LegendEntry::Kind::kBox, "warning", kWarning);
  for (std::size_t s = 0; s < scene.sensors.size(); ++s) {
    if (scene.sensors[s].odometry) continue;
    const auto id = static_cast<SensorId>(s);
    const bool field = scene.sensors[s].field && scene.sensors[s].mounting;
    legend.push_back({LegendEntry::Kind::kMarker,
                      fmt::format("{}: observations{}", scene.sensors[s].name, field ? ", field" : ""),
                      scene.sensors[s].colour, drawing::sensor_marker(names, id)});
  }
  return legend;
}

class Painter {
 public:
  Painter(drawing::Svg& svg, const drawing::PlotFrame& frame, const drawing::Sheet& sheet)
      : svg_(svg), frame_(frame), name_size_(sheet.text(10.5)) {}

  void outline(std::span<const Point> points, const drawing::Paint& paint, std::string_view hover,
               std::string_view css_class, bool closed = true) {
    std::vector<drawing::Point> at;
    for (const Point& p : points) at.push_back(frame_.at(p.x, p.y));
    svg_.polyline(at, paint, closed, hover, css_class);
  }
  void field(const ViewedSensor& sensor) {
    if (!sensor.field || !sensor.mounting) return;
    const std::vector<Point> edge = recording::scene::mounted(*sensor.mounting, recording::scene::edge(*sensor.field));
    outline(edge, {.fill = sensor.colour, .opacity = look_of("field").covers}, {}, "field");
    outline(edge, line_of(look_of("field"), sensor.colour), sensor.name, "field");
  }
  void truth(const TrueObject& one) {
    const std::string fill = drawing::tint(kTruth, 1.0 - look_of("truth").covers);  // hides what is below it
    drawing::Paint paint = line_of(look_of("truth"), kTruth);
    paint.fill = fill;
    outline(corners(one), paint,
            fmt::format("object {}: {:.1f} m long, {:.1f} m wide", index_of(one.id), one.length, one.width), "truth");
  }
  void track(const ShownTrack& one, const View& view, std::span<const Point> trail) {
    if (trail.size() > 1) outline(trail, line_of(look_of("trail"), kTrack), {}, "trail", false);
    const std::vector<Point> around = recording::scene::ellipse(image_of(one));
    if (!around.empty()) outline(around, line_of(look_of("ellipse"), kTrack), {}, "ellipse");
    const bool coasting = has(one.status, recording::records::ImageStatus::kCoasting);
    outline(corners(one), line_of(coasting ? look_of("coasting") : look_of("track"), kTrack),
            fmt::format("track {}: {:.1f} m/s", index_of(one.id), one.speed), "track");
    const Pose later = moved_on(view, one, kAhead_s);
    if (std::hypot(later.x - wide(one.x), later.y - wide(one.y)) < kLeastWay_m) return;
    svg_.arrow(frame_.at(wide(one.x), wide(one.y)), frame_.at(later.x, later.y), line_of(look_of("velocity"), kTrack),
               {}, "velocity");
  }
  // Writes beside an object, where there is room.
  template <class Object>
  void name(const Object& one, const std::string& text, std::string_view colour, drawing::LabelSpace& labels) {
    drawing::Extent x, y;
    for (const Point& p : corners(one)) {
      const drawing::Point at = frame_.at(p.x, p.y);
      x.add(at.x), y.add(at.y);
    }
    const drawing::TextStyle style{
        .size = name_size_, .anchor = drawing::Anchor::kMiddle, .fill = colour, .bold = true, .halo = true};
    const double half = drawing::text_width(text, style.size, true) / 2, centre = (x.low + x.high) / 2;
    const std::array candidates{drawing::Point{centre, y.low - 5}, drawing::Point{centre, y.high + 13},
                                drawing::Point{x.high + 6 + half, (y.low + y.high) / 2 + 4},
                                drawing::Point{x.low - 6 - half, (y.low + y.high) / 2 + 4}};
    if (const auto at = labels.place(text, style, candidates, frame_.area())) svg_.text(*at, text, style);
  }

 private:
  drawing::Svg& svg_;
  const drawing::PlotFrame& frame_;
  double name_size_;
};

void paint(const Scene& scene, const View& view, const drawing::Names& names, const drawing::PlotFrame& frame,
           const drawing::Sheet& sheet, drawing::Svg& svg) {
  Painter painter(svg, frame, sheet);
  svg.open_group("scene", frame.area());
  for (const ViewedSensor& sensor : scene.sensors) painter.field(sensor);
  for (const TrueObject& one : view.truth) painter.truth(one);
  for (std::size_t t = 0; t < view.tracks.size(); ++t) painter.track(view.tracks[t], view, view.trails[t]);
  std::size_t observations = 0;
  for (const auto& points : view.lists) observations += points.size();
  const double size = observations <= kMostLarge ? kLarge : kSmall;
  for (std::size_t s = 0; s < view.lists.size(); ++s)
    for (const Point& p : view.lists[s])
      svg.marker(drawing::sensor_marker(names, static_cast<SensorId>(s)), frame.at(p.x, p.y), size,
                 line_of(look_of("observation"), scene.sensors[s].colour), scene.sensors[s].name, "observation");
  std::vector<drawing::Point> own;
  for (const auto& [x, y] : kVehicle) own.push_back({frame.at(0, 0).x + x, frame.at(0, 0).y - y});
  svg.polyline(own, {.fill = drawing::kBlack, .opacity = look_of("vehicle").covers}, true, "vehicle", "vehicle");
  drawing::LabelSpace labels;
  for (const Warning& warning : view.warnings) {
    const auto one = std::ranges::find(view.tracks, warning.track, &ShownTrack::id);
    painter.outline(corners(*one), line_of(look_of("warning"), kWarning), words_of(warning), "warning");
    painter.name(*one, fmt::format("{}: {}", index_of(one->id), words_of(warning)), kWarning, labels);
  }
  for (const ShownTrack& one : view.tracks)
    if (view.tracks.size() <= kMostNamed &&
        std::ranges::find(view.warnings, one.id, &Warning::track) == view.warnings.end())
      painter.name(one, std::to_string(index_of(one.id)), kTrack, labels);
  svg.close_group();
}

}  // namespace

std::string scene_svg(const Scene& scene, TrueTime at, const drawing::Names& names, std::string_view title,
                      const drawing::Sheet& sheet) {
  const View view = view_at(scene, at);
  const std::string heading = fmt::format("{}, at {:.3f} s", title, static_cast<double>(at.ns) * 1e-9);
  const auto empty = [](const auto& points) { return points.empty(); };
  if (view.truth.empty() && view.tracks.empty() && std::ranges::all_of(view.lists, empty))
    return drawing::empty_picture(heading, "At this instant the log has no object, no track and no observation.",
                                  sheet);
  const Window window = window_of(view, sheet);
  const double width = window.x.size() * window.scale, height = window.y.size() * window.scale;
  const std::vector<LegendEntry> legend = legend_of(scene, view, names);
  const double left = sheet.on_paper() ? 10 : 70, room = 70 + width - left;
  const std::vector<std::string> titles = drawing::broken(heading, sheet.text(14), sheet.line(room), true);
  const auto caption = [&](std::string_view words) { return drawing::broken(words, sheet.text(10), sheet.line(room)); };
  const std::vector<std::string> axes = caption("The arrow head is the vehicle: x forward, y to the left (ISO 8855)."),
                                 moved = caption(
                                     scene.own.empty()
                                         ? "Tracks are moved on by their velocity since the newest image."
                                         : "Tracks are moved on since the newest image. Trails are relative to the "
                                           "vehicle.");
  const auto rows = [](std::size_t lines) { return drawing::kLineHeight * static_cast<double>(lines); };
  const double legend_top = 34 + rows(titles.size() - 1);
  const double top = legend_top + legend_height(legend, room) + 8;
  drawing::Svg svg(width + kBeside, top + height + 48 + rows(axes.size() + moved.size()), heading, sheet);
  svg.lines({left + room / 2, 22}, titles, {.size = 14, .anchor = drawing::Anchor::kMiddle, .bold = true});
  draw_legend(svg, {left, legend_top}, room, legend);
  const drawing::PlotFrame frame({70, top, width, height}, window.x, window.y);
  frame.draw(svg, "x, forward [m]", "y, left [m]");
  paint(scene, view, names, frame, sheet, svg);
  const drawing::TextStyle small{.size = 10, .fill = "#444444"};
  svg.lines({left, top + height + 54}, axes, small);
  svg.lines({left, top + height + 54 + rows(axes.size())}, moved, small);
  return svg.str();
}

}  // namespace ttf::report::scene
