// A plan with one value changed, dropped, doubled or absurd: hundreds of plans. Each is solved, explained, or refused in a
// sentence that names its place.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "schedules/check/checker.h"
#include "schedules/file/inherit.h"
#include "schedules/synthesis/explanation/explain.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "tests/fuzz/edits.h"
#include "tests/schedules/synthesis/plans.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::synthesis::explanation {
namespace {

// Returns the text's keys, and how often it has each.
std::map<std::string, int> keys_of(const std::string& text) {
  std::map<std::string, int> keys;
  for (const support::Match& key : support::matches(text, "([A-Za-z_]\\w*):")) ++keys[key[1]];
  return keys;
}

enum class Fate : std::uint8_t { kSolved, kExplained, kRefused, kUnknown };

Fate fate_of(const std::string& text) {
  try {
    plan::Plan plan = plan::parse_plan(text, "plan.yaml");
    const instants::Synthesis made = instants::synthesize(plan);
    if (made.found) {
      EXPECT_TRUE(check::check(made.cluster).empty());
      return Fate::kSolved;
    }
    if (!made.refused.empty()) return Fate::kRefused;
    return explain(plan).core.empty() ? Fate::kUnknown : Fate::kExplained;
  } catch (const InputError& error) {
    for (const Finding& one : error.findings()) {
      EXPECT_EQ(one.file, "plan.yaml");
      EXPECT_GT(one.line, 0) << one.sentence();
      EXPECT_EQ(one.sentence().find('\n'), std::string::npos);
    }
    return Fate::kRefused;
  }
}

TEST(Explain, APlanWithOneValueChangedIsSolvedExplainedOrRefused) {
  std::string text = file::inherited(plan_path("paper_laser")).text;
  text = changed(text, "shortest: 8.5 ms", "shortest: 8.9 ms");
  text = changed(text, "step: 5 us", "step: 100 us");
  const fuzz::Shipped plan{"plan", text};
  const std::vector<std::string> values{"0", "-1", "1e300", "nothing", "1 ns", "3600 s", "[1, 2]", "7"};
  std::map<Fate, int> fates;
  const auto note = [&](const std::string& edit, const std::string& made) {
    SCOPED_TRACE(edit);
    const Fate fate = fate_of(made);
    EXPECT_NE(fate, Fate::kUnknown);
    ++fates[fate];
  };
  std::size_t next = 0;
  for (const auto& [key, times] : keys_of(text))
    for (const int occurrence : {0, times / 2}) {
      std::string at = " " + key + " " + std::to_string(occurrence);
      std::vector<std::string> edits{"-" + at, "+" + at};
      for (int value = 0; value < 2; ++value) edits.push_back(at.substr(1) + " " + values[next++ % values.size()]);
      for (const std::string& edit : edits) note(edit, fuzz::edited({&plan, 1}, "plan\n" + edit + "\n"));
      if (times == 1) break;
    }
  // Times that are possible, but others.
  for (const support::Match& time : support::matches(text, "(\\d+) ms"))
    for (const double factor : {0.5, 0.9, 1.1, 2.0}) {
      const std::string other = fmt::format("{} us", std::lround(std::stod(time[1]) * factor * 1'000));
      note(fmt::format("{} at {}", other, time.at), std::string(text).replace(time.at, time.size, other));
    }
  EXPECT_GT(fates[Fate::kSolved], 100);
  EXPECT_GE(fates[Fate::kExplained], 3);
  EXPECT_GT(fates[Fate::kRefused], 200);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::explanation
