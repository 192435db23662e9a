#include "recording/exports/measurement_flows.h"

#include <algorithm>

namespace ttf::recording::exports {

bool MeasurementFlows::Carried::takes(std::uint8_t on_channel, std::uint8_t fragment) {
  if (!channel) channel = on_channel;
  if (*channel != on_channel || fragments[fragment]) return false;
  fragments.set(fragment);
  return true;
}

void MeasurementFlows::measured(const MeasurementId& id, const TraceMark& mark) {
  // A sensor that has started anew counts anew.
  if (const auto old = ways_.find(id); old != ways_.end()) end(old);
  Way& way = ways_[id];
  way.flow = ++flow_ids_;
  way.measured = mark.at;
  way.marks = {mark};
  begun_.emplace_back(mark.at, id);
}

void MeasurementFlows::frame(bool flexray, std::uint8_t channel, NodeId sender, SensorId sensor, std::uint32_t sequence,
                             std::uint8_t fragment, const TraceMark& mark) {
  if (sensor != kNoSensor) {
    const auto way = ways_.find({sensor, sequence});
    if (way != ways_.end() && (!flexray || way->second.on_flexray.takes(channel, fragment)))
      way->second.marks.push_back(mark);
    return;
  }
  // In its turn: which image it is of may not be known before.
  if (flexray) acts_.push_back({Deed::kSent, mark.at, sender, {}, sequence, mark, channel, fragment});
}

void MeasurementFlows::run(NodeId node, TrueTime start, TrueTime end, const TraceMark& mark) {
  runs_[node].push_back({start, end, mark});
}

void MeasurementFlows::lost(const MeasurementId& id, const TraceMark& mark) {
  if (const auto way = ways_.find(id); way != ways_.end() && !way->second.lost) way->second.lost = mark;
}

void MeasurementFlows::act(Act act) { acts_.push_back(std::move(act)); }

// What is written is of the run that ends then, all else of the one that starts then, or, where tasks are told of less
// exactly, of the last that had started.
std::optional<TraceMark> MeasurementFlows::run_of(const Act& act) const {
  const auto of_node = runs_.find(act.node);
  if (of_node == runs_.end()) return std::nullopt;
  const Run* best = nullptr;
  for (const Run& run : of_node->second) {
    if (run.start > act.at + kTolerance || run.end + kTolerance < act.at) continue;
    const bool ends = act.deed == Deed::kWritten && run.end <= act.at + kTolerance;
    if (ends) return run.mark;
    if (best == nullptr || run.start > best->start) best = &run;
  }
  return best != nullptr ? std::optional(best->mark) : std::nullopt;
}

std::optional<TraceMark> MeasurementFlows::perform(const Act& act) {
  const std::optional<TraceMark> run = act.deed == Deed::kSent ? std::nullopt : run_of(act);
  const auto pass = [&](const MeasurementId& id) {
    const auto way = ways_.find(id);
    if (way == ways_.end()) return way;
    if (run && run->at >= way->second.measured) way->second.marks.push_back(*run);
    return way;
  };
  switch (act.deed) {
    case Deed::kRead:
    case Deed::kWritten:
    case Deed::kHeld:
      for (const MeasurementId& id : act.ids) pass(id);
      break;
    case Deed::kFused:
      for (const MeasurementId& id : act.ids)
        if (const auto way = pass(id); way != ways_.end()) way->second.fused = true;
      break;
    case Deed::kImage: {
      Image image{act.at, act.node, act.image, {}, {}};
      for (const MeasurementId& id : act.ids) {
        const auto way = ways_.find(id);
        if (way == ways_.end() || !way->second.fused || way->second.in_image) continue;
        way->second.in_image = true;
        pass(id);
        image.ids.push_back(id);
      }
      images_.push_back(std::move(image));
      break;
    }
    case Deed::kUsed: {
      const auto image =
          std::find_if(images_.rbegin(), images_.rend(), [&](const Image& one) { return one.sequence == act.image; });
      if (image == images_.rend()) break;
      for (const MeasurementId& id : image->ids)
        if (const auto way = pass(id); way != ways_.end()) end(way);
      image->ids.clear();
      break;
    }
    case Deed::kSent: {
      const auto image = std::find_if(images_.rbegin(), images_.rend(), [&](const Image& one) {
        return one.node == act.node && one.sequence == act.image;
      });
      if (image == images_.rend() || !image->on_flexray.takes(act.channel, act.fragment)) break;
      for (const MeasurementId& id : image->ids)
        if (const auto way = ways_.find(id); way != ways_.end()) way->second.marks.push_back(act.frame);
      break;
    }
  }
  return run;
}

void MeasurementFlows::end(Ways::iterator way) {
  std::vector<TraceMark>& marks = way->second.marks;
  if (!way->second.fused && way->second.lost) marks.push_back(*way->second.lost);
  std::sort(marks.begin(), marks.end());
  marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
  if (marks.size() > 1)  // else there is nothing to join
    for (const TraceMark& mark : marks) flows_[mark.serial].push_back({way->second.flow, mark == marks.back()});
  ways_.erase(way);
}

void MeasurementFlows::forget(TrueTime now) {
  while (!begun_.empty() && begun_.front().first + kLongestWay < now) {
    const auto way = ways_.find(begun_.front().second);
    if (way != ways_.end() && way->second.measured == begun_.front().first) end(way);
    begun_.pop_front();
  }
  while (!images_.empty() && images_.front().at + kLongestWay < now) images_.pop_front();
  for (auto& [node, runs] : runs_)
    while (!runs.empty() && runs.front().start + kLongestWay < now) runs.pop_front();
}

void MeasurementFlows::finish() {
  while (!ways_.empty()) end(ways_.begin());
}

std::vector<TraceFlow> MeasurementFlows::take(const TraceMark& mark) {
  const auto found = flows_.find(mark.serial);
  if (found == flows_.end()) return {};
  std::vector<TraceFlow> flows = std::move(found->second);
  flows_.erase(found);
  return flows;
}

}  // namespace ttf::recording::exports
