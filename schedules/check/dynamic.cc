// The checker's rules about a dynamic segment in use: all clocks count its minislots alike, frames end within
// it, and delays have bounds where needed.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "schedules/analysis/minislots.h"
#include "schedules/check/checker.h"
#include "schedules/check/constraints.h"

namespace ttf::schedules::check {
namespace {

// Checks that the longest frame of a node ends in the segment if it begins in minislot pLatestTx. Also checks
// that each of its frames can have its turn by that minislot.
void check_sender(const model::Cluster& cluster, NodeId id, ClusterFindings& findings) {
  const model::Node& node = cluster.node(id);
  const model::GlobalParameters& g = cluster.flexray;
  const model::FrameSlot* longest = nullptr;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.sender != id || !is_dynamic(g, frame) || frame.pdu == kNoPdu) continue;
    if (longest == nullptr || analysis::dynamic_words(cluster, frame) > analysis::dynamic_words(cluster, *longest))
      longest = &frame;
    if (analysis::earliest_turn(g, frame) > node.flexray->pLatestTx)
      findings.at(frame.line, frame_path(frame), fmt::format("{}", frame.slot),
                  fmt::format("must be at most {}: its earliest turn is in minislot {}, but {} begins no frame after "
                              "its pLatestTx = {}",
                              g.gNumberOfStaticSlots + node.flexray->pLatestTx, analysis::earliest_turn(g, frame),
                              node.name, node.flexray->pLatestTx));
  }
  if (longest == nullptr) return;
  const int words = analysis::dynamic_words(cluster, *longest);
  const std::string frame = fmt::format("slot {} with {} words takes {} of {} minislots", longest->slot, words,
                                        analysis::minislots_of(g, words), g.gNumberOfMinislots);
  if (analysis::last_start(g, words) < 1)
    findings.at(longest->line, frame_path(*longest), cluster.pdu(longest->pdu).name,
                fmt::format("must fit the dynamic segment: {}", frame));
  else if (node.flexray->pLatestTx > analysis::last_start(g, words))
    findings.parameter(
        fmt::format("nodes.{}.flexray.pLatestTx", node.name), fmt::format("{}", node.flexray->pLatestTx),
        fmt::format("must be at most {}: {} and must end within them", analysis::last_start(g, words), frame));
}

// Returns the reason why the list's arrival needs a bound; empty if it needs no bound.
std::string counted_on(const model::Cluster& cluster, const model::FrameSlot& frame) {
  if (const SensorId sensor = cluster.pdu(frame.pdu).sensor; sensor != kNoSensor)
    return fmt::format("the age of measurements of {} would have no bound", cluster.sensor(sensor).name);
  bool fuses = false;
  for (const model::Node& node : cluster.nodes)
    for (const model::Task& task : node.tasks)
      for (const model::PortBinding& in : task.reads) {
        if (&node == &cluster.node(frame.sender)) fuses |= cluster.pdu(in.pdu).sensor != kNoSensor;
        if (in.pdu == frame.pdu && in.medium.is_flexray() && task.activation.kind == model::ActivationKind::kMessage &&
            task.activation.port == in.port)
          return fmt::format("it activates {}", task_path(node, task));
      }
  return fuses ? fmt::format("{} computes it from measurements, and their age would have no bound",
                             cluster.node(frame.sender).name)
               : "";
}

void check_bounds(const model::Cluster& cluster, const model::FrameSlot& frame, ClusterFindings& findings) {
  if (analysis::always_in_time(cluster, frame)) return;
  const std::string why = counted_on(cluster, frame);
  if (why.empty()) return;
  findings.at(frame.line, frame_path(frame), cluster.pdu(frame.pdu).name,
              fmt::format("must have its turn by minislot {} (pLatestTx of {}) in every cycle, but has it in minislot "
                          "{} if all slots before it are used: {}",
                          cluster.node(frame.sender).flexray->pLatestTx, cluster.node(frame.sender).name,
                          analysis::latest_turn(cluster, frame), why));
}

}  // namespace

void check_dynamic(const model::Cluster& cluster, ClusterFindings& findings) {
  const model::GlobalParameters& g = cluster.flexray;
  std::set<NodeId> senders;
  for (const model::FrameSlot& frame : cluster.frames)
    if (is_dynamic(g, frame) && frame.pdu != kNoPdu && cluster.node(frame.sender).flexray) senders.insert(frame.sender);
  if (senders.empty()) return;
  // A transmission begins and ends in the same minislot on every receiver's clock.
  const model::NodeParameters none;
  check_constraints(Constraint::On::kDynamicSegment, {cluster, none}, "flexray.", findings);
  for (const NodeId sender : senders) check_sender(cluster, sender, findings);
  std::set<PduId> unbounded;  // reported once per list
  for (const model::FrameSlot& frame : cluster.frames) {
    if (!is_dynamic(g, frame) || !senders.contains(frame.sender) || frame.pdu == kNoPdu) continue;
    const std::size_t before = findings.size();
    if (!unbounded.contains(frame.pdu)) check_bounds(cluster, frame, findings);
    if (findings.size() > before) unbounded.insert(frame.pdu);
  }
}

}  // namespace ttf::schedules::check
