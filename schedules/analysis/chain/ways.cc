#include "schedules/analysis/chain/ways.h"

#include <fmt/format.h>

#include <algorithm>

#include "schedules/analysis/chain/chains.h"

namespace ttf::schedules::analysis::chain {
namespace {

// Searches depth first.
class Ways {
 public:
  Ways(const model::Cluster& cluster, SensorId sensor) : cluster_(cluster), sensor_(sensor) {
    if (const model::Task* task = measuring_task(cluster, sensor)) extend(cluster.sensor(sensor).device, *task);
  }

  const std::vector<std::vector<Reading>>& found() const { return found_; }

 private:
  void extend(NodeId node, const model::Task& task) {
    // A crafted file may have more ways than anyone can walk.
    constexpr std::size_t kMostSteps = 100'000;
    if (++steps_ > kMostSteps || found_.size() >= kMostChains) return;
    if (task.writes.empty() && commanded_) found_.push_back(way_);
    for (const model::PortBinding& out : task.writes)
      if (const SensorId of = cluster_.pdu(out.pdu).sensor; of == sensor_ || of == kNoSensor)
        pass(out, of == kNoSensor && reads_shared(cluster_, task));
    if (const Publisher publisher = publisher_of(cluster_, node); fuses(task) && publisher.task != nullptr)
      if (!reads_shared(cluster_, *publisher.task)) pass(*publisher.image, false);
  }

  // No image shows odometry (schedules/analysis/ages.h).
  bool fuses(const model::Task& task) const {
    return task.writes.empty() && !way_.empty() && cluster_.pdu(way_.back().out->pdu).sensor == sensor_ &&
           !reads_shared(cluster_, task) && model::row_of(cluster_.sensor(sensor_).kind).observes;
  }

  // A measuring task may list more of its picture beside the sensor's own list, as marks of lanes. A task that reads both goes
  // by the own one.
  bool comes_beside(const model::PortBinding& out, const model::Task& reader) const {
    return way_.empty() && cluster_.pdu(out.pdu).sensor == kNoSensor &&
           std::ranges::any_of(reader.reads, [&](const auto& in) { return cluster_.pdu(in.pdu).sensor == sensor_; });
  }

  void pass(const model::PortBinding& out, bool commands) {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (const model::Task& reader : cluster_.nodes[n].tasks) {
        const bool reads = std::ranges::any_of(
            reader.reads, [&](const auto& in) { return in.pdu == out.pdu && in.medium == out.medium; });
        if (!reads || comes_beside(out, reader)) continue;
        if (std::ranges::any_of(way_, [&](const Reading& one) { return one.task == &reader; })) continue;
        const bool before = commanded_;
        commanded_ = commands;
        way_.push_back({&out, static_cast<NodeId>(n), &reader});
        extend(static_cast<NodeId>(n), reader);
        way_.pop_back();
        commanded_ = before;
      }
  }

  const model::Cluster& cluster_;
  SensorId sensor_;
  std::vector<Reading> way_;
  bool commanded_ = false;  // the last list of the way is a command
  std::size_t steps_ = 0;
  std::vector<std::vector<Reading>> found_;
};

}  // namespace

std::vector<std::vector<Reading>> ways_to_actuators(const model::Cluster& cluster, SensorId sensor) {
  return Ways(cluster, sensor).found();
}

std::string name_of(const model::Cluster& cluster, SensorId sensor, const std::vector<Reading>& way) {
  std::string name = cluster.sensor(sensor).name;
  for (const Reading& one : way) name += fmt::format(" -> {}.{}", cluster.node(one.node).name, one.task->name);
  return name;
}

}  // namespace ttf::schedules::analysis::chain
