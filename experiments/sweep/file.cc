#include "experiments/sweep/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/counted.h"
#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "evaluation/measures/measure.h"
#include "experiments/sweep/keys.h"
#include "experiments/sweep/read_comparison.h"
#include "sim/drives/scenario.h"
#include "sim/drives/seeds.h"

namespace ttf::experiments::sweep {
namespace {

using evaluation::measures::find_measure;
using evaluation::measures::Measure;

constexpr std::size_t kMostParadigms = 64;
constexpr double kLargest = 1e12;
constexpr std::string_view kUsualMargin = "10 %";

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::string with_unit(double number, const std::string& unit) {
  return unit.empty() ? fmt::format("{}", number) : fmt::format("{} {}", number, unit);
}

// Rounds to six digits, so that tables show the simulated values exactly.
double rounded(double x) { return *number_of(fmt::format("{:.6g}", x)); }

constexpr std::string_view kNames = "must be of letters, digits, dots, _ and -, and not begin with a dot";

bool is_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
}

// Returns whether the store has such a column; its columns ignore case.
bool is_column(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return name == "point" || name == "replication" || name == "paradigm" || name == "status" ||
         find_measure(name) != nullptr;
}

class Reader {
 public:
  explicit Reader(const StrictYaml& yaml) : yaml_(yaml), root_(yaml.root(findings_)) {}

  SweepFile read() {
    file_.file = yaml_.name();
    file_.text = yaml_.text();
    root_.choice<bool>("kind", {{"sweep", true}});
    findings_.throw_if_any();  // the keys of another kind are not judged
    file_.name = root_.text("name");
    if (!is_name(file_.name)) root_.fail("name", std::string(kNames));
    file_.question = root_.text("question");
    file_.scenario_file = path_of(root_.text("scenario"));
    file_.scenario_line = root_.line("scenario");
    file_.seed = static_cast<std::uint64_t>(root_.integer("seed", sim::drives::kSeeds));
    file_.replications = static_cast<std::uint32_t>(root_.integer("replications", {1, kMostReplications}));
    read_paradigms();
    for (auto& [name, map] : root_.named_maps("axes")) read_axis(name, map);
    if (file_.axes.empty()) root_.fail("axes", "must have at least one");
    if (!file_.axes.empty() && file_.points() > kMostPoints)
      root_.fail("axes", fmt::format("must make at most {} points, not {}", kMostPoints, file_.points()));
    check_drives();
    check_keys(file_, findings_);
    read_measures();
    read_comparison(root_, file_);
    read_expectations();
    root_.finish();
    findings_.throw_if_any();
    return std::move(file_);
  }

 private:
  std::string path_of(const std::string& name) const {
    return (std::filesystem::path(yaml_.name()).parent_path() / name).lexically_normal().string();
  }

  std::string file_value(const std::string& key, const std::string& value) const {
    return is_file({key, value, "", 0}) && !value.empty() ? path_of(value) : value;
  }

  // A name before a slash is a paradigm's.
  Edit edit(const std::string& text, const std::string& value, int line) {
    const std::size_t slash = text.find('/');
    const std::string paradigm = slash == std::string::npos ? "" : text.substr(0, slash);
    const std::string key = slash == std::string::npos ? text : text.substr(slash + 1);
    const bool known = std::any_of(file_.paradigms.begin(), file_.paradigms.end(),
                                   [&](const Paradigm& one) { return one.name == paradigm; });
    if (slash != std::string::npos && !known)
      findings_.add({yaml_.name(), line, text, paradigm, "must be one of the paradigms, before the slash"});
    return {key, file_value(key, value), paradigm, line};
  }

