// The simulated FlexRay for the laws of its port (tests/laws/flexray_port_laws.h). Every FlexRay node of a
// cluster is one of the laws' controllers, in file order.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "sim/medium/flexray_medium.h"
#include "tests/laws/flexray_port_laws.h"
#include "timebase/oscillator.h"

namespace ttf::laws {

class SimulatedFlexRay : public FlexRayBench {
 public:
  explicit SimulatedFlexRay(schedules::model::Cluster cluster) : cluster_(std::move(cluster)) {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      if (cluster_.nodes[n].flexray) nodes_.push_back(static_cast<NodeId>(n));
    for (const NodeId node : nodes_) ports_.push_back(std::make_unique<Port>(*this, node));
  }
  const schedules::model::GlobalParameters& parameters() const override { return cluster_.flexray; }
  std::int64_t microtick_ps() const override { return clock_.nominal_period_ps(); }
  std::size_t controllers() const override { return nodes_.size(); }
  bus::ports::FlexRayPort& port(std::size_t controller) override { return *ports_[controller]; }
  void run_until(Microticks now) override {
    while (!queue_.empty() && clock_.ticks_at(queue_.next().time) <= now) {
      now_ = queue_.next().time;
      const sim::medium::MediumEvent event = queue_.pop();
      ASSERT_EQ(event.kind, sim::medium::MediumEvent::Kind::kFlexRayArrival);
      const auto arrival = medium_.arrive(event, now_);
      if (!arrival) continue;
      Reached reached{controller_of(static_cast<NodeId>(event.node)),
                      arrival->channel,
                      arrival->signal,
                      clock_.ticks_at(arrival->start),
                      clock_.ticks_at(arrival->end),
                      {}};
      if (arrival->signal == bus::ports::Signal::kFrame) {
        const auto bytes = pool_.bytes(arrival->frame);
        reached.bytes.assign(bytes.begin(), bytes.end());
      }
      reached_.push_back(reached);
      medium_.release(*arrival);
    }
    now_ = clock_.time_of(now);
  }
  const std::vector<Reached>& reached() const override { return reached_; }

 protected:
  sim::medium::FlexRayMedium& medium() { return medium_; }

 private:
  struct Port final : bus::ports::FlexRayPort {
    SimulatedFlexRay& bench;
    NodeId node;
    Port(SimulatedFlexRay& b, NodeId n) : bench(b), node(n) {}
    void transmit(const bus::ports::Transmission& t) override {
      bench.medium_.transmit(node, t, bench.clock_.time_of(t.start), bench.clock_.time_of(t.end));
    }
    bool carrier(schedules::model::Channel channel) const override {
      return bench.medium_.carrier(node, channel, bench.now_);
    }
  };
  std::size_t controller_of(NodeId node) const {
    return static_cast<std::size_t>(std::find(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  }
  static constexpr std::size_t kRoom = 4096;

  schedules::model::Cluster cluster_;
  std::vector<NodeId> nodes_;  // by controller
  timebase::Oscillator clock_{25'000, 0, 0};
  TrueTime now_{};
  sim::medium::MediumQueue queue_{kRoom};
  sim::medium::FramePool pool_{kRoom};
  sim::medium::FlexRayMedium medium_{cluster_, queue_, pool_};
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<Reached> reached_;
};

}  // namespace ttf::laws
