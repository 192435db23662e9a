#include "experiments/campaign/can/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "bus/cni/can_controller.h"
#include "core/random.h"
#include "evaluation/faults/can_judge.h"
#include "experiments/campaign/full_list.h"
#include "experiments/campaign/judged.h"
#include "recording/records/enumerations.h"
#include "sim/engine/can_simulation.h"
#include "sim/faults/injector.h"

namespace ttf::experiments::campaign::can {
namespace {

using evaluation::faults::CanJudge;
using evaluation::faults::CanJudgement;

evaluation::faults::CanJudgeSettings judge_settings(const Setting& setting, const faults::Fault& fault) {
  const TrueTime from = TrueTime{} + fault.from;
  return {setting.bus, fault.node, from,
          fault.duration == faults::Fault::kToTheEnd ? kNever<TrueTime> : from + fault.duration};
}

class Trial final : public sim::engine::CanHosts, public recording::records::Sink {
 public:
  Trial(const Setting& setting, const Variant& variant, const faults::Fault& fault, std::uint32_t index, Story* story,
        Witness* witness)
      : setting_(setting), variant_(variant), story_(story), witness_(witness),
        judge_(setting.cluster, judge_settings(setting, fault)),
        simulation_(setting.cluster, setting.bus, *this, *this, setting.campaign.seed, index),
        injector_({setting.campaign.file, {fault}}, setting.cluster, simulation_, setting.campaign.seed, index, *this),
        hosts_(setting.cluster.nodes.size()), restart_at_(setting.cluster.nodes.size(), kNever<TrueTime>) {
    simulation_.medium().set_recovery(variant.recovery);
    simulation_.set_disturbance(&injector_);
    for (std::size_t n = 0; n < hosts_.size(); ++n)
      if (is_on_can(setting.cluster.nodes[n], setting.bus))
        hosts_[n] = std::make_unique<Host>(*this, static_cast<NodeId>(n));
    for (std::size_t m = 0; m < bus().messages.size(); ++m) {
      RandomStream phase({setting.campaign.seed, index, Purpose::kCampaign, static_cast<std::uint16_t>(m + 1), 0});
      lists_.push_back({TrueTime{phase.integer(0, bus().messages[m].shortest_period.ns - 1)}, 0});
    }
  }

  void go_bit_by_bit() { simulation_.medium().set_bit_by_bit(true); }
  void run_until(TrueTime end) {
    while (true) {
      TrueTime next = *std::min_element(restart_at_.begin(), restart_at_.end());
      for (const List& list : lists_) next = std::min(next, list.due);
      if (next > end) break;
      simulation_.run_until(next);
      restart(next);
      queue(next);
    }
    simulation_.run_until(end);
  }
  const CanJudgement& finish() { return judge_.finish(simulation_.now()); }
  const sim::faults::Injector::Activation& activation() const { return injector_.activations().front(); }

 private:
  // The next list of a message.
  struct List {
    TrueTime due{};
    std::uint32_t number = 0;
  };
  // One node's port to the CAN, and its controller.
  struct Host final : bus::ports::CanPort {
    Host(Trial& t, NodeId n) : trial(t), node(n), controller(t.setting_.cluster, n, t.setting_.bus, *this) {}
    void send(const bus::ports::CanFrame& frame) override {
      trial.judge_.queued(node, frame.identifier, frame.data, trial.now());
      trial.simulation_.send(node, frame);
    }
    Trial& trial;
    NodeId node;
    bus::cni::CanController controller;
  };

  TrueTime now() const { return simulation_.now(); }
  const schedules::model::CanBus& bus() const { return setting_.cluster.can_buses[setting_.bus]; }
  std::string_view name(NodeId node) const { return setting_.cluster.node(node).name; }

