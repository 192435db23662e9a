#include "cli/supervision/health_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/supervision/lines.h"
#include "core/counted.h"
#include "recording/records/enumerations.h"
#include "report/drawing/tables.h"

namespace ttf::cli::supervision {
namespace {

using Json = nlohmann::json;
using recording::records::CanState;
using recording::records::from_text;
using recording::records::PocKind;

// Reads a message's values and keeps its first error, in words.
class Reader {
 public:
  explicit Reader(const Json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object_.is_object()) complain("", "must be an object");
  }

  void count(const char* key, std::optional<std::uint64_t>& value) {
    const Json* const given = find(key);
    if (given == nullptr) return;
    if (!given->is_number_integer() || (!given->is_number_unsigned() && given->get<std::int64_t>() < 0))
      return complain(key, "must be a whole number from 0");
    value = given->get<std::uint64_t>();
  }
  void number(const char* key, std::optional<double>& value) {
    const Json* const given = find(key);
    if (given == nullptr) return;
    if (!given->is_number() || !(given->get<double>() >= 0)) return complain(key, "must be a number from 0");
    value = given->get<double>();
  }
  void word(const char* key, std::string& value) {
    const Json* const given = find(key);
    if (given == nullptr) return;
    if (!given->is_string()) return complain(key, "must be text");
    value = given->get<std::string>();
  }
  const Json* find(const char* key) const {
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  const std::optional<std::string>& wrong() const { return wrong_; }

 private:
  void complain(std::string_view key, std::string_view expected) {
    if (!wrong_) wrong_ = fmt::format("{}{}{}: {}", where_, key.empty() ? "" : ".", key, expected);
  }

  const Json& object_;
  std::string where_;
  std::optional<std::string> wrong_;
};

std::string count_cell(const std::optional<std::uint64_t>& value) { return value ? fmt::to_string(*value) : "-"; }
std::string us_cell(const std::optional<double>& value, int decimals) {
  return value ? report::drawing::cell(*value, decimals) : "-";
}

constexpr std::string_view kRunning = "running";
constexpr std::size_t kNamed = 3;  // nodes that are not up, in the summary

// "normal active, CAN bus off"; "exit 0, normal active": a process that runs goes without saying.
std::string state_words(const std::string& process, const NodeHealth& health) {
  std::string words = process;
  if (!health.state.empty()) words = (process == kRunning ? "" : process + ", ") + printable(health.state);
  if (!health.is_can_active) words += ", CAN " + printable(health.can_state);
  return words;
}

nlohmann::ordered_json or_null(const auto& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

HealthTable::HealthTable(const std::vector<std::string>& nodes) {
  for (const std::string& name : nodes) rows_.emplace_back().name = name;
}

std::optional<std::string> HealthTable::update(std::size_t node, const Json& health) {
  NodeHealth next = rows_[node].health;
  Reader reader(health, "health");
  reader.count("missed_slots", next.missed_slots);
  reader.count("late_wakeups", next.late_wakeups);
  reader.number("sync_precision_us", next.sync_precision_us);
  reader.count("drops", next.drops);
  reader.word("state", next.state);
  reader.word("can_state", next.can_state);
  next.is_active = next.state.empty() || from_text<PocKind>(next.state) == PocKind::kNormalActive;
  next.is_can_active = next.can_state.empty() || from_text<CanState>(next.can_state) == CanState::kActive;
  if (reader.wrong()) return reader.wrong();
  if (const Json* const given = reader.find("lateness_us")) {
    Reader lateness(*given, "health.lateness_us");
    lateness.number("p50", next.lateness_p50_us);
    lateness.number("p99", next.lateness_p99_us);
    lateness.number("max", next.lateness_max_us);
    if (lateness.wrong()) return lateness.wrong();
  }
  rows_[node].health = std::move(next);
  rows_[node].said.update(health);
  return std::nullopt;
}

void HealthTable::set_process(std::size_t node, std::string state) { rows_[node].process = std::move(state); }

void HealthTable::begin_process(std::size_t node) {
  rows_[node].process = "starting";
  rows_[node].health = {};
  rows_[node].said = Json::object();
  ++rows_[node].processes;
}

void HealthTable::end_process(std::size_t node, std::string how, bool well) {
  rows_[node].process = std::move(how);
  if (well) return;
  NodeHealth& health = rows_[node].health;
  health.state.clear();
  health.can_state.clear();
  health.is_active = health.is_can_active = true;
}

void HealthTable::set_external(std::size_t node, const ExternalHealth& health) {
  rows_[node].process = health.words;
  rows_[node].sending = health.sending;
  rows_[node].health.missed_slots = health.missing;
}

bool HealthTable::Row::up() const { return sending ? *sending : process == kRunning && health.is_active; }

std::uint64_t HealthTable::Row::restarts() const { return processes > 1 ? processes - 1 : 0; }

std::uint64_t HealthTable::restarts() const {
  std::uint64_t sum = 0;
  for (const Row& row : rows_) sum += row.restarts();
  return sum;
}

std::string HealthTable::text() const {
  report::drawing::Table table({"node", "state", "restarts", "missed\nslots", "drops", "late\nwake-ups", "p50\n[us]",
                                "p99\n[us]", "longest\n[us]", "sync\n[us]"});
  for (const Row& row : rows_) {
    const NodeHealth& h = row.health;
    table.add({printable(row.name), state_words(row.process, h), fmt::to_string(row.restarts()),
               count_cell(h.missed_slots), count_cell(h.drops), count_cell(h.late_wakeups),
               us_cell(h.lateness_p50_us, 0), us_cell(h.lateness_p99_us, 0), us_cell(h.lateness_max_us, 0),
               us_cell(h.sync_precision_us, 1)});
  }
  return table.text();
}

std::string HealthTable::up() const {
  std::vector<std::string> others;
  for (const Row& row : rows_)
    if (!row.up()) others.push_back(printable(row.name) + ": " + state_words(row.process, row.health));
  std::string text = fmt::format("{} of {} nodes up", rows_.size() - others.size(), rows_.size());
  if (others.empty()) return text;
  const std::size_t more = others.size() > kNamed ? others.size() - kNamed : 0;
  others.resize(others.size() - more);
  if (more > 0) others.push_back(fmt::format("and {} more", more));
  return text + " (" + joined(others) + ")";
}

std::string HealthTable::summary() const {
  NodeHealth sum;
  const auto add = [](std::optional<std::uint64_t>& to, const std::optional<std::uint64_t>& some) {
    if (some) to = to.value_or(0) + *some;
  };
  const auto raise = [](std::optional<double>& to, const std::optional<double>& some) {
    if (some) to = std::max(to.value_or(0), *some);
  };
  for (const Row& row : rows_) {
    const NodeHealth& h = row.health;
    add(sum.late_wakeups, h.late_wakeups);
    add(sum.missed_slots, h.missed_slots);
    add(sum.drops, h.drops);
    raise(sum.lateness_p99_us, h.lateness_p99_us);
    raise(sum.lateness_max_us, h.lateness_max_us);
  }
  std::string text = up();
  if (sum.lateness_max_us)
    text += fmt::format("; wake-ups late by {} us (p99), {} us (longest)", us_cell(sum.lateness_p99_us, 0),
                        us_cell(sum.lateness_max_us, 0));
  if (sum.late_wakeups || sum.missed_slots || sum.drops)
    text += fmt::format("; {} late wake-ups, {} slots missed, {} drops", sum.late_wakeups.value_or(0),
                        sum.missed_slots.value_or(0), sum.drops.value_or(0));
  if (const std::uint64_t again = restarts(); again > 0) text += "; " + counted(again, "restart");
  return text;
}

nlohmann::ordered_json HealthTable::json() const {
  auto list = nlohmann::ordered_json::array();
  for (const Row& row : rows_) {
    const NodeHealth& h = row.health;
    nlohmann::ordered_json one{{"node", row.name}, {"process", row.process}, {"restarts", row.restarts()}};
    one["state"] = h.state.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(h.state);
    one["missed_slots"] = or_null(h.missed_slots);
    one["late_wakeups"] = or_null(h.late_wakeups);
    one["lateness_us"] = {
        {"p50", or_null(h.lateness_p50_us)}, {"p99", or_null(h.lateness_p99_us)}, {"max", or_null(h.lateness_max_us)}};
    one["sync_precision_us"] = or_null(h.sync_precision_us);
    one["drops"] = or_null(h.drops);
    one["said"] = row.said;
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace ttf::cli::supervision
