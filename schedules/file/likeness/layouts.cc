#include "schedules/file/likeness/layouts.h"

#include <cmath>
#include <utility>
#include <vector>

namespace ttf::schedules::file::likeness {
namespace {

struct Field {
  const char* name;
  const char* unit;
  int bits;
  double low = 0.0, resolution = 1.0, high = 0.0;  // high: 0 for all that the bits hold
};

std::vector<model::Signal> signals(const std::vector<Field>& fields, int& total_bits) {
  std::vector<model::Signal> made;
  total_bits = 0;
  for (const Field& field : fields) {
    const double top = field.low + (std::ldexp(1.0, field.bits) - 1.0) * field.resolution;
    made.push_back({field.name, field.unit, field.bits, field.low, field.high == 0.0 ? top : field.high,
                    field.resolution, total_bits});
    total_bits += field.bits;
  }
  return made;
}

model::PduLayout layout(int fragment_bytes, int max_elements, int per_fragment, const std::vector<Field>& header,
                        const std::vector<Field>& element) {
  model::PduLayout made;
  made.fragment_bytes = fragment_bytes;
  made.max_elements = max_elements;
  made.elements_per_fragment = per_fragment;
  made.header = signals(header, made.header_bits);
  made.element = signals(element, made.element_bits);
  made.header_bits = (made.header_bits + 7) / 8 * 8;
  return made;
}

const std::vector<Field> kScanHeader{{"sequence", "", 16}, {"fragment", "", 8}, {"count", "", 16}, {"spare", "", 24}};
const std::vector<Field> kListHeader{
    {"sequence", "", 16}, {"fragment", "", 8}, {"count", "", 8}, {"timestamp", "us", 32}};

// One of a camera's objects.
// Returns the fields of a camera's list, whose last eight bits are the camera's own.
std::vector<Field> silhouette(const std::vector<Field>& own) {
  std::vector<Field> fields{{"x", "m", 16, -163.84, 0.005},        {"y", "m", 16, -163.84, 0.005},
                            {"sigma_x", "m", 14, 0, 0.002},        {"sigma_y", "m", 14, 0, 0.002},
                            {"correlation", "", 8, -1, 0.0078125}, {"span", "rad", 12, 0, 0.0005},
                            {"sigma_span", "rad", 8, 0, 0.0002}};
  fields.insert(fields.end(), own.begin(), own.end());
  return fields;
}

KnownLayouts laser() {
  return {layout(64, 1300, 14, kScanHeader,
                 {{"layer", "", 2}, {"azimuth", "rad", 14, -1.6384, 0.0002}, {"range", "m", 16, 0, 0.005, 200}}),
          layout(56, 25, 3, kListHeader,
                 {{"x", "m", 16, -163.84, 0.005},
                  {"y", "m", 16, -163.84, 0.005},
                  {"heading", "rad", 12, -3.141592653589793, 0.0015339807878856412},
                  {"length", "m", 12, 0, 0.01},
                  {"width", "m", 12, 0, 0.01},
                  {"sigma_x", "m", 12, 0, 0.001},
                  {"sigma_y", "m", 12, 0, 0.001},
                  {"correlation", "", 8, -1, 0.0078125},
                  {"sigma_heading", "rad", 8, 0, 0.005},
                  {"sigma_length", "m", 8, 0, 0.02},
                  {"sigma_width", "m", 8, 0, 0.02},
                  {"valid", "", 4}})};
}

KnownLayouts camera() {
  return {
      layout(8, 40, 1, {{"sequence", "", 12}, {"fragment", "", 6}, {"count", "", 6}},
             {{"bearing", "rad", 14, -0.8192, 0.0001}, {"disparity", "px", 14, 0, 0.01}, {"width", "px", 12, 0, 0.25}}),
      layout(56, 25, 4, kListHeader, silhouette({{"spare", "", 8}}))};
}

KnownLayouts radar() {
  return {layout(64, 32, 8, kScanHeader,
                 {{"range", "m", 16, 0, 0.005},
                  {"azimuth", "rad", 16, -1.6384, 0.00005},
                  {"range_rate", "m/s", 16, -81.92, 0.0025},
                  {"power", "", 8, 0, 0.5}}),
          layout(56, 12, 4, kListHeader,
                 {{"range", "m", 16, 0, 0.005},
                  {"bearing", "rad", 16, -1.6384, 0.00005},
                  {"range_rate", "m/s", 16, -81.92, 0.0025},
                  {"sigma_range", "m", 16, 0, 0.0005},
                  {"sigma_bearing", "rad", 16, 0, 0.00002},
                  {"sigma_range_rate", "m/s", 12, 0, 0.002},
                  {"returns", "", 4}})};
}

KnownLayouts mono_camera() {
  return {layout(64, 16, 8, kScanHeader,
                 {{"left", "px", 13, -1024, 0.25},
                  {"right", "px", 13, -1024, 0.25},
                  {"bottom", "px", 12, -512, 0.25},
                  {"top", "px", 12, -512, 0.25},
                  {"class", "", 4},
                  {"spare", "", 2}}),
          layout(56, 8, 4, kListHeader, silhouette({{"class", "", 4}, {"spare", "", 4}}))};
}

}  // namespace

std::optional<KnownLayouts> known_layouts(model::SensorKind kind) {
  switch (kind) {
    case model::SensorKind::kLaser: return laser();
    case model::SensorKind::kCamera: return camera();
    case model::SensorKind::kRadar: return radar();
    case model::SensorKind::kMonoCamera: return mono_camera();
    case model::SensorKind::kOdometry: return std::nullopt;
  }
  return std::nullopt;
}

std::vector<std::pair<std::string_view, model::SensorKind>> known_kinds() {
  auto kinds = model::kind_choices();
  std::erase_if(kinds, [](const auto& one) { return !known_layouts(one.second); });
  return kinds;
}

}  // namespace ttf::schedules::file::likeness
