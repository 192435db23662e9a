#include "report/timing/lanes.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace ttf::report::timing {
namespace {

using LaneKind = LaneKey::Kind;

// Returns the lanes of all records and of all ways. Ways lead to steps without a task if the log has no task runs.
std::set<LaneKey> all_keys(const TimingData& data, const Ways& ways) {
  std::set<LaneKey> keys;
  for (const auto& m : data.measurements) keys.insert({LaneKind::kSensor, index_of(m.id.sensor), 0});
  for (const auto& f : data.can_frames) keys.insert({LaneKind::kCan, f.bus, 0});
  for (const auto& f : data.slot_frames) keys.insert({LaneKind::kChannel, f.channel, 0});
  for (const auto& r : data.executions) keys.insert({LaneKind::kTask, index_of(r.start.node), r.task});
  for (const auto* some : {&ways.measurements, &ways.images})
    for (const Way& way : *some)
      for (const Leg& leg : way.legs) keys.insert({leg.from.lane, leg.to.lane});
  return keys;
}

// The mean position along the ways, per node, so that a node's tasks stay together.
class Positions {
 public:
  explicit Positions(const Ways& ways) {
    for (const auto* some : {&ways.measurements, &ways.images})
      for (const Way& way : *some) {
        double position = 0;
        for (const Leg& leg : way.legs) {
          Mean& mean = means_[{leg.to.lane.kind, leg.to.lane.index}];
          mean.sum += ++position;
          ++mean.n;
        }
      }
  }
  // Lanes without a way come last.
  double of(const LaneKey& key) const {
    const auto mean = means_.find({key.kind, key.index});
    return mean != means_.end() ? mean->second.sum / mean->second.n : 1e9;
  }

 private:
  struct Mean {
    double sum = 0;
    int n = 0;
  };
  std::map<std::pair<LaneKind, std::size_t>, Mean> means_;
};

std::string label_of(const LaneKey& key, const drawing::Names& names) {
  switch (key.kind) {
    case LaneKind::kSensor: return names.sensor(SensorId(key.index));
    case LaneKind::kCan: return names.can_bus(key.index);
    case LaneKind::kChannel: return key.index == 0 ? "FlexRay A" : "FlexRay B";
    case LaneKind::kTask: break;
  }
  const NodeId node{static_cast<std::uint8_t>(key.index)};
  const std::string task = names.task(node, key.task);
  return names.node(node) == task ? task : names.node(node) + ": " + task;
}

}  // namespace

std::vector<Lane> lanes_of(const TimingData& data, const drawing::Names& names, const Ways& ways) {
  const std::set<NodeId> fusion = fusion_nodes(data);
  std::set<NodeId> features;
  for (const auto& u : data.uses) features.insert(u.stamp.node);
  const auto section_of = [&](const LaneKey& key) {
    switch (key.kind) {
      case LaneKind::kSensor: return 0;
      case LaneKind::kCan: return 1;
      case LaneKind::kChannel: return 2;
      case LaneKind::kTask: break;
    }
    const NodeId node{static_cast<std::uint8_t>(key.index)};
    return fusion.contains(node) ? 3 : features.contains(node) ? 4 : 1;
  };
  const Positions positions(ways);
  std::vector<std::pair<double, Lane>> ranked;
  for (const LaneKey& key : all_keys(data, ways)) {
    const int section = section_of(key);
    ranked.push_back({section == 1 ? positions.of(key) : 0, {key, label_of(key, names), section}});
  }
  std::ranges::stable_sort(ranked, {},
                           [](const auto& r) { return std::tuple(r.second.section, r.first, r.second.key); });
  std::vector<Lane> lanes;
  for (auto& [rank, lane] : ranked) lanes.push_back(std::move(lane));
  return lanes;
}

}  // namespace ttf::report::timing
