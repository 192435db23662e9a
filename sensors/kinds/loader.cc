#include "sensors/kinds/loader.h"

#include <fmt/format.h>

#include <array>

#include "core/counted.h"
#include "core/nearest.h"
#include "sensors/recorded/recorded.h"

namespace ttf::sensors::kinds {
namespace {

using schedules::model::SensorKind;

// A kind's word is also the name of its usual entry.
template <class Kind> constexpr std::string_view kWord = schedules::model::row_of(Kind::kKind).word;

template <std::size_t kCount>
std::string word(YamlMap& yaml, std::string_view key, const std::array<std::string_view, kCount>& words) {
  if (!yaml.has(key)) return "";
  Choices<std::string_view> choices;
  for (const std::string_view one : words) choices.emplace_back(one, one);
  return std::string(yaml.choice(key, choices));
}

// Reads all of an entry but its kind.
template <class Kind> SensorEntry<Kind> load_entry(YamlMap& yaml, std::string name) {
  SensorEntry<Kind> entry;
  entry.name = std::move(name);
  entry.model = Kind::load_model(yaml);
  if (auto preprocessing = yaml.map_if("preprocessing")) {
    entry.preprocessing = Kind::load_preprocessing(*preprocessing);
    preprocessing->finish();
  }
  if (yaml.has("period"))
    entry.period = yaml.duration("period", {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  entry.style.colour = word(yaml, "colour", recording::log::kSensorColours);
  entry.style.marker = word(yaml, "marker", recording::log::kSensorMarkers);
  yaml.finish();
  return entry;
}

// Returns why the entry has no kind, which decides which other keys there are.
std::string kind_missing(const std::string& name) {
  std::vector<std::string> words;
  for (const schedules::model::SensorKindRow& row : schedules::model::kSensorKinds) words.emplace_back(row.word);
  return "is missing: must be one of " + joined(words) + did_you_mean(name, words);
}

class Check {
 public:
  Check(const std::string& text, const std::string& file, const schedules::model::Cluster& cluster)
      : text_(text), file_(file), cluster_(cluster), recorded_(recorded::is_recorded(cluster)) {}

  template <class Kind> void check(const SensorsOfKind<Kind>& sensors) {
    for (const auto& entry : sensors.own) check_own(Kind::kKind, entry.name);
    for (const schedules::model::Sensor& sensor : cluster_.sensors)
      if (const auto& entry = sensors.of(sensor.name); sensor.kind == Kind::kKind && entry.period)
        check_period(entry.name, *entry.period, sensor);
  }

  void finish() const { findings_.throw_if_any(); }

 private:
  void check_own(SensorKind kind, const std::string& name) {
    const auto id = cluster_.find_sensor(name);
    if (!id) {
      std::vector<std::string> names;
      for (const schedules::model::Sensor& sensor : cluster_.sensors) names.push_back(sensor.name);
      fail(
          name, "", "",
          fmt::format("must be a sensor of {}: {}{}", cluster_.file, joined(names, " or "), did_you_mean(name, names)));
    } else if (const SensorKind theirs = cluster_.sensor(*id).kind; theirs != kind) {
      fail(name, "kind", std::string(schedules::model::row_of(kind).word),
           fmt::format("must be {}, as in {}", schedules::model::row_of(theirs).word, cluster_.file));
    } else if (recorded_) {
      fail(name, "", "", fmt::format("must be absent: {} plays a recording of it", cluster_.file));
    }
  }

  void check_period(const std::string& name, Duration period, const schedules::model::Sensor& sensor) {
    if (recorded_) return;
    const std::string_view where = cluster_.file;
    if (sensor.follows())
      fail(name, "period", text(period),
           fmt::format("must be absent: in {} {} measures at each end of {}", where, sensor.name, sensor.after));
    else if (sensor.period != period)
      fail(name, "period", text(period),
           fmt::format("must be {}, the period of {} in {}", text(sensor.period), sensor.name, where));
  }

  static std::string text(Duration period) { return fmt::format("{} ms", static_cast<double>(period.ns) * 1e-6); }

  void fail(const std::string& name, std::string_view key, std::string value, std::string expected) {
    Findings none;
    const YamlMap entry = StrictYaml::parse(text_, file_).root(none).map("sensors").map(name);
    findings_.add({file_, entry.line(key), fmt::format("sensors.{}{}{}", name, key.empty() ? "" : ".", key),
                   std::move(value), std::move(expected)});
  }

  const std::string& text_;
  const std::string& file_;
  const schedules::model::Cluster& cluster_;
  bool recorded_;
  Findings findings_;
};

}  // namespace

Sensors load_sensors(YamlMap& yaml) {
  Sensors sensors;
  Sensors::each(sensors, [&]<class Kind>(SensorsOfKind<Kind>& kind) {
    constexpr std::string_view kName = kWord<Kind>;
    if (auto entry = yaml.map_if(kName)) {
      entry->choice_or<SensorKind>("kind", Kind::kKind, {{kName, Kind::kKind}});
      kind.usual = load_entry<Kind>(*entry, std::string(kName));
    }
  });
  for (auto& [name, entry] : yaml.other_maps()) {
    if (entry.lacks("kind")) {
      entry.fail("kind", kind_missing(name));
      continue;
    }
    Sensors::of_kind(sensors, entry.choice("kind", schedules::model::kind_choices()),
                     [&name = name, &entry = entry]<class Kind>(SensorsOfKind<Kind>& kind) {
                       kind.own.push_back(load_entry<Kind>(entry, name));
                       kind.own.back().style.kind = kWord<Kind>;
                     });
  }
  return sensors;
}

void load_preprocessing(YamlMap& yaml, Sensors& sensors) {
  Sensors::each(sensors, [&]<class Kind>(SensorsOfKind<Kind>& kind) {
    if (auto map = yaml.map_if(kWord<Kind>)) {
      kind.preprocessing = Kind::load_preprocessing(*map);
      map->finish();
    }
  });
}

void check_sensors(const Sensors& sensors, const std::string& text, const std::string& file,
                   const schedules::model::Cluster& cluster) {
  Check check(text, file, cluster);
  Sensors::each(sensors, [&](const auto& kind) { check.check(kind); });
  check.finish();
}

}  // namespace ttf::sensors::kinds
