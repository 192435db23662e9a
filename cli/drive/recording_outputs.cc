#include "cli/drive/recording_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ttf::cli::drive {

std::string recordings_text(const std::vector<StrategyResult>& results) {
  std::vector<std::pair<std::string, std::string>> texts;  // names of strategies, and their sentences
  for (const StrategyResult& result : results) {
    if (!result.recording) continue;
    std::string text = drives::recording_text(*result.recording);
    const auto same = std::find_if(texts.begin(), texts.end(), [&](const auto& other) { return other.second == text; });
    if (same != texts.end())
      same->first += fmt::format(", {}", name_of(result.strategy));
    else
      texts.emplace_back(name_of(result.strategy), std::move(text));
  }
  std::string all;
  for (const auto& [names, text] : texts) all += fmt::format("recording with {}\n{}\n", names, text);
  return all;
}

nlohmann::ordered_json recording_json(const drives::RecordingUse& use) {
  nlohmann::ordered_json json{{"ends_after_s", use.ends_after.seconds()}, {"ends_early", use.ends_early()}};
  for (const drives::RecordingUse::OfSensor& of : use.sensors)
    json["sensors"].push_back({{"name", of.sensor},
                               {"rows", of.rows.rows},
                               {"lists", of.rows.lists},
                               {"unused_between_instants", of.rows.between},
                               {"unused_beyond_the_end", of.rows.beyond},
                               {"measurements_without_row", of.rows.silent}});
  return json;
}

}  // namespace ttf::cli::drive
