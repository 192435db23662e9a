#include "schedules/timing/task_set/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/nearest.h"
#include "schedules/timing/task_set/fields.h"
#include "schedules/timing/task_set/policy_columns.h"
#include "schedules/timing/task_set/task_set.h"

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

// Adds the chains of the lines to a set whose tasks are complete. `task_lines` are the lines of its tasks. Sets
// Task::activator of event-driven tasks: the stage before them, the same in all chains. Mistakes go to
// the findings that the lines have.
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

constexpr std::string_view kTaskColumns[] = {"kind",          "name", "resource", "period",   "offset",
                                             "jitter",        "best", "worst",    "deadline", "priority",
                                             "communication", "slot", "cycles",   "latest tx"};
constexpr std::string_view kChainColumns[] = {"kind", "name", "stages", "largest age"};
const std::vector<std::string_view> kKinds{"processor", "bus", "task", "message", "chain"};

class SetReader {
 public:
  SetReader(std::string_view text, const std::string& name) : name_(name) { sort_lines(text); }

  TaskSet read() {
    set_.name = std::filesystem::path(name_).stem().string();
    findings_.throw_if_any();  // each step needs the one before: one mistake has one sentence
    for (Fields& fields : resources_) resource(fields);
    findings_.throw_if_any();
    for (Fields& fields : tasks_) task(fields);
    if (tasks_.empty()) findings_.add({name_, 0, "", "", "has no task: a line that begins with task or message"});
    findings_.throw_if_any();
    for (std::size_t r = 0; r < set_.resources.size(); ++r) priorities_on(r);
    add_chains(set_, chains_, tasks_, findings_);
    findings_.throw_if_any();
    return std::move(set_);
  }

 private:
  void sort_lines(std::string_view text) {
    CsvLines lines(text);
    for (bool first = true; lines.next(); first = false) {
      const std::string& kind = lines.fields().front();
      if (!lines.broken().empty())
        findings_.add({name_, lines.line(), "line", lines.fields().back(), std::string(lines.broken())});
      else if (kind == "processor" || kind == "bus")
        add(resources_, lines, kind == "bus" ? std::span<const std::string_view>(kBusColumns) : kProcessorColumns,
            kMostTasks);
      else if (kind == "task" || kind == "message")
        add(tasks_, lines, kTaskColumns, kMostTasks);
      else if (kind == "chain")
        add(chains_, lines, kChainColumns, kMostChains);
      else if (!first || kind != "kind")
        findings_.add({name_, lines.line(), "kind", kind,
                       fmt::format("must be one of {}{}", fmt::join(kKinds, ", "),
                                   did_you_mean(kind, {kKinds.begin(), kKinds.end()}))});
    }
  }

  void add(std::vector<Fields>& to, const CsvLines& lines, std::span<const std::string_view> columns,
           std::size_t most) {
    if (to.size() < most)
      to.emplace_back(name_, lines.line(), lines.fields(), columns, findings_);
    else if (to.size() == most)
      throw InputError({name_, lines.line(), "lines", lines.fields().front(), fmt::format("must be at most {}", most)});
  }

  void resource(Fields& fields) {
    Resource one = read_resource(fields);
    if (!resource_places_.emplace(one.name, set_.resources.size()).second)
      fields.fail("name", "must be the only resource of this name");
    set_.resources.push_back(std::move(one));
  }

  // Returns none where the resource is unknown.
  std::optional<std::size_t> resource_of(Fields& fields, bool message) {
    const std::string& name = fields.text("resource");
    const auto found = resource_places_.find(name);
    if (found == resource_places_.end()) {
      std::vector<std::string> names;
      for (const Resource& one : set_.resources)
        if (one.is_bus == message) names.push_back(one.name);
      fields.fail("resource",
                  fmt::format("must be the name of a {}{}", message ? "bus" : "processor", did_you_mean(name, names)));
      return std::nullopt;
    }
    if (set_.resources[found->second].is_bus != message) {
      fields.fail("resource", message ? "must be a bus: it is a processor" : "must be a processor: it is a bus");
      return std::nullopt;
    }
    return found->second;
  }

