#include "schedules/analysis/dynamic_load.h"

#include <fmt/format.h>

#include <algorithm>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/minislots.h"
#include "schedules/analysis/responses.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/timing/response/flexray_dynamic.h"

namespace ttf::schedules::analysis {

using timing::response::DynamicMessage;
using timing::response::DynamicResponse;
using timing::response::DynamicSegment;
namespace {

// The least time between two nominal ends of the task that writes a list, and how much later an end may be.
struct Written {
  std::int64_t period = 0, jitter = 0;  // [ns]
};

std::optional<Written> writing_of(const model::Cluster& cluster, const model::FrameSlot& frame) {
  const std::vector<model::Task>& tasks = cluster.node(frame.sender).tasks;
  for (std::size_t t = 0; t < tasks.size(); ++t)
    for (const model::PortBinding& out : tasks[t].writes) {
      if (frame.pdu == kNoPdu || out.pdu != frame.pdu || !out.medium.is_flexray()) continue;
      const auto responses = worst_responses(cluster, frame.sender);
      if (!responses || !(*responses)[t].gap) return std::nullopt;
      const ClockBounds clocks = clock_bounds(cluster);
      const Duration gap = *(*responses)[t].gap, later = (*responses)[t].worst - shortest_execution(tasks[t]);
      const bool by_time = tasks[t].activation.kind == model::ActivationKind::kTime;
      return Written{gap.ns - (by_time ? 0 : clocks.drift_ns(gap.ns)),
                     later.ns + clocks.drift_ns(later.ns) + clocks.apart_ns};
    }
  return std::nullopt;
}

std::int64_t minislot_ns(const model::GlobalParameters& g) { return (g.gdMinislot * g.gdMacrotick_ps + 999) / 1'000; }

// The frames of one channel in the order of their slots. Each of them is sent at most once in each of its own cycles.
class ChannelByTheory {
 public:
  ChannelByTheory(const model::Cluster& cluster, model::Channel channel) {
    const model::GlobalParameters& g = cluster.flexray;
    for (std::size_t i = 0; i < cluster.frames.size(); ++i) {
      const model::FrameSlot& frame = cluster.frames[i];
      if (!is_dynamic(g, frame) || !includes(frame.channels, channel)) continue;
      const auto& sender = cluster.node(frame.sender).flexray;
      if (!sender || (frame.repetition & (frame.repetition - 1)) != 0) return;
      const std::int64_t own = cluster.cycle().ns * frame.repetition;
      const Written every = writing_of(cluster, frame).value_or(Written{own, 0});
      frames_.push_back(i);
      messages_.push_back({.slot = frame.slot - g.gNumberOfStaticSlots,
                           .base_cycle = frame.base_cycle,
                           .repetition = frame.repetition,
                           .minislots = minislots_of(g, dynamic_words(cluster, frame)),
                           .latest_tx = sender->pLatestTx,
                           .period = std::max(own, every.period),
                           .jitter = every.period < own ? 0 : every.jitter});
    }
    if (messages_.empty()) return;
    const DynamicSegment segment{.cycle = cluster.cycle().ns,
                                 .minislot = minislot_ns(g),
                                 .minislots = g.gNumberOfMinislots,
                                 .decision = DynamicSegment::Decision::kAtTurn};
    responses_ = timing::response::covering_bounds(segment, messages_);
  }

  // Theory has repetitions that are powers of two, and senders with a pLatestTx.
  bool applies() const { return !responses_.empty(); }
  // Returns the longest time from writing to the end of a frame of this channel; none without a bound. A response counts
  // from the nominal end of the task. If it is no longer than the period, no earlier list waits, and it is longest for
  // the latest end.
  std::optional<Duration> of(std::size_t frame) const {
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      const timing::response::Response& found = responses_[i].response;
      if (frames_[i] != frame || !found.bounded()) continue;
      return Duration{found.longest - (found.longest <= messages_[i].period ? messages_[i].jitter : 0)};
    }
    return std::nullopt;
  }

 private:
  std::vector<std::size_t> frames_;
  std::vector<DynamicMessage> messages_;
  std::vector<DynamicResponse> responses_;
};

// It comes just too late for its turn in one cycle, and in its next one it has its latest turn.
Duration sent_in_its_next_cycle(const model::Cluster& cluster, const model::FrameSlot& frame) {
  const model::GlobalParameters& g = cluster.flexray;
  const std::int64_t minislots =
      latest_turn(cluster, frame) - earliest_turn(g, frame) + minislots_of(g, dynamic_words(cluster, frame));
  return cluster.cycle() * frame.repetition + Duration{minislots * minislot_ns(g)};
}

void add_time_of(const model::Cluster& cluster, const std::vector<ChannelByTheory>& channels, std::size_t frame,
                 DynamicList& list) {
  const model::FrameSlot& one = cluster.frames[frame];
  std::optional<Duration> longest = Duration{};
  if (always_in_time(cluster, one)) {
    longest = sent_in_its_next_cycle(cluster, one);
  } else {
    for (const model::Channel channel : model::kBothChannels) {
      if (!includes(one.channels, channel)) continue;
      const ChannelByTheory& theory = channels[channel == model::Channel::kA ? 0 : 1];
      list.theory_applies &= theory.applies();
      const auto found = theory.of(frame);
      longest = longest && found ? std::max(longest, found) : std::nullopt;
    }
  }
  if (longest) *longest += Duration{clock_bounds(cluster).drift_ns(longest->ns)};
  list.sent_within = list.sent_within && longest ? std::max(list.sent_within, longest) : std::nullopt;
}

std::string time_text(const DynamicList& list) {
  if (list.sent_within) return fmt::format("{:.3f} ms", in_ms(*list.sent_within));
  return list.theory_applies ? "unbounded" : "-";
}

}  // namespace

std::vector<DynamicLoad> dynamic_load(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  std::vector<DynamicLoad> loads;
  for (const model::Channel channel : model::kBothChannels) {
    DynamicLoad load;
    load.channel = channel;
    for (model::FrameSlot frame : cluster.frames) {
      if (!is_dynamic(g, frame) || !includes(frame.channels, channel)) continue;
      frame.channels = channel == model::Channel::kA ? model::Channels::kA : model::Channels::kB;
      const std::int64_t end = latest_turn(cluster, frame) - 1 + minislots_of(g, dynamic_words(cluster, frame));
      load.minislots = std::max(load.minislots, end);
    }
    if (load.minislots > 0) load.share = static_cast<double>(load.minislots) / g.gNumberOfMinislots;
    loads.push_back(load);
  }
  return loads;
}

std::vector<DynamicList> dynamic_lists(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  std::vector<DynamicList> lists;
  std::vector<ChannelByTheory> channels;
  for (const model::Channel channel : model::kBothChannels) channels.emplace_back(cluster, channel);
  for (std::size_t i = 0; i < cluster.frames.size(); ++i) {
    const model::FrameSlot& frame = cluster.frames[i];
    if (!is_dynamic(g, frame)) continue;
    if (i == 0 || !is_dynamic(g, cluster.frames[i - 1]) || !continues(cluster.frames[i - 1], frame)) {
      DynamicList& fresh = lists.emplace_back();
      fresh.pdu = frame.pdu;
      fresh.sender = frame.sender;
      fresh.channels = frame.channels;
      fresh.first_slot = frame.slot;
      fresh.first_fragment = frame.fragment;
      fresh.base_cycle = frame.base_cycle;
      fresh.repetition = frame.repetition;
      fresh.minislots_each = minislots_of(g, dynamic_words(cluster, frame));
      fresh.earliest_turn = earliest_turn(g, frame);
    }
    DynamicList& list = lists.back();
    list.last_slot = frame.slot;
    list.last_fragment = frame.fragment;
    list.latest_turn = std::max(list.latest_turn, latest_turn(cluster, frame));
    list.always_in_time &= always_in_time(cluster, frame);
    add_time_of(cluster, channels, i, list);
  }
  return lists;
}

std::string dynamic_text(const model::Cluster& cluster) {
  const auto lists = dynamic_lists(cluster);
  if (lists.empty()) return "";
  const model::GlobalParameters& g = cluster.flexray;
  std::string text = fmt::format("dynamic segment: {} minislots of {} macroticks\nwith every slot in use",
                                 g.gNumberOfMinislots, g.gdMinislot);
  for (const DynamicLoad& load : dynamic_load(cluster))
    text += fmt::format("{} {} takes {} ({:.1f} %)", load.channel == model::Channel::kA ? "" : ",",
                        letter(load.channel), load.minislots, 100.0 * load.share);
  text += fmt::format("\n{:>9}  {:<2}  {:<12}{:<24}{:>15}  {:>16}  {:>11}\n", "slot", "ch", "sender", "list",
                      "minislots each", "turn in minislot", "sent within");
  for (const DynamicList& list : lists) {
    const bool one = list.first_slot == list.last_slot;
    text += fmt::format(
        "{:>9}  {:<2}  {:<12}{:<24}{:>15}  {:>16}  {:>11}\n",
        one ? fmt::format("{}", list.first_slot) : fmt::format("{}-{}", list.first_slot, list.last_slot),
        channels_text(list.channels), cluster.node(list.sender).name,
        list.pdu == kNoPdu ? "frame"
                           : fmt::format("{} {}{}", cluster.pdu(list.pdu).name, list.first_fragment,
                                         one ? "" : fmt::format("-{}", list.last_fragment)),
        list.minislots_each,
        fmt::format("{}-{}{}", list.earliest_turn, list.latest_turn, list.always_in_time ? "" : " or later"),
        time_text(list));
  }
  return text;
}

}  // namespace ttf::schedules::analysis
