#include "nodes/vision/regions.h"

#include <algorithm>
#include <cmath>

#include "nodes/host/signals.h"

namespace ttf::nodes::vision {

RegionSignals bind_regions(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout) {
  return host::bind_element<6>(cluster, layout, {"sensor", "x", "y", "width", "height", "valid"});
}

void decode_regions(const schedules::model::PduLayout& layout, const bus::cni::ListView& list,
                    const RegionSignals& signals, std::vector<Region>& regions) {
  regions.clear();
  const int count = host::element_count(layout, list);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) { return host::element_value(layout, list, i, signals[s]); };
    if (value(5) == 0.0) continue;
    regions.push_back({static_cast<SensorId>(std::lround(value(0))), value(1), value(2), value(3), value(4), true});
  }
}

RegionOutput::RegionOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task)
    : signals_(bind_regions(cluster, cluster.pdu(host::binding_of(task.writes, "regions").pdu))) {
  while (task.writes[port_].port != "regions") ++port_;
}

void RegionOutput::issue(host::StepContext& context, std::span<const Region> regions) {
  host::Output& out = context.outputs[port_];
  const int count = std::min(static_cast<int>(regions.size()), out.layout().max_elements);
  out.begin(sequence_++, count, context.stamp.global);
  for (int i = 0; i < count; ++i) {
    const Region& region = regions[static_cast<std::size_t>(i)];
    const double values[] = {static_cast<double>(index_of(region.sensor)),
                             region.x,
                             region.y,
                             region.width,
                             region.height,
                             region.valid ? 1.0 : 0.0};
    for (std::size_t s = 0; s < signals_.size(); ++s) out.set(i, signals_[s], values[s]);
  }
}

}  // namespace ttf::nodes::vision
