#include "recording/exports/measurement_ways.h"

#include <algorithm>

namespace ttf::recording::exports {

bool MeasurementWays::Carried::takes(std::uint8_t on_channel, std::uint8_t fragment) {
  if (!channel) channel = on_channel;
  if (*channel != on_channel || fragments[fragment]) return false;
  fragments.set(fragment);
  return true;
}

void MeasurementWays::measured(const MeasurementId& id, NodeId node, const WayMark& mark) {
  // A restarted sensor counts anew.
  if (const auto old = ways_.find(id); old != ways_.end()) end(old);
  Way& way = ways_[id].way;
  way.id = id;
  way.number = ++numbers_;
  way.measured = mark.at;
  way.stops = {{Deed::kMeasured, mark.at, node, mark}};
  begun_.emplace_back(mark.at, id);
}

void MeasurementWays::frame(bool flexray, std::uint8_t channel, NodeId sender, SensorId sensor, std::uint32_t sequence,
                            std::uint8_t fragment, const WayMark& mark) {
  if (sensor != kNoSensor) {
    const auto followed = ways_.find({sensor, sequence});
    if (followed != ways_.end() && (!flexray || followed->second.on_flexray.takes(channel, fragment)))
      followed->second.way.stops.push_back({Deed::kFrame, mark.at, sender, mark});
    return;
  }
  // Put off until its time comes: its image may not be known before.
  if (flexray) acts_.push_back({Deed::kImageFrame, mark.at, sender, {}, sequence, mark, channel, fragment});
}

void MeasurementWays::executed(NodeId node, TrueTime start, TrueTime end, const WayMark& mark) {
  executions_[node].push_back({start, end, mark});
}

void MeasurementWays::act(Act act) {
  if (act.deed == Deed::kImage) fuses_.insert(act.node);
  if (act.deed == Deed::kUsed) act.writer = writer_of(act.node, act.image);
  acts_.push_back(std::move(act));
}

// Returns the fusing node that wrote the list with this number that the user read last; kNoNode if unknown. A list
// of another node may have the same number: it is no image, or an image that a gateway passes on.
NodeId MeasurementWays::writer_of(NodeId user, std::uint32_t image) const {
  const auto lists = read_.find(user);
  if (lists == read_.end()) return kNoNode;
  for (const auto& [pdu, sequence] : lists->second) {
    if (sequence != image) continue;
    const auto writer = writers_.find(pdu);
    if (writer != writers_.end() && fuses_.contains(writer->second)) return writer->second;
  }
  return kNoNode;
}

// A kWritten belongs to the execution that ends then, any other act to the one that starts then. If stamps are
// less exact, it belongs to the last execution that had started.
std::optional<WayMark> MeasurementWays::execution_of(const Act& act) const {
  if (act.deed == Deed::kImageFrame || act.deed == Deed::kLost) return std::nullopt;
  const auto of_node = executions_.find(act.node);
  if (of_node == executions_.end()) return std::nullopt;
  const Execution* best = nullptr;
  for (const Execution& one : of_node->second) {
    if (one.start > act.at + kTolerance || one.end + kTolerance < act.at) continue;
    const bool ends = act.deed == Deed::kWritten && one.end <= act.at + kTolerance;
    if (ends) return one.mark;
    if (best == nullptr || one.start > best->start) best = &one;
  }
  return best != nullptr ? std::optional(best->mark) : std::nullopt;
}

// An execution that began before the measurement dealt with another list.
void MeasurementWays::pass(const MeasurementId& id, const Stop& stop) {
  const auto followed = ways_.find(id);
  if (followed == ways_.end()) return;
  Way& way = followed->second.way;
  way.stops.push_back(stop);
  if (stop.mark && stop.mark->at < way.measured) way.stops.back().mark.reset();
}

std::optional<WayMark> MeasurementWays::perform(const Act& act) {
  const std::optional<WayMark> execution = execution_of(act);
  const Stop stop{act.deed, act.at, act.node, execution};
  switch (act.deed) {
    case Deed::kMeasured:
    case Deed::kFrame: break;  // not a task's
    case Deed::kRead:
    case Deed::kWritten:
    case Deed::kHeld:
      for (const MeasurementId& id : act.ids) pass(id, stop);
      break;
    case Deed::kFused:
      for (const MeasurementId& id : act.ids) {
        pass(id, stop);
        if (const auto followed = ways_.find(id); followed != ways_.end()) followed->second.way.fused = true;
      }
      break;
    case Deed::kRefused:
    case Deed::kLost:
      for (const MeasurementId& id : act.ids) {
        pass(id, stop);
        if (const auto followed = ways_.find(id); followed != ways_.end() && !followed->second.way.lost)
          followed->second.way.lost = act.mark;
      }
      break;
    case Deed::kImage: write_image(act, stop); break;
    case Deed::kImageFrame: send_image(act); break;
    case Deed::kUsed: use_image(act, stop); break;
  }
  return execution;
}

void MeasurementWays::write_image(const Act& act, const Stop& stop) {
  FollowedImage image{{act.at, act.node, act.image, {stop}}, {}, {}};
  for (const MeasurementId& id : act.ids) {
    const auto followed = ways_.find(id);
    if (followed == ways_.end() || !followed->second.way.fused || followed->second.way.in_image) continue;
    followed->second.way.in_image = true;
    pass(id, stop);
    image.ids.push_back(id);
  }
  images_.push_back(std::move(image));
}

void MeasurementWays::send_image(const Act& act) {
  const auto sent = std::find_if(images_.rbegin(), images_.rend(), [&](const FollowedImage& one) {
    return one.image.node == act.node && one.image.sequence == act.image;
  });
  if (sent == images_.rend() || !sent->on_flexray.takes(act.channel, act.fragment)) return;
  const Stop stop{Deed::kImageFrame, act.at, act.node, act.mark};
  sent->image.stops.push_back(stop);
  for (const MeasurementId& id : sent->ids)
    if (const auto followed = ways_.find(id); followed != ways_.end()) followed->second.way.stops.push_back(stop);
}

void MeasurementWays::use_image(const Act& act, const Stop& stop) {
  const bool known = act.writer != kNoNode;  // otherwise the number alone decides
  const auto used = std::find_if(images_.rbegin(), images_.rend(), [&](const FollowedImage& one) {
    return one.image.sequence == act.image && (!known || one.image.node == act.writer);
  });
  if (used == images_.rend() || used->image.used) return;
  used->image.used = true;
  used->image.stops.push_back(stop);
  for (const MeasurementId& id : used->ids) {
    pass(id, stop);
    if (const auto followed = ways_.find(id); followed != ways_.end()) end(followed);
  }
  used->ids.clear();
}

void MeasurementWays::end(Ways::iterator followed) {
  if (ended_.way) ended_.way(followed->second.way);
  ways_.erase(followed);
}

void MeasurementWays::forget(TrueTime now) {
  while (!begun_.empty() && begun_.front().first + kLongestWay < now) {
    const auto followed = ways_.find(begun_.front().second);
    if (followed != ways_.end() && followed->second.way.measured == begun_.front().first) end(followed);
    begun_.pop_front();
  }
  while (!images_.empty() && images_.front().image.at + kLongestWay < now) {
    if (ended_.image) ended_.image(images_.front().image);
    images_.pop_front();
  }
  for (auto& [node, those] : executions_)
    while (!those.empty() && those.front().start + kLongestWay < now) those.pop_front();
}

void MeasurementWays::finish() {
  while (!ways_.empty()) end(ways_.begin());
  for (const FollowedImage& one : images_)
    if (ended_.image) ended_.image(one.image);
  images_.clear();
}

}  // namespace ttf::recording::exports
