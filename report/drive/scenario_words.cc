#include "report/drive/scenario_words.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "core/strict_yaml.h"

namespace ttf::report::drive {

ScenarioWords scenario_in(const recording::merge::MergedLogs& log) {
  ScenarioWords words;
  for (const recording::log::Attachment& attachment : log.attachments()) {
    if (attachment.media_type != "application/yaml") continue;
    try {
      Findings findings;
      YamlMap root = StrictYaml::parse(attachment.bytes, attachment.name).root(findings);
      if (!root.has("world") && !root.has("evaluate_from")) continue;
      words.description = root.text_or("description", "");
      if (const std::string& trace = log.manifest().truth_name; !trace.empty())
        words.description =
            fmt::format("The world of {}, with the sensors and the tracker of {}", trace, log.manifest().scenario_name);
      const Duration from =
          root.duration_or("evaluate_from", Duration{}, {Duration{}, Duration::milliseconds(100'000'000)});
      words.duration = root.duration_or("duration", Duration{}, {Duration{}, Duration::milliseconds(100'000'000)});
      words.judged_from = TrueTime{from.ns};
      words.file = attachment.name;
      words.text = attachment.bytes;
      return words;
    } catch (const InputError&) {
      // A damaged attachment counts as absent.
    }
  }
  return words;
}

}  // namespace ttf::report::drive
