#include "report/scene/packed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "recording/scene/geometry.h"
#include "report/drawing/base64.h"
#include "report/scene/looks.h"
#include "report/scene/view.h"

namespace ttf::report::scene {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "columns are little-endian");

// A column of numbers, as bytes.
template <class Number> class Column {
 public:
  // Adds the value in units of 1 / per_unit.
  template <class Given> void add(Given given, double per_unit = 1.0) {
    const double value = static_cast<double>(given) * per_unit;
    if constexpr (std::is_floating_point_v<Number>) {
      put(static_cast<Number>(value));
    } else {
      using Limits = std::numeric_limits<Number>;
      const double whole = std::isnan(value) ? 0.0 : std::round(value);
      put(static_cast<Number>(
          std::clamp(whole, static_cast<double>(Limits::min()), static_cast<double>(Limits::max()))));
    }
  }
  std::string text() const { return drawing::base64(bytes_); }

 private:
  void put(Number number) { bytes_.append(reinterpret_cast<const char*>(&number), sizeof number); }

  std::string bytes_;
};

struct Times {
  Column<double> at;
  Column<std::uint16_t> count;
  template <class Part> Times(const std::vector<Moment<Part>>& moments, Duration life) {
    const auto add = [this](TrueTime t, std::size_t parts) {
      at.add(static_cast<double>(t.ns) * 1e-9);
      count.add(static_cast<double>(parts));
    };
    for (std::size_t m = 0; m < moments.size(); ++m) {
      add(moments[m].at, most(moments[m]));
      if (life != kOwnLife && !counts_until_next(moments, m, life)) add(moments[m].at + life + Duration{1}, 0);
    }
  }
  template <class Part> static std::size_t most(const Moment<Part>& moment) {
    return std::min<std::size_t>(moment.parts.size(), std::numeric_limits<std::uint16_t>::max());
  }
  Json json() const { return {{"at", at.text()}, {"count", count.text()}}; }
};

template <class Part, class F> void each(const std::vector<Moment<Part>>& moments, F&& f) {
  for (const Moment<Part>& moment : moments)
    for (std::size_t i = 0; i < Times::most(moment); ++i) f(moment.parts[i]);
}

double angle(float heading) {
  return std::remainder(static_cast<double>(heading), 2.0 * std::numbers::pi) / std::numbers::pi * 32767.0;
}

Json truth_json(const Scene& scene, double unit) {
  Column<std::uint16_t> id;
  Column<std::int16_t> x, y, heading;
  std::map<std::uint16_t, std::pair<float, float>> sizes;
  each(scene.truth, [&](const TrueObject& one) {
    id.add(static_cast<double>(index_of(one.id)));
    x.add(one.x, 1.0 / unit);
    y.add(one.y, 1.0 / unit);
    heading.add(angle(one.heading));
    sizes[static_cast<std::uint16_t>(one.id)] = {one.length, one.width};
  });
  Json json = Times(scene.truth, kObjectLife).json();
  json["id"] = id.text();
  json["x"] = x.text();
  json["y"] = y.text();
  json["heading"] = heading.text();
  Column<std::uint16_t> of, length, width;
  for (const auto& [object, size] : sizes) {
    of.add(object);
    length.add(size.first, 100.0);
    width.add(size.second, 100.0);
  }
  json["sizes"] = {{"id", of.text()}, {"length", length.text()}, {"width", width.text()}};
  return json;
}

Json images_json(const Scene& scene, double unit) {
  Column<std::uint16_t> id, length, width, sigma_x, sigma_y;
  Column<std::int16_t> x, y, heading, speed;
  Column<std::int8_t> correlation;
  Column<std::uint8_t> status;
  each(scene.images, [&](const ShownTrack& one) {
    id.add(static_cast<double>(index_of(one.id)));
    x.add(one.x, 1.0 / unit);
    y.add(one.y, 1.0 / unit);
    heading.add(angle(one.heading));
    speed.add(one.speed, 100.0);
    length.add(one.length, 100.0);
    width.add(one.width, 100.0);
    sigma_x.add(one.sigma_x, 100.0);
    sigma_y.add(one.sigma_y, 100.0);
    correlation.add(one.correlation, 127.0);
    status.add(one.status);
  });
  Json json = Times(scene.images, kObjectLife).json();
  json["id"] = id.text();
  json["x"] = x.text();
  json["y"] = y.text();
  json["heading"] = heading.text();
  json["speed"] = speed.text();
  json["length"] = length.text();
  json["width"] = width.text();
  json["sigma_x"] = sigma_x.text();
  json["sigma_y"] = sigma_y.text();
  json["correlation"] = correlation.text();
  json["status"] = status.text();
  return json;
}

