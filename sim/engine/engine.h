// The engine in virtual time: the nodes' oscillators and supplies, the queue of events, and FlexRay between the
// nodes. A derived class makes the nodes: controllers alone (sim/engine/bus_simulation.h) or whole executives
// (sim/engine/cluster_simulation.h).
//
// Single-threaded. All events are ordered by sim/medium/event_queue.h; a disturbance's own acts come after all
// else of their instant. So a run is a pure function of its configuration.
//
// A node that is powered on while signals are on their way to it receives the rest of them as undecodable
// activity, from the instant of its power-on.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "sim/engine/plant.h"
#include "sim/medium/flexray_medium.h"
#include "sim/medium/star_coupler.h"
#include "timebase/oscillator.h"

namespace ttf::sim::engine {

class Engine : public Plant {
 public:
  // Cycle 0 of nodes that begin integrated.
  struct FirstCycle {
    TrueTime start{};
    Duration length{};
  };

  // Runs everything up to and including `end`.
  void run_until(TrueTime end);

  TrueTime now() const final { return now_; }
  void power_off(NodeId node) final;
  void power_on(NodeId node, TrueTime at) final;
  void change_drift(NodeId node, std::int64_t ppb) final;
  void emit(const medium::Leaving& signal, std::optional<NodeId> source) final;

  bool powered(NodeId node) const final { return seats_[index_of(node)].powered; }
  const timebase::Oscillator& oscillator(NodeId node) const { return seats_[index_of(node)].clock.oscillator(); }
  medium::FlexRayMedium& medium() { return medium_; }
  // Transmits a node's frame on both channels at once, without bytes. It bypasses the medium if it is known to all receivers.
  void transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // Returns the guardian of a star's channel; null if the cluster has none.
  medium::StarCoupler* coupler(schedules::model::Channel channel) { return couplers_[index_of(channel)].get(); }
  // Null: no disturbance.
  void set_disturbance(medium::Disturbance* disturbance);

 protected:
  // `others` is the largest number of frames and events that are pending beside FlexRay's.
  Engine(const schedules::model::Cluster& cluster, std::size_t others);

  // Adds the next node's clock; called once per node in the order of their ids. Without `power_on` the node
  // already has its supply: the derived class starts it, and calls refresh() when its next event is known.
  void seat(const timebase::Oscillator& oscillator, std::optional<TrueTime> power_on);
  // Adds the guardians of a star, one for each channel in use, with the oscillator of `crystal`. Without `first`
  // they are powered on at once and integrate like the nodes; otherwise they begin in the middle of `first`.
  void seat_guardians(const std::function<timebase::Oscillator(schedules::model::Channel)>& crystal,
                      const std::optional<FirstCycle>& first);
  // Updates the node's next event; most arrivals do not change it.
  void refresh(std::size_t node) {
    if (is_powered(node) && next_event(node) != seats_[node].next) set_next_event(node, next_event(node));
  }
  bool is_powered(std::size_t node) const { return seats_[node].powered; }
  // Returns since when the node has or lacks supply. A signal that began earlier did not reach its present
  // state, nor come from it.
  TrueTime powered_since(std::size_t node) const { return seats_[node].since; }
  Microticks ticks(std::size_t node) const { return seats_[node].clock.oscillator().ticks_at(now_); }

  // The node's own part. Without supply only start() is called.
  virtual void start(std::size_t node, Microticks now) = 0;  // starts it cold
  virtual void stop(std::size_t node) = 0;                   // drops all of it
  virtual Microticks next_event(std::size_t node) const = 0;
  virtual void advance(std::size_t node, Microticks now) = 0;
  virtual void receive(std::size_t node, const bus::ports::Reception& reception) = 0;
  // Receives the same on both channels at once; `reception` says channel A. False: the node's next event is unchanged.
  virtual bool receive_on_both(std::size_t node, const bus::ports::Reception& reception) = 0;
  // As in bus/controller/controller.h. tests/sim/processes/unwanted_frames_test.cc compares whole drives with and
  // without these two and receive_on_both().
  virtual bool is_known(std::size_t node, const bus::ports::Reception& reception) = 0;
  virtual void receive_known(std::size_t node, const bus::ports::Reception& reception) = 0;
  virtual void drifts(std::size_t node) { (void)node; }  // its oscillator has changed
  // The private CANs have this disturbance, too; null: none.
  virtual void disturbs_cans(medium::CanDisturbance* disturbance) { (void)disturbance; }
  // Handles an event other than an arrival on FlexRay.
  virtual void happen(const medium::MediumEvent& event) = 0;

