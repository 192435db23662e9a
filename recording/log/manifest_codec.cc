#include "recording/log/manifest_codec.h"

#include <fmt/format.h>
#include <zlib.h>

#include <charconv>
#include <optional>

namespace ttf::recording::log {
namespace {

std::string checksum(const ManifestEntries& entries) {
  uLong crc = 0;
  const auto add = [&crc](const std::string& text) {  // with its terminating zero, which separates neighbours
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(text.c_str()), text.size() + 1);
  };
  for (const auto& [key, value] : entries) {
    if (key == "crc32") continue;
    add(key);
    add(value);
  }
  return fmt::format("{:08x}", crc);
}

template <class Int> std::optional<Int> whole(std::string_view text) {
  Int value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Writers list names in order; any other order is damage.
bool append(std::vector<std::string>& names, std::string_view index, const std::string& name) {
  if (whole<std::size_t>(index) != names.size()) return false;
  names.push_back(name);
  return true;
}

// The words of a style in the manifest, by the beginnings of their keys.
constexpr std::pair<std::string_view, std::string SensorStyle::*> kStyleWords[] = {
    {"sensor_kind.", &SensorStyle::kind},
    {"sensor_colour.", &SensorStyle::colour},
    {"sensor_marker.", &SensorStyle::marker},
};
constexpr std::size_t kMostSensors = 256;  // as many as sensor ids exist

bool read_style(std::string SensorStyle::*word, std::string_view index, const std::string& value,
                std::vector<SensorStyle>& styles) {
  const auto sensor = whole<std::size_t>(index);
  if (!sensor || *sensor >= kMostSensors) return false;
  if (styles.size() <= *sensor) styles.resize(*sensor + 1);
  styles[*sensor].*word = value;
  return true;
}

bool read_entry(std::string_view key, const std::string& value, LogManifest& manifest) {
  const auto rest_after = [key](std::string_view prefix) -> std::optional<std::string_view> {
    if (key.substr(0, prefix.size()) != prefix) return std::nullopt;
    return key.substr(prefix.size());
  };
  if (key == "version") return manifest.version = value, true;
  if (key == "scenario") return manifest.scenario_name = value, true;
  if (key == "cluster") return manifest.cluster_name = value, true;
  if (key == "strategy") return manifest.strategy = value, true;
  if (key == "recording") return manifest.recording_name = value, true;
  if (key == "truth") return manifest.truth_name = value, true;
  if (key == "clock") return manifest.clock = value, true;
  if (key == "host") return manifest.host = value, true;
  if (key == "seed") {
    const auto seed = whole<std::uint64_t>(value);
    manifest.seed = seed.value_or(0);
    return seed.has_value();
  }
  if (key == "time_scale_ppm") {
    const auto scale = whole<std::int64_t>(value);
    if (!scale || *scale <= 0) return false;  // it is divided by
    return manifest.time_scale_ppm = *scale, true;
  }
  if (key == "cycles") {
    const auto cycles = whole<int>(value);
    if (!cycles || *cycles < 1 || *cycles > schedules::model::kMostCycles) return false;  // it is divided by
    return manifest.cycles = *cycles, true;
  }
  if (key == "cycle_ns") {
    const auto cycle = whole<std::int64_t>(value);
    manifest.cycle_ns = cycle.value_or(0);
    return cycle.has_value();
  }
  if (key == "bit_ps") {
    const auto bit = whole<std::int64_t>(value);
    manifest.bit_ps = bit.value_or(0);
    return bit.has_value();
  }
  if (const auto what = rest_after("hash.")) return manifest.hashes.emplace_back(*what, value), true;
  if (const auto index = rest_after("pdu.")) return append(manifest.pdu_names, *index, value);
  if (const auto index = rest_after("pdu_sensor.")) {
    const auto sensor = whole<std::uint8_t>(value);
    if (!sensor || whole<std::size_t>(*index) != manifest.pdu_sensors.size()) return false;
    return manifest.pdu_sensors.push_back(SensorId{*sensor}), true;
  }
  if (const auto index = rest_after("sensor.")) return append(manifest.sensor_names, *index, value);
  for (const auto& [prefix, word] : kStyleWords)
    if (const auto index = rest_after(prefix)) return read_style(word, *index, value, manifest.sensor_styles);
  if (const auto index = rest_after("can_bus.")) return append(manifest.can_bus_names, *index, value);
  if (key == "task_lists") {
    const auto count = whole<std::size_t>(value);
    if (!count || *count > 256) return false;  // as many as node ids exist
    return manifest.task_names.resize(*count), true;
  }
  if (const auto rest = rest_after("node.")) {
    const std::size_t dot = rest->find('.');
    if (dot == std::string_view::npos) return append(manifest.node_names, *rest, value);
    const auto node = whole<std::size_t>(rest->substr(0, dot));
    constexpr std::string_view kTask = "task.";
    const std::string_view task = rest->substr(dot + 1);
    if (!node || *node >= manifest.task_names.size() || task.substr(0, kTask.size()) != kTask) return false;
    return append(manifest.task_names[*node], task.substr(kTask.size()), value);
  }
  return true;  // a key of a later version
}

}  // namespace

ManifestEntries manifest_entries(const LogManifest& manifest) {
  ManifestEntries entries{{"version", manifest.version},
                          {"seed", std::to_string(manifest.seed)},
                          {"scenario", manifest.scenario_name},
                          {"cluster", manifest.cluster_name},
                          {"strategy", manifest.strategy},
                          {"cycle_ns", std::to_string(manifest.cycle_ns)},
                          {"bit_ps", std::to_string(manifest.bit_ps)},
                          {"task_lists", std::to_string(manifest.task_names.size())}};
  if (!manifest.recording_name.empty()) entries.emplace_back("recording", manifest.recording_name);
  if (!manifest.truth_name.empty()) entries.emplace_back("truth", manifest.truth_name);
  if (!manifest.clock.empty()) entries.emplace_back("clock", manifest.clock);
  if (!manifest.host.empty()) entries.emplace_back("host", manifest.host);
  if (manifest.time_scale_ppm != 1'000'000)
    entries.emplace_back("time_scale_ppm", std::to_string(manifest.time_scale_ppm));
  if (manifest.cycles != schedules::model::kMostCycles) entries.emplace_back("cycles", std::to_string(manifest.cycles));
  for (const auto& [what, hash] : manifest.hashes) entries.emplace_back("hash." + what, hash);
  const auto list = [&entries](std::string_view prefix, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) entries.emplace_back(fmt::format("{}.{}", prefix, i), names[i]);
  };
  list("node", manifest.node_names);
  for (std::size_t i = 0; i < manifest.task_names.size(); ++i)
    list(fmt::format("node.{}.task", i), manifest.task_names[i]);
  list("pdu", manifest.pdu_names);
  for (std::size_t i = 0; i < manifest.pdu_sensors.size(); ++i)
    entries.emplace_back(fmt::format("pdu_sensor.{}", i), std::to_string(index_of(manifest.pdu_sensors[i])));
  list("sensor", manifest.sensor_names);
  for (std::size_t i = 0; i < manifest.sensor_styles.size(); ++i)
    for (const auto& [prefix, word] : kStyleWords)
      if (const std::string& value = manifest.sensor_styles[i].*word; !value.empty())
        entries.emplace_back(fmt::format("{}{}", prefix, i), value);
  list("can_bus", manifest.can_bus_names);
  entries.emplace_back("crc32", checksum(entries));
  return entries;
}

bool read_manifest(const ManifestEntries& entries, LogManifest& manifest) {
  bool sound = false;
  bool readable = true;
  for (const auto& [key, value] : entries) {
    if (key == "crc32")
      sound = value == checksum(entries);
    else
      readable = read_entry(key, value, manifest) && readable;
  }
  return sound && readable;
}

}  // namespace ttf::recording::log
