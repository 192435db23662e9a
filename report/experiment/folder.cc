#include "report/experiment/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "report/drawing/figures.h"
#include "report/drive/results_folder.h"

namespace ttf::report::experiment {
namespace {

using Json = nlohmann::ordered_json;

// Reads required entries of answer.json and names the place of a missing or wrong one.
class AnswerReader {
 public:
  explicit AnswerReader(std::string path) : path_(std::move(path)) {}

  [[noreturn]] void refuse(const std::string& key, const std::string& expected) const {
    throw InputError({path_, 0, key, "", expected});
  }
  const Json& object(const Json& in, const std::string& place, const char* key) const {
    const Json& value = at(in, place, key);
    if (!value.is_object() || value.empty()) refuse(place + key, "must be a mapping with at least one entry");
    return value;
  }
  // Returns an empty list if the key is absent.
  const Json& list(const Json& in, const char* key) const {
    static const Json kNone = Json::array();
    const auto found = in.find(key);
    if (found == in.end()) return kNone;
    if (!found->is_array()) refuse(key, "must be a list");
    return *found;
  }
  std::string text(const Json& in, const std::string& place, const char* key) const {
    const Json& value = at(in, place, key);
    if (!value.is_string()) refuse(place + key, "must be text");
    return value.get<std::string>();
  }
  std::uint64_t count(const Json& in, const std::string& place, const char* key) const {
    const Json& value = at(in, place, key);
    if (!value.is_number_unsigned()) refuse(place + key, "must be a whole number from 0 on");
    return value.get<std::uint64_t>();
  }
  bool yes(const Json& in, const std::string& place, const char* key) const {
    const Json& value = at(in, place, key);
    if (!value.is_boolean()) refuse(place + key, "must be true or false");
    return value.get<bool>();
  }
  // Returns NaN for null.
  double number(const Json& in, const std::string& place, const char* key) const {
    const Json& value = at(in, place, key);
    if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value.is_number()) refuse(place + key, "must be a number or null");
    return value.get<double>();
  }
  experiments::results::Interval interval(const Json& in, const std::string& place) const {
    experiments::results::Interval read{count(in, place, "count"), number(in, place, "mean"),
                                        number(in, place, "half_width")};
    if (in.contains("low")) {
      read.low_end = number(in, place, "low");
      read.high_end = number(in, place, "high");
    }
    return read;
  }

 private:
  const Json& at(const Json& in, const std::string& place, const char* key) const {
    if (!in.is_object()) refuse(place.empty() ? place : place.substr(0, place.size() - 1), "must be a mapping");
    const auto found = in.find(key);
    if (found == in.end()) refuse(place + key, "is missing");
    return *found;
  }
  std::string path_;
};

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

void read_points(const AnswerReader& reader, const Json& json, ExperimentFolder& folder) {
  const Json& points = reader.list(json, "points");
  if (points.empty()) reader.refuse("points", "must have at least one");
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::string place = fmt::format("points[{}].", p);
    const Json& paradigms = reader.object(points[p], place, "paradigms");
    if (p == 0) {
      if (points[p].contains("axes")) folder.axes = keys_of(reader.object(points[p], place, "axes"));
      folder.paradigms = keys_of(paradigms);
      for (const std::string& name :
           keys_of(reader.object(paradigms, place + "paradigms.", folder.paradigms[0].c_str())))
        folder.measures.push_back({name, "", ""});
    }
    ExperimentPoint& point = folder.points.emplace_back();
    const std::uint64_t number = reader.count(points[p], place, "point");
    if (number > std::numeric_limits<std::uint32_t>::max()) reader.refuse(place + "point", "must be below 2^32");
    point.point = static_cast<std::uint32_t>(number);
    for (const std::string& axis : folder.axes)
      point.settings.push_back(reader.text(reader.object(points[p], place, "axes"), place + "axes.", axis.c_str()));
    for (const std::string& paradigm : folder.paradigms) {
      const std::string in_paradigm = place + "paradigms." + paradigm + ".";
      const Json& cells = reader.object(paradigms, place + "paradigms.", paradigm.c_str());
      std::vector<Estimate>& row = point.estimates.emplace_back();
      for (const ExperimentMeasure& measure : folder.measures) {
        const Json& cell = reader.object(cells, in_paradigm, measure.name.c_str());
        Estimate estimate{reader.interval(cell, in_paradigm + measure.name + "."), std::nullopt};
        if (const auto difference = cell.find("difference"); difference != cell.end())
          estimate.difference = reader.interval(*difference, in_paradigm + measure.name + ".difference.");
        row.push_back(estimate);
      }
    }
  }
}

// The interval of a change, and in per cent if it has that.
ExperimentChange read_change(const AnswerReader& reader, const Json& in, const std::string& place, const char* key) {
  const Json& json = reader.object(in, place, key);
  const std::string inside = place + key + ".";
  ExperimentChange change{reader.interval(json, inside), std::nullopt};
  if (const auto percent = json.find("percent"); percent != json.end()) {
    const std::string within = inside + "percent.";
    change.percent = {change.difference.count, reader.number(*percent, within, "mean"),
                      reader.number(*percent, within, "low"), reader.number(*percent, within, "high")};
  }
  return change;
}