  void task(Fields& fields) {
    Task one;
    one.name = fields.name();
    if (!task_names_.insert(one.name).second) fields.fail("name", "must be the only task or message of this name");
    one.is_message = fields.text("kind") == "message";
    const std::optional<std::size_t> place = resource_of(fields, one.is_message);
    if (!place) return;  // it says what the other columns mean
    one.resource = *place;
    const Resource& on = set_.resources[*place];
    if (!fields.is_blank("communication"))
      one.communication = static_cast<Communication>(fields.choice("communication", {"implicit", "let", "event"}));
    if (on.policy == Policy::kTable && one.is_event())
      return fields.fail("communication", "must be implicit or let: time activates what is in a table");
    activation(fields, one);
    read_work(fields, on, one);
    one.deadline = fields.duration("deadline", kPeriods);
    if (!one.deadline) one.deadline = one.period;
    if (one.communication == Communication::kLet && one.period && one.deadline > one.period)
      fields.fail("deadline",
                  fmt::format("must be at most the period of {}, where LET writes", duration_words(*one.period)));
    set_.tasks.push_back(std::move(one));
  }

  void activation(Fields& fields, Task& one) {
    one.jitter = fields.duration("jitter", kDelays).value_or(Duration{});
    if (one.is_event()) {
      one.period = fields.duration("period", kPeriods);
      fields.must_be_blank("offset", "events activate it");
      if (!one.period) fields.must_be_blank("jitter", "it is that of the stage before");
      return;
    }
    one.period = fields.needed_duration("period", kPeriods);
    one.offset = fields.duration("offset", kDelays);
  }

  void priorities_on(std::size_t resource) {
    const Resource& on = set_.resources[resource];
    std::map<std::int64_t, std::size_t> seen;
    const std::vector<std::size_t> here = set_.tasks_on(resource);
    if (on.policy == Policy::kDynamic) return dynamic_slots(here);
    const bool given = std::ranges::any_of(here, [&](std::size_t t) { return set_.tasks[t].priority.has_value(); });
    for (const std::size_t t : here) {
      const std::optional<std::int64_t> priority = set_.tasks[t].priority;
      if (!priority) {
        if (given) tasks_[t].fail("priority", fmt::format("must be given for all on {}, or for none", on.name));
        continue;
      }
      const auto [other, fresh] = seen.emplace(*priority, t);
      if (!fresh)
        tasks_[t].fail("priority", fmt::format("must be another one than that of {}", set_.tasks[other->second].name));
    }
    if (on.policy == Policy::kTdma) slots_fit(on, here);
  }

  // Messages of one slot must differ in their cycles: modulo the smaller repetition.
  void dynamic_slots(const std::vector<std::size_t>& here) {
    std::map<std::int64_t, std::vector<std::size_t>> by_slot;
    for (const std::size_t t : here) {
      const Task& task = set_.tasks[t];
      std::vector<std::size_t>& slot = by_slot[*task.priority];
      for (const std::size_t other : slot) {
        const Task& before = set_.tasks[other];
        if ((task.base_cycle - before.base_cycle) % std::min(task.repetition, before.repetition) != 0) continue;
        tasks_[t].fail("priority",
                       fmt::format("must be another one than that of {}, or have other cycles", before.name));
        break;
      }
      slot.push_back(t);
    }
  }

  void slots_fit(const Resource& on, const std::vector<std::size_t>& here) {
    Duration sum{};
    for (const std::size_t t : here) {
      sum += set_.tasks[t].slot;
      if (sum <= on.cycle) continue;
      return tasks_[t].fail("slot", fmt::format("must fit the cycle of {}, which is {}, with the slots before it",
                                                on.name, duration_words(on.cycle)));
    }
  }

  const std::string& name_;
  Findings findings_;
  std::vector<Fields> resources_, tasks_, chains_;
  std::map<std::string, std::size_t> resource_places_;
  std::set<std::string> task_names_;
  TaskSet set_;
};

}  // namespace

TaskSet parse_task_set(std::string_view text, const std::string& name) { return SetReader(text, name).read(); }

TaskSet load_task_set(const std::string& path) { return parse_task_set(read_file(path), path); }

}  // namespace ttf::schedules::timing::task_set