  void read_paradigms() {
    for (auto& [name, map] : root_.named_maps("paradigms")) {
      Paradigm paradigm;
      paradigm.name = name;
      if (!is_name(name)) map.fail("", std::string(kNames));
      using fusion::strategies::kStrategyNames;
      paradigm.strategy =
          map.choice<fusion::strategies::StrategyKind>("strategy", {kStrategyNames.begin(), kStrategyNames.end()});
      if (map.has("cluster")) paradigm.cluster_file = path_of(map.text("cluster"));
      paradigm.cluster_line = map.line("cluster");
      if (map.has("set"))
        for (const auto& [key, value] : map.named_texts("set"))
          paradigm.edits.push_back({key, file_value(key, value), name, map.line("set")});
      map.finish();
      file_.paradigms.push_back(std::move(paradigm));
    }
    if (file_.paradigms.empty() || file_.paradigms.size() > kMostParadigms)
      root_.fail("paradigms", fmt::format("must be 1..{}", kMostParadigms));
  }

  void read_axis(const std::string& name, YamlMap& map) {
    Axis axis;
    axis.name = name;
    if (!is_name(name)) map.fail("", std::string(kNames));
    if (is_column(name))
      map.fail("", "must not have the name of a measure, nor be point, replication, paradigm or status");
    const bool settings = map.has("settings");
    if (!settings)
      for (const std::string& key : map.texts("keys")) axis.keys.push_back(edit(key, "", map.line("keys")));
    if (settings) {
      for (auto& [label, edits] : map.named_maps("settings")) {
        Setting setting{label, number_of(label), {}};
        for (const auto& [key, value] : map.map("settings").named_texts(label))
          setting.edits.push_back(edit(key, value, edits.line()));
        axis.settings.push_back(std::move(setting));
      }
      if (axis.settings.empty()) map.fail("settings", "must have at least one");
    } else if (map.has("uniform")) {
      axis.unit = map.text_or("unit", "");
      const std::vector<std::string> bounds = map.texts("uniform");
      const auto low = number_of(bounds.empty() ? "" : bounds[0]),
                 high = number_of(bounds.size() == 2 ? bounds[1] : "");
      if (low && high && *low < *high && std::abs(*low) <= kLargest && std::abs(*high) <= kLargest) {
        axis.low = *low;
        axis.high = *high;
        if (std::any_of(axis.keys.begin(), axis.keys.end(), [](const Edit& key) { return is_file(key); }))
          map.fail("keys", "must not name files if a number is drawn");
      } else {
        map.fail("uniform", "must be two numbers, the lower one first");
      }
    } else if (map.has("values")) {
      axis.unit = map.text_or("unit", "");
      for (const std::string& value : map.texts("values"))
        add(axis, axis.unit.empty() ? value : value + " " + axis.unit, number_of(value));
    } else {
      read_range(axis, map);
    }
    map.finish();
    for (const Setting& setting : axis.settings)
      if (std::count_if(axis.settings.begin(), axis.settings.end(),
                        [&](const Setting& other) { return other.label == setting.label; }) > 1)
        return map.fail("", fmt::format("must not have the value {} twice", setting.label));
    file_.axes.push_back(std::move(axis));
  }

  void read_range(Axis& axis, YamlMap& map) {
    const double from = map.number("from", {-kLargest, kLargest}), to = map.number("to", {-kLargest, kLargest});
    const auto count = map.integer("count", {2, static_cast<std::int64_t>(kMostPoints)});
    axis.logarithmic = map.choice_or<bool>("scale", false, {{"linear", false}, {"logarithmic", true}});
    axis.unit = map.text_or("unit", "");
    if (axis.logarithmic && (from <= 0.0 || to <= 0.0))
      return map.fail("scale", "must be linear, or both ends above 0");
    if (from == to) return map.fail("to", "must differ from `from`");
    for (std::int64_t i = 0; i < count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count - 1);
      const double value = rounded(axis.logarithmic ? from * std::pow(to / from, part) : from + part * (to - from));
      add(axis, with_unit(value, axis.unit), value);
    }
  }

  void add(Axis& axis, const std::string& value, std::optional<double> number) {
    Setting setting{value, number, {}};
    for (Edit one : axis.keys) {
      one.value = file_value(one.key, value);
      setting.edits.push_back(std::move(one));
    }
    axis.settings.push_back(std::move(setting));
  }

  void check_drives() {
    if (file_.drives() > kMostDrives)
      root_.fail("replications", fmt::format("must make at most {} drives, not {}", kMostDrives, file_.drives()));
  }

