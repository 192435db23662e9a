#include "schedules/check/checker.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/int128.h"
#include "schedules/check/constraints.h"
#include "schedules/file/loader.h"
#include "schedules/model/limits.h"

namespace ttf::schedules::check {
namespace {

// FlexRay 2.1A: 10, 5 and 2.5 Mbit/s.
constexpr std::int64_t kBits_ps[] = {100'000, 200'000, 400'000};

}  // namespace

void ClusterFindings::parameter(const std::string& path, const std::string& value, const std::string& expected) {
  const auto line = cluster_.parameter_lines.find(path);
  at(line == cluster_.parameter_lines.end() ? 0 : line->second, path, value, expected);
}

void ClusterFindings::at(int line, const std::string& key, const std::string& value, const std::string& expected) {
  list_.push_back(cluster_.finding(line, key, value, expected));
}

std::string task_path(const model::Node& node, const model::Task& task) {
  return fmt::format("nodes.{}.tasks.{}", node.name, task.name);
}

std::string message_path(const model::CanBus& bus, const model::CanMessage& message) {
  return fmt::format("can.{}.messages[{}]", bus.name, &message - bus.messages.data());
}

std::string frame_path(const model::FrameSlot& frame) {
  return frame.entry ? fmt::format("frames[{}] (slot {})", *frame.entry, frame.slot)
                     : fmt::format("slot {}", frame.slot);
}

std::string place_text(const model::Cluster& cluster, int line) {
  const TextPlace from = cluster.origins.place(cluster.file, line);
  return from.file == cluster.file ? fmt::format("line {}", from.line) : fmt::format("{}:{}", from.file, from.line);
}

std::string ms(Duration duration) { return fmt::format("{} ms", static_cast<double>(duration.ns) / 1e6); }
std::string number(std::int64_t value) { return fmt::format("{}", value); }
std::string us(std::int64_t ps) { return fmt::format("{} us", static_cast<double>(ps) / 1e6); }
std::string ns(std::int64_t ps) { return fmt::format("{} ns", static_cast<double>(ps) / 1e3); }

void check_cycle(const model::Cluster& cluster, ClusterFindings& findings) {
  const model::GlobalParameters& g = cluster.flexray;
  const auto wrong = [&](const char* name, std::int64_t value, const std::string& expected) {
    findings.parameter(fmt::format("flexray.{}", name), fmt::format("{}", value), expected);
  };
  const model::NodeParameters none;
  check_constraints(Constraint::On::kCluster, {cluster, none}, "flexray.", findings);
  if (g.cycle_ps() % 1000 != 0)
    findings.parameter("flexray.gdCycle", us(g.cycle_ps()), "must be a whole number of nanoseconds");
  if (!is_one_of(kBits_ps, g.gdBit_ps))
    findings.parameter("flexray.gdBit", us(g.gdBit_ps), "must be one of 0.1, 0.2, 0.4 us");
  if (cluster.guardian && cluster.topology != model::Topology::kStar)
    findings.parameter("guardian", "true", "needs topology: star; a guardian sits in the middle of a star");
  if (static_cast<Int128>(g.gdBit_ps) * g.baudrate != 1'000'000'000'000)
    wrong("baudrate", g.baudrate, fmt::format("must be 1 / gdBit, with gdBit = {}", us(g.gdBit_ps)));
  if (g.gNumberOfStaticSlots + g.gNumberOfMinislots > model::kLastSlot)
    wrong("gNumberOfMinislots", g.gNumberOfMinislots,
          fmt::format("must be at most {}: frame ids end at {}", model::kLastSlot - g.gNumberOfStaticSlots,
                      model::kLastSlot));
  if (g.gdMinPropagationDelay_ps > g.gdMaxPropagationDelay_ps)
    findings.parameter("flexray.gdMinPropagationDelay", us(g.gdMinPropagationDelay_ps),
                       fmt::format("must be at most gdMaxPropagationDelay = {}", us(g.gdMaxPropagationDelay_ps)));
  if (g.gNumberOfMinislots > 0 && g.gdMinislotActionPointOffset >= g.gdMinislot)
    wrong("gdMinislotActionPointOffset", g.gdMinislotActionPointOffset,
          fmt::format("must be below gdMinislot = {} macroticks", g.gdMinislot));
}

model::Cluster load_checked_cluster(const std::string& path) {
  model::Cluster cluster = file::load_cluster(path);
  if (auto findings = check(cluster); !findings.empty()) throw InputError(std::move(findings));
  return cluster;
}

}  // namespace ttf::schedules::check