Json list_json(const std::vector<Moment<Point>>& moments, double unit) {
  Column<std::int16_t> x, y;
  each(moments, [&](const Point& one) {
    x.add(one.x, 1.0 / unit);
    y.add(one.y, 1.0 / unit);
  });
  Json json = Times(moments, kListLife).json();
  json["x"] = x.text();
  json["y"] = y.text();
  return json;
}

Json own_json(const Scene& scene) {
  Column<std::int16_t> speed;
  Column<float> yaw_rate;
  each(scene.own, [&](const OwnMotion& one) {
    speed.add(one.speed, 100.0);
    yaw_rate.add(one.yaw_rate);
  });
  Json json = Times(scene.own, kOwnLife).json();
  json["speed"] = speed.text();
  json["yaw_rate"] = yaw_rate.text();
  return json;
}

Json warnings_json(const Scene& scene) {
  Column<std::uint16_t> id, word;
  Json words = Json::array();
  std::map<std::string, std::size_t> places;
  each(scene.warnings, [&](const Warning& one) {
    const auto [place, added] = places.try_emplace(words_of(one), places.size());
    if (added) words.push_back(place->first);
    id.add(static_cast<double>(index_of(one.track)));
    word.add(static_cast<double>(place->second));
  });
  Json json = Times(scene.warnings, kObjectLife).json();
  json["id"] = id.text();
  json["word"] = word.text();
  json["words"] = words;
  return json;
}

Json sensor_json(const Scene& scene, std::size_t index, const drawing::Names& names) {
  const ViewedSensor& sensor = scene.sensors[index];
  const drawing::MarkerShape marker = drawing::shape_of(drawing::sensor_marker(names, static_cast<SensorId>(index)));
  // No sensor has a circle, which has no lines (recording/log/sensor_style.h).
  Json json{{"name", sensor.name}, {"colour", sensor.colour}, {"lines", Json::array()}, {"closed", marker.closed}};
  for (const std::vector<drawing::Point>& line : marker.lines) {
    Json& points = json["lines"].emplace_back(Json::array());
    for (const drawing::Point& p : line) points.push_back({p.x, p.y});
  }
  if (sensor.odometry) json["odometry"] = true;
  json["edge"] = Json::array();
  if (!sensor.field || !sensor.mounting) return json;
  const auto cm = [](double metres) { return std::round(metres * 100.0) / 100.0; };
  for (const Point& p : recording::scene::mounted(*sensor.mounting, recording::scene::edge(*sensor.field)))
    json["edge"].push_back({cm(p.x), cm(p.y)});
  return json;
}

Json rules_json() {
  Json json{{"trail", kTrail.seconds()},
            {"sigmas", recording::scene::kEllipseSigmas},
            {"ellipse_points", recording::scene::kEllipsePoints},
            {"confirmed", static_cast<int>(recording::records::ImageStatus::kConfirmed)},
            {"coasting", static_cast<int>(recording::records::ImageStatus::kCoasting)},
            {"most_named", kMostNamed},
            {"most_large", kMostLarge},
            {"large", kLarge},
            {"small", kSmall},
            {"ahead", kAhead_s},
            {"least_way", kLeastWay_m},
            {"vehicle", Json::array()}};
  for (const auto& [x, y] : kVehicle) json["vehicle"].push_back({x, y});
  for (const Look& look : kLooks)
    json["looks"][std::string(look.part)] = {
        {"width", look.width}, {"dash", look.dash}, {"opacity", look.opacity}, {"covers", look.covers}};
  return json;
}

// The centimetre, or as much as the farthest object needs.
double unit_of(const Scene& scene) {
  double farthest = 0.0;
  const auto reach = [&](const auto& one) {
    farthest = std::max({farthest, std::abs(static_cast<double>(one.x)), std::abs(static_cast<double>(one.y))});
  };
  each(scene.truth, reach);
  each(scene.images, reach);
  for (const auto& moments : scene.lists) each(moments, reach);
  return std::max(0.01, farthest / 32000.0);
}

}  // namespace

Json packed(const Scene& scene, const drawing::Names& names, const std::string& label, int colour) {
  const double unit = unit_of(scene);
  Json json{{"label", label},
            {"colour", colour},
            {"from", static_cast<double>(scene.first.ns) * 1e-9},
            {"to", static_cast<double>(scene.last.ns) * 1e-9},
            {"unit", unit},
            {"note", scene.thinned_words()},
            {"rules", rules_json()},
            {"sensors", Json::array()},
            {"truth", truth_json(scene, unit)},
            {"images", images_json(scene, unit)},
            {"own", own_json(scene)},
            {"lists", Json::array()},
            {"warnings", warnings_json(scene)}};
  for (std::size_t s = 0; s < scene.sensors.size(); ++s) {
    json["sensors"].push_back(sensor_json(scene, s, names));
    json["lists"].push_back(list_json(scene.lists[s], unit));
  }
  return json;
}

}  // namespace ttf::report::scene
