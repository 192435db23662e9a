// The shipped plans, and changes to them.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "core/errors.h"
#include "schedules/synthesis/plan/loader.h"
#include "tests/support/patterns.h"
#include "tests/support/refusals.h"

namespace ttf::schedules::synthesis {

inline std::string plan_path(const std::string& name) { return TTF_SOURCE_DIR "/schedules/plans/" + name + ".yaml"; }

inline std::string plan_text(const std::string& name) {
  std::ifstream stream(plan_path(name), std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Returns the plan's text with the first match of a pattern replaced.
inline std::string changed(const std::string& text, const std::string& pattern, const std::string& replacement) {
  const std::string made = support::replaced_first(text, pattern, replacement);
  EXPECT_NE(made, text) << pattern << " does not occur";
  return made;
}

// Returns a shipped cluster's text without the instants of tasks and sensors, and without the lists' slots.
inline std::string without_instants(std::string text) {
  const std::pair<const char*, const char*> left_out[] = {
      {"(kind: time), base_cycle: \\d+, (repetition: \\d+), offset: \\d+", "$1, $2"},
      {"(measurement: scheduled,)\\s+base_cycle: \\d+, (repetition: \\d+), offset: \\d+", "$1 $2"},
      {"slot: \\d+, ((?:channels: \\w+, )?sender: \\w+), base_cycle: \\d+, (repetition: \\d+, pdu: \\w+)(?:, "
       "fragments: \\d+)?",
       "$1, $2"}};
  for (const auto& [pattern, replacement] : left_out) text = support::replaced(text, pattern, replacement);
  return text;
}

// Returns the findings of a plan's loader.
inline std::vector<Finding> plan_findings(const std::string& text) {
  return support::findings_of([&] { (void)plan::parse_plan(text, "plan.yaml"); });
}

}  // namespace ttf::schedules::synthesis
