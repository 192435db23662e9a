#include "schedules/timing/task_set/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/nearest.h"
#include "schedules/timing/response/can.h"
#include "schedules/timing/task_set/chain_lines.h"
#include "schedules/timing/task_set/fields.h"

namespace ttf::schedules::timing::task_set {
namespace {

constexpr std::string_view kProcessorColumns[] = {"kind", "name", "policy", "clock"};
constexpr std::string_view kBusColumns[] = {"kind", "name", "policy", "bit rate", "clock"};
constexpr std::string_view kTaskColumns[] = {"kind", "name",  "resource", "period",   "offset",       "jitter",
                                             "best", "worst", "deadline", "priority", "communication"};
constexpr std::string_view kChainColumns[] = {"kind", "name", "stages", "largest age"};
const std::vector<std::string_view> kKinds{"processor", "bus", "task", "message", "chain"};

constexpr Duration kLongestTime = Duration::milliseconds(1'000'000);
constexpr Range<Duration> kPeriods{Duration::microseconds(1), kLongestTime};
constexpr Range<Duration> kDelays{Duration{}, kLongestTime};
constexpr Range<Duration> kWork{Duration{1}, kLongestTime};
constexpr Range<std::int64_t> kBitRates{10'000, 1'000'000};
constexpr std::int64_t kNsPerSecond = 1'000'000'000;

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
    Resource one;
    one.name = fields.name();
    one.is_bus = fields.text("kind") == "bus";
    if (!resource_places_.emplace(one.name, set_.resources.size()).second)
      fields.fail("name", "must be the only resource of this name");
    using enum Policy;
    const std::vector<Policy> policies = one.is_bus ? std::vector{kCan, kCanExtended, kNonPreemptive, kTable}
                                                    : std::vector{kPreemptive, kNonPreemptive, kTable};
    std::vector<std::string_view> words;
    for (const Policy policy : policies) words.emplace_back(word(policy));
    one.policy = policies[fields.choice("policy", words)];
    one.clock = fields.text("clock");
    if (one.is_bus && one.is_can()) {
      if (fields.is_blank("bit rate")) fields.fail("bit rate", "is missing: must be 10000..1000000 bit/s");
      one.bit_rate = fields.integer("bit rate", kBitRates, "bit/s").value_or(kBitRates.low);
    } else if (one.is_bus) {
      fields.must_be_blank("bit rate", "only a CAN has one");
    }
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
    if (on.is_can())
      frame(fields, on, one);
    else
      work(fields, one);
    one.deadline = fields.duration("deadline", kPeriods);
    if (!one.deadline) one.deadline = one.period;
    if (one.communication == Communication::kLet && one.period && one.deadline > one.period)
      fields.fail("deadline",
                  fmt::format("must be at most the period of {}, where LET writes", duration_words(*one.period)));
    one.priority = fields.integer("priority", {0, on.policy == Policy::kCan ? 2047 : 536'870'911});
    if (on.policy == Policy::kTable) in_table(fields);
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

  void work(Fields& fields, Task& one) {
    one.worst = fields.needed_duration("worst", kWork);
    one.best = fields.duration("best", kDelays).value_or(Duration{});
    if (one.best > one.worst && !fields.is_blank("worst"))
      fields.fail("best", fmt::format("must be at most the worst case of {}", duration_words(one.worst)));
  }

  // Stuff bits are at most one in four of the bits from the start of frame to the CRC: the rest of can_frame_bits().
  void frame(Fields& fields, const Resource& can, Task& one) {
    fields.must_be_blank("best", "the payload of a frame is its worst case");
    if (fields.is_blank("worst")) fields.fail("worst", "is missing: must be a payload of 0..8 bytes");
    const auto bytes = static_cast<int>(fields.integer("worst", {0, 8}, "bytes").value_or(0));
    const bool is_short = can.policy == Policy::kCan;
    const auto identifier = is_short ? response::CanIdentifier::k11Bits : response::CanIdentifier::k29Bits;
    const std::int64_t unstuffed = (is_short ? 47 : 67) + 8 * bytes;
    one.best = Duration{unstuffed * kNsPerSecond / can.bit_rate};  // rounded down: no frame is shorter
    one.worst = Duration{response::can_time_ns(response::can_frame_bits(identifier, bytes), can.bit_rate)};
  }

  void in_table(Fields& fields) {
    if (fields.is_blank("offset")) fields.fail("offset", "is missing: a table says when each job begins");
    fields.must_be_blank("jitter", "a job begins at its offset");
    fields.must_be_blank("priority", "a table has none");
  }

  void priorities_on(std::size_t resource) {
    std::map<std::int64_t, std::size_t> seen;
    const std::vector<std::size_t> here = set_.tasks_on(resource);
    const bool given = std::ranges::any_of(here, [&](std::size_t t) { return set_.tasks[t].priority.has_value(); });
    for (const std::size_t t : here) {
      const std::optional<std::int64_t> priority = set_.tasks[t].priority;
      if (!priority) {
        if (given)
          tasks_[t].fail("priority",
                         fmt::format("must be given for all on {}, or for none", set_.resources[resource].name));
        continue;
      }
      const auto [other, fresh] = seen.emplace(*priority, t);
      if (!fresh)
        tasks_[t].fail("priority", fmt::format("must be another one than that of {}", set_.tasks[other->second].name));
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
