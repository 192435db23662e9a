#include "schedules/file/fill_in.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/decimal.h"
#include "core/time.h"
#include "schedules/analysis/can_load.h"
#include "schedules/file/shortest_periods.h"
#include "schedules/left_out/earliest.h"
#include "schedules/model/repetitions.h"

namespace ttf::schedules::file {
namespace {

bool any(const left_out::Instant& at) { return at.instant || at.repetition; }

bool any_instant(const left_out::Parts& parts) {
  return !parts.lists.empty() || std::any_of(parts.sensors.begin(), parts.sensors.end(), any) ||
         std::any_of(parts.tasks.begin(), parts.tasks.end(), [](const auto& tasks) {
           return std::any_of(tasks.begin(), tasks.end(), [](const left_out::TaskParts& task) { return any(task.at); });
         });
}

class Filler {
 public:
  Filler(model::Cluster& cluster, left_out::Parts& parts, Findings& findings)
      : cluster_(cluster), parts_(parts), findings_(findings) {}

  void fill() {
    if (any_instant(parts_)) {
      if (!cans_carry_their_lists()) return;
      for (const left_out::List& list : parts_.lists) absent_of_lists_.push_back(list.at);
      left_out::use_key_slots(cluster_, parts_.lists);
      left_out::put_earliest(cluster_, parts_, findings_);
      check_base_cycles();
      for_absent_periods([](model::CanMessage& message, const std::string&) { message.shortest_period = {}; });
    }
    derive_shortest_periods(cluster_);
    for_absent_periods([&](const model::CanMessage& message, const std::string& key) { say_period(message, key); });
    left_out::set_deadlines(cluster_, parts_.tasks);
    if (findings_.empty()) say_instants();
  }

 private:
  template <class Visit> void for_absent_periods(Visit visit) {
    for (std::size_t c = 0; c < parts_.shortest_periods.size(); ++c) {
      model::CanBus& bus = cluster_.can_buses[c];
      for (std::size_t m = 0; m < bus.messages.size(); ++m)
        if (parts_.shortest_periods[c][m])
          visit(bus.messages[m], fmt::format("can.{}.messages[{}].shortest_period", bus.name, m));
    }
  }

  // Without bounds of the CANs nothing follows. The sentences are those of the check (schedules/check/slots.cc).
  bool cans_carry_their_lists() {
    bool all = true;
    for (const model::CanBus& bus : cluster_.can_buses)
      for (const model::CanMessage& message : bus.messages) {
        const int bytes = cluster_.pdu(message.pdu).fragment_bytes;
        if (analysis::can_data_length(bus.flexible_data_rate, bytes)) continue;
        all = false;
        findings_.add(cluster_.finding(
            message.line, fmt::format("can.{}.messages ({})", bus.name, cluster_.pdu(message.pdu).name),
            fmt::format("{} bytes", bytes),
            fmt::format("must fit a frame of this CAN, at most {} bytes", bus.flexible_data_rate ? 64 : 8)));
      }
    return all;
  }

  void say(std::string path, std::string value) { cluster_.derived.push_back({std::move(path), std::move(value)}); }

  void say_period(const model::CanMessage& message, const std::string& key) {
    if (message.shortest_period == Duration{})
      findings_.add(
          cluster_.finding(message.line, key, "",
                           "must be in the file: the tasks of its sender do not bound the time between two lists"));
    else
      say(key, duration_text(message.shortest_period));
  }

  // A base cycle that the file says, below a repetition that it leaves out.
  void check_base_cycle(const left_out::Instant& absent, int base_cycle, int repetition, int line,
                        const std::string& path) {
    if (!absent.instant && absent.repetition && base_cycle >= repetition)
      findings_.add(cluster_.finding(line, path + ".base_cycle", fmt::format("{}", base_cycle),
                                     fmt::format("must be below repetition, which follows: 0..{}", repetition - 1)));
  }
  void check_base_cycles() {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) {
        const model::CycleInstant& at = cluster_.nodes[n].tasks[t].activation.at;
        check_base_cycle(parts_.tasks[n][t].at, at.base_cycle, at.repetition, parts_.tasks[n][t].line,
                         activation_path(n, t));
      }
    for (const left_out::List& list : parts_.lists)
      check_base_cycle(list.at, list.base_cycle, list.repetition, list.line, path_of(cluster_, list));
  }

  std::string task_path(std::size_t node, std::size_t task) const {
    return fmt::format("nodes.{}.tasks.{}", cluster_.nodes[node].name, cluster_.nodes[node].tasks[task].name);
  }
  std::string activation_path(std::size_t node, std::size_t task) const {
    return task_path(node, task) + ".activation";
  }

  void say_instant(const left_out::Instant& absent, const std::string& path, int base_cycle, int repetition,
                   const char* within, std::int64_t value) {
    if (absent.instant) say(path + ".base_cycle", fmt::format("{}", base_cycle));
    if (absent.repetition) say(path + ".repetition", fmt::format("{}", repetition));
    if (absent.instant) say(fmt::format("{}.{}", path, within), fmt::format("{}", value));
  }

  // In the order of a file.
  void say_instants() {
    for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
      const model::CycleInstant& at = cluster_.sensors[s].at;
      say_instant(parts_.sensors[s], "sensors." + cluster_.sensors[s].name, at.base_cycle, at.repetition, "offset",
                  at.offset.value);
    }
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) {
        const model::Task& task = cluster_.nodes[n].tasks[t];
        const model::CycleInstant& at = task.activation.at;
        say_instant(parts_.tasks[n][t].at, activation_path(n, t), at.base_cycle, at.repetition, "offset",
                    at.offset.value);
        if (parts_.tasks[n][t].deadline) say(task_path(n, t) + ".deadline", duration_text(task.deadline));
      }
    for (std::size_t l = 0; l < parts_.lists.size(); ++l) {
      const left_out::List& list = parts_.lists[l];
      say_instant(absent_of_lists_[l], path_of(cluster_, list), list.base_cycle, list.repetition, "slot", list.slot);
    }
  }

  model::Cluster& cluster_;
  left_out::Parts& parts_;
  Findings& findings_;
  std::vector<left_out::Instant> absent_of_lists_;  // a list in a key slot leaves nothing out any more
};

}  // namespace

void fill_in(model::Cluster& cluster, left_out::Parts& parts, Findings& findings) {
  Filler(cluster, parts, findings).fill();
}

}  // namespace ttf::schedules::file