void read_interactions(const AnswerReader& reader, const Json& json, ExperimentFolder& folder) {
  const Json& interactions = reader.list(json, "interactions");
  for (std::size_t i = 0; i < interactions.size(); ++i) {
    const Json& in = interactions[i];
    const std::string place = fmt::format("interactions[{}].", i);
    ExperimentInteraction& one =
        folder.interactions.emplace_back(ExperimentInteraction{reader.text(in, place, "measure"),
                                                               reader.text(in, place, "by"),
                                                               reader.text(in, place, "axis"),
                                                               reader.text(in, place, "from"),
                                                               reader.text(in, place, "to"),
                                                               reader.text(in, place, "lowers"),
                                                               reader.text(in, place, "more_than"),
                                                               {},
                                                               {}});
    for (const std::string& axis : folder.axes)
      if (axis != one.axis) one.others.push_back(axis);
    const Json& points = reader.list(in, "points");
    for (std::size_t p = 0; p < points.size(); ++p) {
      const std::string at = fmt::format("{}points[{}].", place, p);
      InteractionPoint& point = one.points.emplace_back();
      for (const std::string& axis : one.others)
        point.settings.push_back(reader.text(reader.object(points[p], at, "axes"), at + "axes.", axis.c_str()));
      point.first = read_change(reader, points[p], at, "first");
      point.second = read_change(reader, points[p], at, "second");
      point.interaction = read_change(reader, points[p], at, "interaction");
      point.stays = reader.yes(points[p].at("interaction"), at + "interaction.", "stays_certain");
    }
  }
}

}  // namespace

void read_store(const std::string& path, ExperimentFolder& folder) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return;
  folder.store = experiments::results::Store::open(path);
  // Only reading shows damage behind the first rows.
  try {
    folder.store->for_each([](const experiments::results::Row&) {});
  } catch (const std::runtime_error& error) {
    throw InputError({path, 0, "", "", std::string("must be a store of runs; SQLite says: ") + error.what()});
  }
  for (const ExperimentMeasure& measure : folder.measures)
    if (std::ranges::find(folder.store->head().measures, measure.name) == folder.store->head().measures.end())
      throw InputError(
          {path, 0, measure.name, "", "is no column of its runs: answer.json belongs to another experiment"});
}

std::string interval_words(const experiments::results::Interval& interval, bool sign, std::uint64_t runs) {
  std::string words = drawing::with_interval(interval.mean, interval.half_width, sign);
  if (interval.uneven())
    words = fmt::format("{}{} ({} to {})", sign && interval.mean > 0.0 ? "+" : "", drawing::brief(interval.mean),
                        drawing::brief(interval.low()), drawing::brief(interval.high()));
  if (interval.count < runs && interval.count > 0) words += fmt::format(" of {}", interval.count);
  return words;
}

ExperimentFolder parse_answer(std::string_view text, const std::string& file) {
  const Json json = drive::parse_json(text, file);
  const AnswerReader reader(file);
  ExperimentFolder folder;
  folder.name = reader.text(json, "", "experiment");
  folder.question = reader.text(json, "", "question");
  folder.answer = reader.text(json, "", "answer");
  folder.baseline = reader.text(json, "", "baseline");
  if (json.contains("file")) folder.file = reader.text(json, "", "file");
  if (json.contains("libraries")) folder.libraries = keys_of(reader.object(json, "", "libraries"));
  if (json.contains("compared_axis")) folder.compared_axis = reader.text(json, "", "compared_axis");
  folder.seed = reader.count(json, "", "seed");
  folder.drives = reader.count(json, "", "runs");
  folder.failed = reader.count(json, "", "failed");
  folder.confidence = reader.number(json, "", "confidence");
  if (!(folder.confidence > 0.0 && folder.confidence < 1.0)) reader.refuse("confidence", "must be above 0 and below 1");
  read_points(reader, json, folder);
  if (const auto measures = json.find("measures"); measures != json.end())
    for (ExperimentMeasure& measure : folder.measures) {
      const Json& one = reader.object(*measures, "measures.", measure.name.c_str());
      measure.unit = reader.text(one, "measures." + measure.name + ".", "unit");
      measure.meaning = reader.text(one, "measures." + measure.name + ".", "meaning");
    }
  const Json& crossings = reader.list(json, "crossings");
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    const std::string place = fmt::format("crossings[{}].", c);
    folder.crossings.push_back({reader.text(crossings[c], place, "paradigm"), reader.text(crossings[c], place, "axis"),
                                reader.text(crossings[c], place, "others"), reader.number(crossings[c], place, "at"),
                                reader.yes(crossings[c], place, "certain")});
  }
  read_interactions(reader, json, folder);
  const Json& expectations = reader.list(json, "expectations");
  for (std::size_t e = 0; e < expectations.size(); ++e) {
    const std::string place = fmt::format("expectations[{}].", e);
    ExperimentExpectation one{
        reader.text(expectations[e], place, "expected"), reader.yes(expectations[e], place, "holds"), {}, {}, {}};
    if (expectations[e].contains("outcome")) {
      one.outcome = experiments::results::outcome_of(reader.text(expectations[e], place, "outcome"));
      if (!one.outcome) reader.refuse(place + "outcome", "must be holds, does not hold or cannot tell");
    }
    const auto texts = [&](const char* key, std::vector<std::string>& into) {
      for (const Json& entry : reader.list(expectations[e], key))
        into.push_back(entry.is_string() ? entry.get<std::string>() : entry.dump());
    };
    texts("where_not", one.where_not);
    texts("why_not", one.why_not);
    folder.expectations.push_back(std::move(one));
  }
  return folder;
}

ExperimentFolder read_experiment_folder(const std::string& path) {
  const std::string file = path + "/answer.json";
  ExperimentFolder folder = parse_answer(read_file(file), file);
  folder.path = path;
  read_store(path + "/results.sqlite", folder);
  return folder;
}

}  // namespace ttf::report::experiment