  const schedules::model::Cluster& cluster_;
  medium::MediumQueue queue_;
  medium::FramePool pool_;
  medium::FlexRayMedium medium_;

 private:
  // The instants of a signal on a node's clock.
  struct Span {
    Microticks start{}, end{};
  };
  // A node's oscillator. It remembers the last signal's instants: they are the same on the other channel.
  class Clock {
   public:
    explicit Clock(const timebase::Oscillator& oscillator) : oscillator_(oscillator) {}
    const timebase::Oscillator& oscillator() const { return oscillator_; }
    void change_drift(TrueTime now, std::int64_t ppb) {
      oscillator_.change_drift(now, ppb);
      ended_ = kNever<TrueTime>;
    }
    const Span& span(TrueTime start, TrueTime end);
    const Span& last_span() const { return span_; }

   private:
    timebase::Oscillator oscillator_;
    TrueTime started_ = kNever<TrueTime>, ended_ = kNever<TrueTime>;
    Span span_;
  };
  struct Seat {
    Clock clock;
    bool powered = false;
    TrueTime since{};   // since when it has or lacks supply
    Microticks next{};  // its own next event, at the last look
  };
  void set_next_event(std::size_t node, Microticks next);
  void set_next(std::size_t node, TrueTime time);
  TrueTime next_time(const Seat& seat) const;
  void step(std::size_t node);
  // Returns whether an event at that place comes next, within the current run.
  bool comes_next(const medium::EventOrder& order) const {
    return order.time <= until_ && order < next_of_nodes() && queue_.is_first(order) &&
           (disturbance_ == nullptr || disturbance_->next() >= order.time);
  }
  void go_along(medium::MediumEvent event);
  bool make_stop(const medium::MediumEvent& event);
  bool make_stop_on_both(const medium::MediumEvent& event);
  bus::ports::Reception reception_of(Seat& seat, const medium::Arrival& arrival);
  bool arrives_alone(std::span<const medium::Leg> way, TrueTime start, TrueTime end) const;
  medium::EventOrder next_of_nodes() const {
    return {next_[earliest_], medium::Phase::kNode, static_cast<std::uint8_t>(earliest_), 0, 0};
  }

  std::array<std::unique_ptr<medium::StarCoupler>, 2> couplers_;  // by channel
  std::vector<Seat> seats_;                                       // by NodeId
  std::vector<TrueTime> next_;  // by NodeId, its own next event; its power-on while it lacks supply
  std::size_t earliest_ = 0;    // in next_
  medium::Disturbance* disturbance_ = nullptr;
  TrueTime now_{}, until_{};  // until_: of the current run_until()
};

// The port of a node's controller on the simulated FlexRay.
class EnginePort : public bus::ports::FlexRayPort, public bus::ports::ContentPort {
 public:
  EnginePort(Engine& engine, NodeId node) : engine_(engine), node_(node) {}
  void transmit(const bus::ports::Transmission& transmission) override;
  void transmit_on_both(const bus::ports::Transmission& transmission) override;
  bool carrier(schedules::model::Channel channel) const override;
  bool wants_bytes(schedules::model::Channel channel) const override;
  bus::ports::ContentPort* by_content() override { return this; }

 private:
  Engine& engine_;
  NodeId node_;
};

}  // namespace ttf::sim::engine
