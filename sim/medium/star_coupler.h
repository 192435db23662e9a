// The star coupler of one channel with its central guardian (bus/guardian/guardian.h). It has an oscillator of
// its own, and a controller that integrates into the cluster like any node without a key slot. With these it
// judges every signal that begins at the coupler. The couplers of two channels are independent: a failure
// affects one channel only.
//
// Between signals it costs nothing: the controller, which never sends, is brought up to date when a signal comes.
// When the controller has lost the cluster (passive or halted), it begins anew, and start-up is open again.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bus/controller/controller.h"
#include "bus/guardian/guardian.h"
#include "bus/guardian/startup_turns.h"
#include "sim/medium/coupler.h"
#include "timebase/oscillator.h"

namespace ttf::sim::medium {

class StarCoupler final : public Coupler {
 public:
  // Faults of the coupler itself.
  enum class Failure : std::uint8_t {
    kNone,
    kSilent,     // forwards nothing
    kStuckOpen,  // forwards everything: a star without a guardian
  };
  // A signal that the guardian kept from the other nodes, wholly or from `until` on.
  struct Intervention {
    TrueTime at{};
    NodeId branch{};
    schedules::model::Channel channel{};
    bus::ports::Signal signal{};
    bus::guardian::GuardianReason reason{};  // kForwarded: cut
    TrueTime until{};
  };

  // Powered on at `on`; the oscillator's nominal period is microtick_ps().
  StarCoupler(const schedules::model::Cluster& cluster, schedules::model::Channel channel,
              const timebase::Oscillator& oscillator, TrueTime on = {});
  ~StarCoupler() override;
  StarCoupler(const StarCoupler&) = delete;
  StarCoupler& operator=(const StarCoupler&) = delete;

  // Returns whether the cluster has guardians and a node on the channel.
  static bool needed(const schedules::model::Cluster& cluster, schedules::model::Channel channel);
  static std::int64_t microtick_ps(const schedules::model::Cluster& cluster, schedules::model::Channel channel);

  // Starts as if start-up were over: cycle 0 begins at `first`, and each cycle lasts `cycle`.
  void start_integrated(TrueTime first, Duration cycle);
  void fail(Failure failure) { failure_ = failure; }
  // Calls `report` for each intervention; null: no calls. Interventions are counted in any case.
  void on_intervention(std::function<void(const Intervention&)> report) { report_ = std::move(report); }

  bool pass(Leaving& signal, const bus::wire::DecodedFrame* frame) override;
  void disturbed(const Leaving& signal) override;
  TrueTime fell_silent(NodeId branch, TrueTime at) override;

  std::uint64_t forwarded() const { return count_[0]; }  // with those that were cut
  std::uint64_t blocked(bus::guardian::GuardianReason reason) const { return count_[static_cast<std::size_t>(reason)]; }
  std::uint64_t blocked() const;  // for any reason
  std::uint64_t cut() const { return cut_; }
  std::uint64_t held() const { return held_; }  // to a minislot action point
  // As of the last signal, or of catch_up().
  const bus::poc::PocState& state() const { return controller_->state(); }
  const std::optional<timebase::CycleClock>& clock() const { return controller_->clock(); }
  const timebase::Oscillator& oscillator() const { return oscillator_; }
  void catch_up(TrueTime now);

 private:
  struct Watch;
  // A signal on its way into the guardian's own controller.
  struct Incoming {
    NodeId branch = kNoNode;  // kNoNode: from no branch, or from several
    TrueTime start{}, end{};
    bus::ports::Signal signal{};
    bus::wire::DecodedFrame frame;  // its payload in `bytes`
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
  };

  bus::guardian::GuardianAnswer judge(const bus::guardian::GuardianSignal& signal) const;
  TrueTime end_of(TrueTime start, TrueTime end, Microticks until) const;
  void power_on(Microticks now);
  void advance(Microticks to);
  void deliver(const Incoming& incoming);
  void receive(NodeId branch, const Leaving& signal, const bus::wire::DecodedFrame* frame);
  void lead_begins();

  const schedules::model::Cluster cluster_;  // with the guardian as a node
  const schedules::model::Channel channel_;
  const timebase::Oscillator oscillator_;
  const bus::guardian::Guardian guardian_;
  bus::guardian::StartupTurns turns_;
  std::unique_ptr<Watch> watch_;
  std::unique_ptr<bus::controller::FlexRayController> controller_;
  bus::controller::DynamicSlotCounter dynamic_;
  std::int64_t counted_cycle_ = -1;  // the cycle of dynamic_
  TrueTime taken_until_{};           // the channel is taken by the forwarded signal until then
  std::vector<Incoming> incoming_;
  Failure failure_ = Failure::kNone;
  std::array<std::uint64_t, bus::guardian::kAllGuardianReasons.size()> count_{};
  std::uint64_t cut_ = 0, held_ = 0;
  std::function<void(const Intervention&)> report_;
};

}  // namespace ttf::sim::medium
