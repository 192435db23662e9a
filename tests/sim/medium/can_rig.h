// A simulated private CAN alone, with its queue, its disturbance and a diary of all that comes from it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "recording/records/records.h"
#include "sim/engine/plant.h"
#include "sim/medium/can_medium.h"
#include "tests/bus/layouts.h"

namespace ttf::sim::medium {

inline constexpr std::size_t kNodes = 3;

inline schedules::model::Cluster can_cluster(bool flexible_data_rate, double other_load,
                                             std::int64_t nominal_bit_rate) {
  schedules::model::Cluster cluster;
  cluster.nodes.resize(kNodes);
  cluster.pdus = {bus::list_layout(4, 3, 3)};
  schedules::model::CanBus bus;
  bus.name = "can";
  bus.flexible_data_rate = flexible_data_rate;
  bus.nominal_bit_rate = nominal_bit_rate;
  bus.data_bit_rate = flexible_data_rate ? 5 * nominal_bit_rate : nominal_bit_rate;
  bus.other_load = other_load;
  bus.messages = {{PduId{0}, 7, NodeId{0}, Duration::milliseconds(10), 0}};
  cluster.can_buses = {bus};
  return cluster;
}

struct Can final : recording::records::Sink, engine::Plant {
  schedules::model::Cluster cluster;
  MediumQueue queue;
  FramePool pool;
  CanMedium medium;
  TrueTime time{};
  Disturbance* disturbance = nullptr;
  std::vector<std::string> diary, faults;
  std::vector<recording::records::CanErrorFrame> errors;
  std::vector<recording::records::CanStateChanged> changes;
  std::size_t sent = 0, arrived = 0;
  bool writes = true;  // the diary and the lists of records

  static constexpr NodeId kMembers[kNodes] = {NodeId{0}, NodeId{1}, NodeId{2}};
  explicit Can(schedules::model::Cluster c)
      : cluster(std::move(c)), queue(CanMedium::most_pending(cluster, 0, kMembers)),
        pool(CanMedium::most_pending(cluster, 0, kMembers)), medium(cluster, 0, kMembers, queue, pool, *this, 1, 0) {}
  void disturb(Disturbance& by) {
    disturbance = &by;
    medium.set_disturbance(&by);
  }

  // The plant.
  TrueTime now() const override { return time; }
  bool powered(NodeId node) const override { return medium.has(node); }
  void power_off(NodeId node) override { medium.power_off(node, time); }
  void power_on(NodeId node, TrueTime at) override { medium.power_on(node, at); }
  void change_drift(NodeId, std::int64_t) override {}
  void emit(const Leaving&, std::optional<NodeId>) override {}
  CanMedium* can(std::size_t) override { return &medium; }

  using recording::records::Sink::on;
  void on(const recording::records::CanErrorFrame& error) override {
    if (!writes) return;
    errors.push_back(error);
    diary.push_back(
        fmt::format("{} error {} at {}", error.stamp.true_time.ns, index_of(error.error), index_of(error.stamp.node)));
  }
  void on(const recording::records::FaultActivity& activity) override {
    if (!writes) return;
    faults.push_back(fmt::format("{} {}", activity.at.ns, activity.text));
  }
  void on(const recording::records::CanStateChanged& change) override {
    if (!writes) return;
    changes.push_back(change);
    diary.push_back(fmt::format("{} state {}", change.stamp.true_time.ns, index_of(change.to)));
  }
  // Handles everything up to `end`.
  void run_until(TrueTime end) {
    while (true) {
      const TrueTime next = queue.empty() ? kNever<TrueTime> : queue.next().time;
      if (disturbance != nullptr && disturbance->next() < next && disturbance->next() <= end) {
        time = disturbance->next();
        disturbance->act(time);
        continue;
      }
      if (next > end) break;
      time = next;
      const MediumEvent event = queue.pop();
      switch (event.kind) {
        case MediumEvent::Kind::kCanArbitration: medium.arbitrate(time); break;
        case MediumEvent::Kind::kCanBits: medium.end_bits(time); break;
        case MediumEvent::Kind::kCanSent:
          ++sent;
          if (!writes) break;
          diary.push_back(fmt::format("{} sent by {}, begun {}", time.ns, event.node, event.start.ns));
          break;
        case MediumEvent::Kind::kCanArrival: {
          ++arrived;
          if (!writes) {
            pool.release(event.frame);
            break;
          }
          std::string text = fmt::format("{} at {} from {} begun {}: {:x}", time.ns, event.node, event.sender,
                                         event.start.ns, event.identifier);
          for (const std::byte byte : pool.bytes(event.frame)) text += fmt::format(" {:02x}", static_cast<int>(byte));
          diary.push_back(text);
          pool.release(event.frame);
          break;
        }
        default: ADD_FAILURE() << "an event of another medium";
      }
    }
    time = end;
  }
  void send(std::size_t node, std::uint32_t identifier, std::span<const std::byte> data) {
    medium.send(kMembers[node], time, {identifier, cluster.can_buses[0].flexible_data_rate, data});
  }
};

}  // namespace ttf::sim::medium
