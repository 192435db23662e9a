#include "evaluation/faults/frame_clocks.h"

#include <algorithm>

namespace ttf::evaluation::faults {

FrameClocks::FrameClocks(const schedules::model::Cluster& cluster)
    : cycle_(cluster.cycle()), clocks_(cluster.nodes.size()) {}

void FrameClocks::forget(NodeId node) { clocks_[index_of(node)] = {}; }

std::optional<Duration> FrameClocks::sent(const recording::records::SlotFrameSent& frame) {
  if (index_of(frame.stamp.node) >= clocks_.size()) return std::nullopt;
  Clock& clock = clocks_[index_of(frame.stamp.node)];
  Reading& first = clock.first;
  if (frame.cycle % 2 == 0) {
    if (!first.known || first.cycle != frame.cycle)
      first = {true, frame.cycle, frame.stamp.true_time, frame.stamp.global};
    return std::nullopt;
  }
  if (!first.known || first.cycle + 1 != frame.cycle) return std::nullopt;
  first.known = false;  // once per double cycle
  const Duration shown = frame.stamp.global - first.shown;
  if (shown.ns <= 0) return std::nullopt;
  const double rate = static_cast<double>((frame.stamp.true_time - first.at).ns) / static_cast<double>(shown.ns);
  const std::int64_t in_cycle = (frame.stamp.global - GlobalTime{}).ns % cycle_.ns;
  const auto left = static_cast<double>(cycle_.ns - in_cycle);
  const TrueTime end = frame.stamp.true_time + Duration{static_cast<std::int64_t>(left * rate)};
  clock.end = end;
  Duration most{};
  for (const Clock& other : clocks_) {
    if (!other.end) continue;
    const Duration apart{std::max((end - *other.end).ns, (*other.end - end).ns)};
    if (apart < cycle_) most = std::max(most, apart);  // else of another double cycle
  }
  return most;
}

}  // namespace ttf::evaluation::faults
