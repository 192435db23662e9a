// Mistakes in modes, for schedules/modes/detection_modes.h.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/decimal.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/model/ports.h"
#include "schedules/modes/detection_modes.h"

namespace ttf::schedules::modes {
namespace {

using analysis::ClockBounds;

std::string ms(Duration time) { return scaled_text(time.ns, 1'000'000) + " ms"; }

// The shortest time between the lists of two detections, one directly behind the other. Any two may be, where modes change.
Duration shortest_between_lists(const model::Cluster& cluster, const std::vector<Mode>& modes) {
  std::optional<std::int64_t> rest, begun;  // behind the first one's list, and until the second one's
  for (const Mode& mode : modes)
    for (const PlacedDetection& one : mode.detections) {
      rest = std::min(rest.value_or(INT64_MAX), (one.occupied - one.worst_case).ns);
      begun = std::min(begun.value_or(INT64_MAX), one.best_case.ns);
    }
  if (!rest) return {};
  const std::int64_t apart = *rest + *begun;
  return std::max(Duration{}, Duration{apart - analysis::clock_bounds(cluster).drift_ns(apart)});
}

// Whether a list is in its slots before the next one is written.
bool leaves_in_time(const model::Cluster& cluster, PduId pdu, const std::vector<Mode>& modes, const Grid& grid) {
  const Duration next = shortest_between_lists(cluster, modes);
  const std::vector<analysis::SlotGroup> groups = analysis::slot_groups(cluster, pdu);
  // A list that may wait for later cycles may be torn.
  if (!std::ranges::all_of(groups, &analysis::SlotGroup::bounded)) return false;
  const std::int64_t apart = analysis::clock_bounds(cluster).apart_ns;
  for (const GlobalTime begins : beginnings(cluster, grid))
    for (const Mode& mode : modes)
      for (const PlacedDetection& one : mode.detections) {
        const GlobalTime written = begins + one.worst_case;
        const GlobalTime latest = begins + by_any_clock(cluster, one.worst_case);
        const bool taken = std::ranges::any_of(groups, [&](const analysis::SlotGroup& group) {
          const model::CycleInstant turn{group.base_cycle, group.repetition, group.taken_from};
          const std::int64_t cycle = next_occurrence(cluster.flexray, turn, latest).cycle;
          return time_of(cluster.flexray, cycle, group.taken_by) + Duration{apart} < written + next;
        });
        if (!taken) return false;
      }
  return true;
}

class Soundness {
 public:
  Soundness(const model::Cluster& cluster, const Detector& detector, const std::vector<Mode>& modes, const Grid& grid)
      : cluster_(cluster), detector_(detector), modes_(modes), grid_(grid),
        name_(fmt::format("{}.{}", cluster.node(detector.node).name, detector.task->name)),
        path_(fmt::format("nodes.{}.tasks.{}", cluster.node(detector.node).name, detector.task->name)) {}

  std::vector<Finding> findings() {
    check_task();
    if (!findings_.empty()) return std::move(findings_);
    check_ends();
    for (const model::PortBinding& out : detector_.task->writes) check_list(out);
    return std::move(findings_);
  }

 private:
  void option(const char* key, const std::string& value, const std::string& expected) {
    findings_.push_back({"command line", 0, key, value, expected});
  }
  void about_task(const std::string& expected) {
    if (!detector_.stated) return option("--task", name_, expected);
    findings_.push_back(cluster_.finding(detector_.task->line, path_ + ".modes", name_, expected));
  }

  void check_task() {
    if (cluster_.node(detector_.node).tasks.size() != 1)
      about_task("must be its node's only task: detections follow each other without a gap");
    if (const std::size_t lists = detector_.task->writes.size();
        lists != 1 && lists != camera_ports(*detector_.task).size())
      about_task("must write one list, that of the detections' results, or one for each camera that it reads");
    if (grid_.offset.value >= cluster_.flexray.gMacroPerCycle)
      option("--offset", fmt::format("{}", grid_.offset.value),
             fmt::format("must be 0..{} macroticks", cluster_.flexray.gMacroPerCycle - 1));
  }

  void check_ends() {
    for (const bool secondary : {false, true})
      for (const Mode& mode : modes_) {
        const auto late = std::ranges::find_if(mode.detections, [&](const PlacedDetection& one) {
          return one.detection.secondary == secondary && by_any_clock(cluster_, one.worst_case) > one.occupied;
        });
        if (late == mode.detections.end()) continue;
        ends_late(mode, *late);
        if (!detector_.stated) break;  // an option stands for all modes
      }
  }

  void ends_late(const Mode& mode, const PlacedDetection& late) {
    const std::string spare = ms(by_any_clock(cluster_, late.worst_case) - late.worst_case);
    if (!detector_.stated)
      return option(late.detection.secondary ? "--secondary" : "--primary", ms(late.worst_case),
                    fmt::format("must end {} before its steps of {} do: clocks differ", spare, ms(late.occupied)));
    findings_.push_back(cluster_.finding(
        late.line, fmt::format("{}.modes.{}.detections[{}].lasts", path_, mode.name, &late - mode.detections.data()),
        ms(late.worst_case),
        fmt::format("must end {} before the next detection begins, {} behind this one: clocks differ", spare,
                    ms(late.occupied))));
  }

  void check_list(const model::PortBinding& out) {
    const std::string& list = cluster_.pdu(out.pdu).name;
    if (out.medium.is_flexray()) {
      if (!leaves_in_time(cluster_, out.pdu, modes_, grid_))
        about_task(fmt::format("must have slots of {} between the lists of any two detections", list));
      return;
    }
    const model::CanBus& bus = cluster_.can(out.medium);
    const Duration between = shortest_between_lists(cluster_, modes_);
    for (const model::CanMessage& message : bus.messages)
      if (message.pdu == out.pdu && between < message.shortest_period)
        about_task(
            fmt::format("must write its list every {} at most, the shortest period of {} on {}; those of two "
                        "detections may be {} apart",
                        ms(message.shortest_period), list, bus.name, ms(between)));
  }

  const model::Cluster& cluster_;
  const Detector& detector_;
  const std::vector<Mode>& modes_;
  const Grid& grid_;
  std::string name_, path_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> unsound(const model::Cluster& cluster, const Detector& detector, const std::vector<Mode>& modes,
                             const Grid& grid) {
  return Soundness(cluster, detector, modes, grid).findings();
}

}  // namespace ttf::schedules::modes
