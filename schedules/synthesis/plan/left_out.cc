#include "schedules/synthesis/plan/left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/decimal.h"
#include "schedules/file/likeness/inherit_alike.h"
#include "schedules/model/limits.h"
#include "schedules/model/repetitions.h"

namespace ttf::schedules::synthesis::plan {
namespace {

using Path = std::vector<std::string>;

// Placeholders; each is within the range of its key.
constexpr const char* kNone = "0";
constexpr const char* kOnce = "1";

class Filler {
 public:
  Filler(StrictYaml& file, Duration longest_cycle, const std::optional<PayloadLengths>& payload, Findings& findings)
      : file_(file), root_(file.root(none_)), longest_cycle_(longest_cycle), payload_(payload), findings_(findings) {}

  LeftOutValues fill() {
    flexray();
    nodes();
    sensors();
    pdus();
    frames();
    cans();
    // All is asked before anything is put: aliases share their mapping.
    for (const auto& [path, value] : values_) file_.put(path, value);
    return std::move(found_);
  }

 private:
  // Puts the placeholder down for a key that is left out. Returns whether it is.
  bool leave(const YamlMap& map, const Path& path, const char* key, const std::string& value) {
    if (map.has(key)) return false;
    Path whole = path;
    whole.emplace_back(key);
    values_.emplace_back(std::move(whole), value);
    return true;
  }

  // Both keys of an instant are said, or none.
  bool leave_instant(YamlMap& map, const Path& path, const char* place, const char* value) {
    const bool base = leave(map, path, "base_cycle", kNone), at = leave(map, path, place, value);
    if (base != at)
      findings_.add({map.file(), map.line(), fmt::format("{}.{}", map.path(), base ? "base_cycle" : place), "",
                     fmt::format("is missing: a plan leaves out both base_cycle and {}, or none of them", place)});
    return base && at;
  }