  void read_measures() {
    std::vector<std::string> names;
    for (const Measure& measure : evaluation::measures::measures())
      if (!measure.name.empty()) names.emplace_back(measure.name);
    file_.measures = root_.has("measures") ? root_.words("measures", names) : names;
    for (const std::string& name : file_.measures)
      if (std::count(file_.measures.begin(), file_.measures.end(), name) > 1)
        root_.fail("measures", fmt::format("must not have {} twice", name));
  }

  // Returns the margin's text.
  std::string read_margin(YamlMap& map, Expectation& expectation) {
    const Measure* measure = find_measure(expectation.measure);
    const Measure* other = find_measure(expectation.agrees);
    std::string text = map.text_or("margin", kUsualMargin);
    if (measure == nullptr || other == nullptr) return text;
    if (measure->unit != other->unit)
      map.fail("agrees",
               fmt::format("must have the unit of `measure`{}{}", measure->unit.empty() ? "" : ", ", measure->unit));
    const std::size_t space = text.find(' ');
    const auto number = number_of(text.substr(0, space));
    const std::string unit = space == std::string::npos ? "" : text.substr(space + 1);
    const bool share = unit == "%";
    if (!number || !(*number > 0.0) || !(*number <= (share ? 100.0 : kLargest)) || (!share && unit != measure->unit)) {
      const std::string absolute = measure->unit.empty() ? "0.1" : fmt::format("0.1 {}", measure->unit);
      map.fail("margin", fmt::format("must be a share above 0 and up to 100 of the second measure, as 5 %, or a "
                                     "difference above 0, as {}",
                                     absolute));
      return text;
    }
    expectation.margin = {share ? *number / 100.0 : *number, share};
    return text;
  }

  void read_expectations() {
    for (YamlMap& map : root_.maps_if("expect")) {
      Expectation expectation;
      expectation.measure = measure_of(map, "measure", file_);
      const bool agreement = map.has("agrees");
      if (agreement) expectation.agrees = measure_of(map, "agrees", file_);
      const auto less = paradigm_of(map, agreement ? "of" : "less", file_);
      const auto than = agreement ? less : paradigm_of(map, "than", file_);
      if (!agreement && less && less == than) map.fail("than", "must differ from `less`");
      if (agreement && expectation.agrees == expectation.measure) map.fail("agrees", "must differ from `measure`");
      if (less) expectation.less = file_.paradigms[*less].name;
      if (!agreement && than) expectation.than = file_.paradigms[*than].name;
      expectation.text =
          fmt::format("{} of {} less than of {}", expectation.measure, expectation.less, expectation.than);
      if (agreement) {
        expectation.text = fmt::format("{} of {} agrees with {}, margin {}", expectation.measure, expectation.less,
                                       expectation.agrees, read_margin(map, expectation));
      }
      if (map.has("where"))
        for (const auto& [name, label] : map.named_texts("where")) {
          const auto axis = std::find_if(file_.axes.begin(), file_.axes.end(), [&, &wanted = name](const Axis& one) {
            return one.name == wanted && !one.random();
          });
          const bool known = axis != file_.axes.end() &&
                             std::any_of(axis->settings.begin(), axis->settings.end(),
                                         [&, &wanted = label](const Setting& one) { return one.label == wanted; });
          if (!known)
            map.fail("where",
                     fmt::format("must name an axis of the grid and one of its values, not {}: {}", name, label));
          expectation.where[name] = label;
          expectation.text += fmt::format(", {} {}", name, label);
        }
      map.finish();
      file_.expectations.push_back(std::move(expectation));
    }
  }

  const StrictYaml& yaml_;
  Findings findings_;
  YamlMap root_;
  SweepFile file_;
};

}  // namespace

SweepFile load_sweep(const std::string& path) { return read_sweep(load_of_kind(path, FileKind::kExperiment)); }
SweepFile parse_sweep(std::string text, std::string name) {
  return read_sweep(StrictYaml::parse(std::move(text), std::move(name)));
}
SweepFile read_sweep(const StrictYaml& yaml) {
  expect_kind(yaml, FileKind::kExperiment);
  return Reader(yaml).read();
}

}  // namespace ttf::experiments::sweep
