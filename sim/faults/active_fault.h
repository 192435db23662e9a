// One fault of a plan at work: acts on signals and on the machinery of a run. Every family of faults derives
// its own class from this (families.h); the injector asks the faults in the plan's order.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "core/random.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"
#include "sim/engine/plant.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::faults {

// Counts and records the effects of a fault, and emits its signals.
class FaultLog {
 public:
  static constexpr std::size_t kMostText = 200;

  virtual ~FaultLog() = default;
  // `at` is now. It may precede the fault's begin: the fault befalls a signal that will still be under way then.
  virtual void acted(std::uint32_t fault, TrueTime at, std::string_view text) = 0;
  virtual void emit(const medium::Leaving& signal, std::optional<NodeId> source) = 0;
};

// The setting of a fault; all of it outlives the fault.
struct FaultSetting {
  const ttf::faults::Fault& fault;  // resolved
  std::uint32_t index = 0;          // in the plan
  const schedules::model::Cluster& cluster;
  engine::Plant& plant;
  FaultLog& log;
  TrueTime from{}, until{};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

class ActiveFault : public medium::CanDisturbance {
 public:
  explicit ActiveFault(const FaultSetting& setting) : setting_(setting) {}
  ~ActiveFault() override = default;
  ActiveFault(const ActiveFault&) = delete;
  ActiveFault& operator=(const ActiveFault&) = delete;

  // As in Disturbance, and those of CanDisturbance. touches() is about controllers' signals; emitted ones always have bytes.
  virtual bool touches(NodeId sender, schedules::model::Channel channel) const {
    return (void)sender, (void)channel, false;
  }
  virtual bool leaving(medium::Leaving& signal) { return (void)signal, true; }
  virtual bool arriving(medium::Arriving& signal) { return (void)signal, true; }
  virtual TrueTime next() const { return kNever<TrueTime>; }
  virtual void act(TrueTime now) { (void)now; }

 protected:
  const ttf::faults::Fault& fault() const { return setting_.fault; }
  const schedules::model::Cluster& cluster() const { return setting_.cluster; }
  const schedules::model::GlobalParameters& flexray() const { return setting_.cluster.flexray; }
  engine::Plant& plant() { return setting_.plant; }
  TrueTime now() const { return setting_.plant.now(); }
  TrueTime from() const { return setting_.from; }
  TrueTime until() const { return setting_.until; }
  bool active(TrueTime at) const { return at >= setting_.from && at < setting_.until; }
  bool on(schedules::model::Channel channel) const { return includes(setting_.fault.channels, channel); }
  // Returns whether the node's emitted signals reach the channel: it has its supply and a wire to there.
  bool can_send(schedules::model::Channel channel) const {
    const NodeId node = setting_.fault.node;
    return setting_.plant.powered(node) && includes(setting_.cluster.node(node).flexray->pChannels, channel);
  }
  bool powered() const { return setting_.plant.powered(setting_.fault.node); }
  std::string_view name(NodeId node) const { return setting_.cluster.node(node).name; }
  void emit(const medium::Leaving& signal, std::optional<NodeId> source) { setting_.log.emit(signal, source); }

  // Returns the stream of the fault's `index`-th draw; no draw depends on another.
  RandomStream draws(std::uint32_t index) const {
    return RandomStream(
        {setting_.seed, setting_.replication, Purpose::kFault, static_cast<std::uint16_t>(setting_.index), index});
  }

  // Counts and records an effect of the fault, now, with one sentence about it. Allocates nothing.
  template <class... Args> void acted(fmt::format_string<Args...> sentence, Args&&... args) {
    std::array<char, FaultLog::kMostText> text;
    const auto end = fmt::format_to_n(text.begin(), text.size(), sentence, std::forward<Args>(args)...).out;
    setting_.log.acted(setting_.index, setting_.plant.now(),
                       {text.data(), static_cast<std::size_t>(end - text.begin())});
  }

 private:
  FaultSetting setting_;
};

inline constexpr std::array kBothChannels = {schedules::model::Channel::kA, schedules::model::Channel::kB};

}  // namespace ttf::sim::faults
