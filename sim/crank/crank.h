// The crank in virtual time: the nodes' oscillators and supplies, the queue of what is to happen, and FlexRay between
// the nodes. What a node is made of is the business of who derives from it: controllers alone
// (sim/crank/bus_simulation.h) or whole executives (sim/crank/cluster_simulation.h).
//
// Single-threaded; everything that happens is ordered by sim/medium/event_queue.h, a disturbance's own acts coming
// after all else of their instant, so a run is a pure function of its configuration.
//
// A node that is powered on while signals are on their way to it hears the rest of them as activity that it cannot make
// out, from the instant of its power-on.
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
#include "sim/crank/plant.h"
#include "sim/medium/flexray_medium.h"
#include "sim/medium/star_coupler.h"
#include "timebase/oscillator.h"

namespace ttf::sim::crank {

class Crank : public Plant {
 public:
  // Cycle 0 of nodes that begin integrated.
  struct FirstCycle {
    TrueTime start{};
    Duration length{};
  };

  // Everything up to and including `end`.
  void run_until(TrueTime end);

  TrueTime now() const final { return now_; }
  void power_off(NodeId node) final;
  void power_on(NodeId node, TrueTime at) final;
  void change_drift(NodeId node, std::int64_t ppb) final;
  void emit(const medium::Leaving& signal, std::optional<NodeId> source) final;

  bool powered(NodeId node) const final { return seats_[index_of(node)].powered; }
  const timebase::Oscillator& oscillator(NodeId node) const { return seats_[index_of(node)].clock.oscillator(); }
  medium::FlexRayMedium& medium() { return medium_; }
  // What a node sends on both channels at once, without bytes: over the medium, unless it tells nobody anything new.
  void transmit_on_both(NodeId sender, const bus::ports::Transmission& transmission, TrueTime start, TrueTime end);
  // The guardian of a star's channel; null where the cluster has none.
  medium::StarCoupler* coupler(schedules::model::Channel channel) { return couplers_[index_of(channel)].get(); }
  // Null: nothing goes wrong.
  void set_disturbance(medium::Disturbance* disturbance);

 protected:
  // `others`: frames and events that are pending beside FlexRay's, at most.
  Crank(const schedules::model::Cluster& cluster, std::size_t others);

  // The next node's clock, to be called once per node in the order of their ids. Nothing: it has its supply already,
  // and start() has been or will be called by who derives; refresh() when it can say what is next.
  void seat(const timebase::Oscillator& oscillator, std::optional<TrueTime> power_on);
  // Of a cluster with guardians, one for each channel that somebody is on, with the oscillator that `crystal` gives it:
  // powered on at once, to integrate like the nodes, or in the middle of `first`.
  void seat_guardians(const std::function<timebase::Oscillator(schedules::model::Channel)>& crystal,
                      const std::optional<FirstCycle>& first);
  // The node's next event may be another one now; most arrivals change nothing about it.
  void refresh(std::size_t node) {
    if (is_powered(node) && next_event(node) != seats_[node].next) set_next_event(node, next_event(node));
  }
  bool is_powered(std::size_t node) const { return seats_[node].powered; }
  // What began to be sent before has not reached this node, nor was it sent by what is there now.
  TrueTime powered_since(std::size_t node) const { return seats_[node].since; }
  Microticks ticks(std::size_t node) const { return seats_[node].clock.oscillator().ticks_at(now_); }

  // What a node is made of. Never asked of a node without supply, but for start().
  virtual void start(std::size_t node, Microticks now) = 0;  // a cold one
  virtual void stop(std::size_t node) = 0;                   // nothing of it is left
  virtual Microticks next_event(std::size_t node) const = 0;
  virtual void advance(std::size_t node, Microticks now) = 0;
  virtual void receive(std::size_t node, const bus::ports::Reception& reception) = 0;
  // The same on both channels at once; `reception` says channel A. False: the node's next event is what it was.
  virtual bool receive_on_both(std::size_t node, const bus::ports::Reception& reception) = 0;
  // bus/controller/controller.h. The test compares whole drives with and without these two and receive_on_both()
  // (tests/sim/processes/unwanted_frames_test.cc).
  virtual bool knows(std::size_t node, const bus::ports::Reception& reception) = 0;
  virtual void hear_known(std::size_t node, const bus::ports::Reception& reception) = 0;
  virtual void drifts(std::size_t node) { (void)node; }  // its oscillator is another one now
  // What is no arrival on FlexRay.
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
  // A node's oscillator. It remembers the signal that it was asked for last: the other channel's has the same instants.
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
    TrueTime since{};   // it is with or without supply
    Microticks next{};  // its next own event, when it was asked last
  };
  void set_next_event(std::size_t node, Microticks next);
  void set_next(std::size_t node, TrueTime time);
  TrueTime next_time(const Seat& seat) const;
  void step(std::size_t node);
  // Whether what happens at that place is the next thing to happen, within the run that is going on.
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
  std::vector<TrueTime> next_;  // by NodeId, its next own event; without supply its power-on
  std::size_t earliest_ = 0;    // in next_
  medium::Disturbance* disturbance_ = nullptr;
  TrueTime now_{}, until_{};  // until_: of the run_until() that is going on
};

// The port of a node's controller on the simulated FlexRay.
class CrankPort : public bus::ports::FlexRayPort {
 public:
  CrankPort(Crank& crank, NodeId node) : crank_(crank), node_(node) {}
  void transmit(const bus::ports::Transmission& transmission) override;
  void transmit_on_both(const bus::ports::Transmission& transmission) override;
  bool carrier(schedules::model::Channel channel) const override;
  bool wants_bytes(schedules::model::Channel channel) const override;

 private:
  Crank& crank_;
  NodeId node_;
};

}  // namespace ttf::sim::crank