  void flexray() {
    YamlMap map = root_.map("flexray");
    const Path path{"flexray"};
    take_round(map);
    const std::string cycle_us = scaled_text(longest_cycle_.ns, 1'000);
    found_.cycle = leave(map, path, "gdCycle", cycle_us);
    // Without gdMacrotick there is nothing to count by: the loader says what is missing.
    if (map.has("gdMacrotick")) {
      const std::int64_t cycle_ps = found_.cycle ? longest_cycle_.ns * 1'000
                                                 : map.scaled("gdCycle", 1'000'000, {10'000'000, 16'000'000'000}, "us");
      const std::int64_t macrotick_ps = map.scaled("gdMacrotick", 1'000'000, {1'000'000, 6'000'000}, "us");
      leave(map, path, "gMacroPerCycle", fmt::format("{}", cycle_ps / macrotick_ps));
    }
    if (payload_) {
      leave(map, path, "gPayloadLengthStatic", fmt::format("{}", payload_->longest / 2));
      found_.parameters.slot_length = !map.has("gdStaticSlot");  // the loader derives it
    }
    found_.parameters.static_slots = leave(map, path, "gNumberOfStaticSlots", "1023");
    found_.parameters.idle_time = leave(map, path, "gdNIT", "2");
    found_.parameters.correction_start = leave(map, path, "gOffsetCorrectionStart", "9");
  }

  // A base cycle that is said is below the placeholder of the repetition.
  void take_round(YamlMap& flexray) {
    model::GlobalParameters g;
    const auto count = flexray.integer_if("gCycleCountMax", {7, 63});
    if (count && *count % 2 != 0) g.gCycleCountMax = static_cast<int>(*count);
    longest_ = fmt::format("{}", model::repetitions(g).back());
    longest_of_frames_ = fmt::format("{}", model::frame_repetitions(g).back());
  }

  void nodes() {
    const YamlMap shared = root_.map("node_parameters");
    for (auto& [name, map] : root_.named_maps("nodes")) {
      LeftOutParameters::Controller left;
      if (const auto own = map.map_if("flexray")) {
        const Path path{"nodes", name, "flexray"};
        const auto leave_own = [&, &own = *own](const char* key, const char* value) {
          return !shared.has(key) && leave(own, path, key, value);
        };
        left = {leave_own("pMicroPerCycle", "640"), leave_own("pRateCorrectionOut", "2"),
                leave_own("pdListenTimeout", "1284")};
      }
      found_.parameters.controllers.push_back(left);
      tasks(map, name);
    }
  }

  void tasks(YamlMap& node, const std::string& name) {
    std::vector<PlannedTask>& tasks = found_.tasks.emplace_back();
    for (auto& [task_name, task] : node.named_maps("tasks")) {
      PlannedTask& planned = tasks.emplace_back();
      Path path{"nodes", name, "tasks", task_name};
      planned.deadline = leave(task, path, "deadline", "10 s");
      YamlMap activation = task.map("activation");
      planned.line = activation.line();
      if (!activation.choice<bool>(
              "kind", {{"time", true}, {"message", false}, {"sensor", false}, {"completion", false}, {"modes", false}}))
        continue;
      path.emplace_back("activation");
      planned.at.instant = leave_instant(activation, path, "offset", kNone);
      planned.at.repetition = leave(activation, path, "repetition", planned.at.instant ? kOnce : longest_);
    }
  }

  void sensors() {
    auto sensors = root_.named_maps("sensors");
    const auto is_other = [&](const std::string& like, const std::string& name) {  // any other value is a finding below
      return like != name && std::ranges::any_of(sensors, [&](const auto& entry) { return entry.first == like; });
    };
    for (auto& [name, map] : sensors)
      if (const std::string like = map.has("like") ? map.value_text("like") : "";
          is_other(like, name) && map.lacks("device") && map.lacks("host"))
        findings_.add({map.file(), map.line("like"), map.path() + ".like", like,
                       "needs device and host beside it: plan.sensors has the sensors whose nodes are copies"});
    (void)file::likeness::inherit_alike(sensors, "sensor");
    for (auto& [name, map] : sensors) {
      LeftOut& left = found_.sensors.emplace_back();
      if (!map.choice<bool>("measurement", {{"free", false}, {"scheduled", true}, {"completion", false}})) continue;
      left.instant = leave_instant(map, {"sensors", name}, "offset", kNone);
      left.repetition = leave(map, {"sensors", name}, "repetition", left.instant ? kOnce : longest_);
    }
  }

  void pdus() {
    auto pdus = root_.named_maps("pdus");
    (void)file::likeness::inherit_alike(pdus, "PDU");
    for (auto& [name, map] : pdus) {
      const Path path{"pdus", name};
      const bool bytes = payload_ && leave(map, path, "fragment_bytes", fmt::format("{}", payload_->longest));
      const bool elements = payload_ && !map.has("elements_per_fragment");
      if (elements) {
        const auto room =
            bytes ? payload_->longest : map.integer("fragment_bytes", {1, model::kMostFragmentBytes}, "bytes");
        leave(map, path, "elements_per_fragment", fmt::format("{}", most_elements(map, static_cast<int>(room))));
      }
      found_.layouts.push_back(bytes && elements);
      if (bytes != elements)
        findings_.add({map.file(), map.line(),
                       fmt::format("{}.{}", map.path(), bytes ? "fragment_bytes" : "elements_per_fragment"), "",
                       "is missing: a plan leaves out both fragment_bytes and elements_per_fragment, or none of them"});
    }
  }

  // So many elements fit behind the header.
  static int most_elements(YamlMap& pdu, int bytes) {
    const auto bits = [&](const char* key) {
      int sum = 0;
      for (YamlMap& signal : pdu.maps(key))
        sum += static_cast<int>(signal.integer("bits", {1, model::kMostSignalBits}));
      return sum;
    };
    return model::most_elements(bytes, (bits("header") + 7) / 8 * 8, bits("element"));
  }

  void frames() {
    const auto entries = root_.maps("frames");
    for (std::size_t i = 0; i < entries.size(); ++i) frame(entries[i], {"frames", fmt::format("{}", i)});
  }

  void frame(YamlMap map, const Path& path) {
    LeftOutValues::Frame& left = found_.frames.emplace_back();
    left.is_list = map.has("pdu");
    if (!left.is_list) return;  // its values follow (schedules/file/load_frames.h)
    left.slot = left.base_cycle = leave_instant(map, path, "slot", kOnce);
    left.repetition = leave(map, path, "repetition", left.slot ? kOnce : longest_of_frames_);
    if (left.slot || left.repetition) leave(map, path, "fragments", kOnce);
    for (const char* key : {"first_fragment", "fragment_step", "network_management", "message_id"})
      if (map.has(key) && (left.slot || left.repetition))
        findings_.add({map.file(), map.line(key), fmt::format("{}.{}", map.path(), key), "",
                       "needs a slot, base_cycle and repetition: a plan chooses slots for whole lists alone"});
  }

  void cans() {
    for (auto& [name, map] : root_.named_maps("can")) {
      std::vector<bool>& periods = found_.shortest_periods.emplace_back();
      const auto messages = map.maps("messages");
      for (std::size_t i = 0; i < messages.size(); ++i)
        periods.push_back(
            leave(messages[i], {"can", name, "messages", fmt::format("{}", i)}, "shortest_period", "10 s"));
    }
  }

  StrictYaml& file_;
  Findings none_;  // the loader of cluster files reports them
  YamlMap root_;
  Duration longest_cycle_;
  const std::optional<PayloadLengths>& payload_;
  Findings& findings_;
  std::vector<std::pair<Path, std::string>> values_;
  std::string longest_ = "64", longest_of_frames_ = "64";  // repetitions
  LeftOutValues found_;
};

}  // namespace

LeftOutValues fill_in(StrictYaml& file, Duration longest_cycle, const std::optional<PayloadLengths>& payload,
                      Findings& findings) {
  return Filler(file, longest_cycle, payload, findings).fill();
}

}  // namespace ttf::schedules::synthesis::plan