  void queue(TrueTime at) {
    for (std::size_t m = 0; m < lists_.size(); ++m) {
      List& list = lists_[m];
      if (list.due != at) continue;
      const schedules::model::CanMessage& message = bus().messages[m];
      hosts_[index_of(message.sender)]->controller.send(
          message.pdu, full_list(setting_.cluster.pdu(message.pdu), list.number++, bytes_));
      list.due += message.shortest_period;
    }
  }
  void restart(TrueTime at) {
    for (std::size_t n = 0; n < restart_at_.size(); ++n) {
      if (restart_at_[n] > at) continue;
      const auto node = static_cast<NodeId>(n);
      const bool restarts = simulation_.medium().restart(node, at);
      restart_at_[n] = restarts ? kNever<TrueTime> : at + variant_.restart_after;  // a fault holds it: it tries again
      if (restarts && story_ != nullptr)
        story_->say(at, fmt::format("the host of {} restarts its controller", name(node)));
    }
  }

  // The hosts' side of the controllers.
  void received(NodeId receiver, const bus::ports::CanFrame& frame) override {
    bus::cni::CanController& controller = hosts_[index_of(receiver)]->controller;
    const auto arrival = controller.receive(frame);
    judge_.received(receiver, frame.identifier, frame.data, arrival && arrival->torn, !arrival, now());
    if (witness_ != nullptr) witness_->received(receiver, frame, now());
  }
  void sent(NodeId sender) override {
    judge_.sent(sender);
    if (witness_ != nullptr) witness_->sent(sender, now());
  }

  // The medium's records.
  using recording::records::Sink::on;
  void on(const recording::records::CanFrameSent& frame) override { judge_.begun(frame); }
  void on(const recording::records::CanErrorFrame& error) override {
    judge_.error_frame(error);
    if (story_ != nullptr)
      story_->say(error.stamp.true_time,
                  fmt::format("{} begins an error frame as {}: {} error; it has {} transmit and {} receive errors",
                              name(error.stamp.node), error.as_transmitter ? "transmitter" : "receiver",
                              to_text(error.error), error.transmit_errors, error.receive_errors),
                  Story::Of::kErrorFrames);
  }
  void on(const recording::records::CanStateChanged& change) override {
    judge_.state_changed(change);
    const NodeId node = change.stamp.node;
    if (change.to == recording::records::CanState::kBusOff && variant_.recovery == sim::medium::CanRecovery::kByHost)
      restart_at_[index_of(node)] = change.stamp.true_time + variant_.restart_after;
    if (story_ == nullptr) return;
    story_->say(change.stamp.true_time,
                fmt::format("{}: {} -> {}; {} transmit and {} receive errors", name(node), to_text(change.from),
                            to_text(change.to), change.transmit_errors, change.receive_errors));
  }
  void on(const recording::records::FaultActivity& activity) override {
    if (story_ == nullptr) return;
    story_->say(activity.at, fmt::format("fault {}: {}", activity.kind, activity.text),
                activity.what == recording::records::FaultAct::kActs ? Story::Of::kFault : Story::Of::kOthers);
  }

  const Setting& setting_;
  const Variant& variant_;
  Story* story_;
  Witness* witness_;
  CanJudge judge_;
  sim::engine::CanSimulation simulation_;
  sim::faults::Injector injector_;
  std::vector<std::unique_ptr<Host>> hosts_;  // by NodeId
  std::vector<TrueTime> restart_at_;          // by NodeId
  std::vector<List> lists_;                   // by message of the CAN
  std::vector<std::byte> bytes_;
};

}  // namespace

FaultOutcome run_trial(const Setting& setting, const Variant& variant, const DrawnFault& drawn, std::uint32_t index,
                       Story* story, bool bit_by_bit, Witness* witness) {
  Trial trial(setting, variant, drawn.fault, index, story, witness);
  if (bit_by_bit) trial.go_bit_by_bit();
  trial.run_until(TrueTime{} + setting.campaign.duration);
  const CanJudgement& judgement = trial.finish();
  if (story != nullptr) report(judgement, evaluation::faults::kAllCanChecks, *story);
  return outcome_of(judgement, trial.activation());
}

}  // namespace ttf::experiments::campaign::can
