#include "schedules/timing/task_set/chain_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/nearest.h"

namespace ttf::schedules::timing::task_set {
namespace {

constexpr Range<Duration> kAges{Duration::microseconds(1), Duration::milliseconds(1'000'000)};

std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = std::min(text.find('>'), text.size());
    std::string_view part = text.substr(0, end);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
    parts.emplace_back(part);
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

class ChainReader {
 public:
  explicit ChainReader(const TaskSet& set) {
    for (const Task& task : set.tasks) names_.push_back(task.name);
  }

  std::vector<std::size_t> stages(Fields& fields) const {
    std::vector<std::size_t> found;
    if (fields.is_blank("stages")) {
      fields.fail("stages", "is missing: must be names of tasks and messages, as in a > b > c");
      return found;
    }
    for (const std::string& part : parts_of(fields.text("stages"))) {
      const auto at = std::ranges::find(names_, part);
      const auto stage = static_cast<std::size_t>(at - names_.begin());
      if (at == names_.end())
        fields.fail("stages", fmt::format("must be names of tasks and messages, as in a > b > c: {} is none{}",
                                          part.empty() ? "an empty one" : part, did_you_mean(part, names_)));
      else if (std::ranges::find(found, stage) != found.end())
        fields.fail("stages", fmt::format("must have each stage once: {} is there twice", part));
      else
        found.push_back(stage);
    }
    return found;
  }

 private:
  std::vector<std::string> names_;
};

// Returns whether following the activators from a task leads back to it.
bool activates_itself(const TaskSet& set, std::size_t task) {
  std::optional<std::size_t> at = set.tasks[task].activator;
  for (std::size_t steps = 0; at && steps <= set.tasks.size(); ++steps) {
    if (*at == task) return true;
    at = set.tasks[*at].activator;
  }
  return false;
}

void set_activators(TaskSet& set, std::vector<Fields>& chain_lines) {
  for (std::size_t c = 0; c < set.chains.size(); ++c) {
    const std::vector<std::size_t>& stages = set.chains[c].stages;
    for (std::size_t s = 1; s < stages.size(); ++s) {
      Task& task = set.tasks[stages[s]];
      if (!task.is_event()) continue;
      if (task.activator && *task.activator != stages[s - 1])
        chain_lines[c].fail("stages",
                            fmt::format("must have {} before {}, as another chain has it: one stage activates it",
                                        set.tasks[*task.activator].name, task.name));
      else
        task.activator = stages[s - 1];
    }
  }
}

}  // namespace

void add_chains(TaskSet& set, std::vector<Fields>& chain_lines, std::vector<Fields>& task_lines, Findings& findings) {
  const ChainReader reader(set);
  std::set<std::string> names;
  for (Fields& fields : chain_lines) {
    Chain chain;
    chain.name = fields.name();
    if (!names.insert(chain.name).second) fields.fail("name", "must be the only chain of this name");
    chain.stages = reader.stages(fields);
    chain.largest_age = fields.duration("largest age", kAges);
    set.chains.push_back(std::move(chain));
  }
  if (!findings.empty()) return;  // a task may seem to have no stage before it
  set_activators(set, chain_lines);
  if (!findings.empty()) return;
  for (std::size_t t = 0; t < set.tasks.size(); ++t) {
    const Task& task = set.tasks[t];
    if (!task.is_event()) continue;
    if (!task.activator && !task.period)
      task_lines[t].fail("period", "is missing: no chain has a stage before it, so events from outside activate it");
    if (task.activator && task.period)
      task_lines[t].must_be_blank("period", fmt::format("{} activates it", set.tasks[*task.activator].name));
    if (activates_itself(set, t))
      task_lines[t].fail("communication", "must not let the task activate itself over chains");
  }
}

}  // namespace ttf::schedules::timing::task_set
