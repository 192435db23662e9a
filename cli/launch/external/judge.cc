#include "cli/launch/external/judge.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "bus/wire/flexray_frame.h"
#include "schedules/analysis/can_load.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/model/sensor_lines.h"
#include "timebase/floor_div.h"

namespace ttf::cli::launch::external {
namespace {

using bus::ports::ReceivedFrame;
using schedules::check::stretched;
using schedules::model::Channel;
using schedules::model::FrameSlot;

constexpr Duration kLeastSilence = Duration::milliseconds(500);
constexpr std::int64_t kPeriodsOfSilence = 3;

// Before the cluster's first cycle.
constexpr Duration kLongBefore = Duration::milliseconds(-3'600'000);

}  // namespace

std::string_view text_of(Malformed kind) {
  switch (kind) {
    case Malformed::kForm: return "wrong form";
    case Malformed::kFrameCrc: return "wrong frame CRC";
    case Malformed::kContent: return "not of its slot";
    case Malformed::kList: return "impossible list";
    case Malformed::kTorn: return "incomplete list";
    case Malformed::kRepeated: return "repeated";
    case Malformed::kOldList: return "old list";
  }
  return "";
}

std::uint64_t Counts::all_malformed() const {
  return std::accumulate(malformed.begin(), malformed.end(), std::uint64_t{0});
}

Judge::Judge(const schedules::model::Cluster& cluster, std::vector<NodeId> nodes, std::int64_t time_scale_ppm,
             schedules::model::Channels channels)
    : cluster_(cluster), time_scale_ppm_(time_scale_ppm), window_(*cluster.arrival_window), channels_(channels),
      grid_(cluster, time_scale_ppm), lists_(cluster.pdus.size()),
      others_sync_(static_cast<std::size_t>(cluster.flexray.gNumberOfStaticSlots) + 1) {
  for (const NodeId id : nodes) {
    nodes_.push_back({id, {}, kLeastSilence});
    add_slots(nodes_.size() - 1);
    add_cans(nodes_.size() - 1);
  }
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const auto& flexray = cluster.nodes[n].flexray;
    if (std::ranges::find(nodes, static_cast<NodeId>(n)) == nodes.end() && flexray && flexray->pKeySlotUsedForSync)
      others_sync_[static_cast<std::size_t>(flexray->pKeySlotId)] = true;
  }
}

void Judge::add_slots(std::size_t node) {
  for (const FrameSlot& frame : cluster_.frames) {
    if (frame.sender != nodes_[node].id || is_dynamic(cluster_.flexray, frame)) continue;
    for (const Channel channel : schedules::model::kBothChannels)
      if (includes(frame.channels, channel) && includes(channels_, channel))
        turns_.push_back({node, &frame, channel, std::nullopt});
    if (frame.pdu != kNoPdu && !lists_[index_of(frame.pdu)])
      lists_[index_of(frame.pdu)] = std::make_unique<bus::cni::IncomingList>(cluster_.pdu(frame.pdu));
    const Duration silence = kPeriodsOfSilence * frame.repetition * stretched(cluster_.cycle(), time_scale_ppm_);
    nodes_[node].longest_silence = std::max(nodes_[node].longest_silence, silence);
  }
}

void Judge::add_cans(std::size_t node) {
  const NodeId id = nodes_[node].id;
  for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b) {
    const schedules::model::CanBus& bus = cluster_.can_buses[b];
    for (const schedules::model::CanMessage& message : bus.messages) {
      if (message.sender != id) continue;
      CanFrames frames{.node = node, .can_bus = b, .identifier = message.identifier, .message = &message};
      frames.flexible_data_rate = bus.flexible_data_rate;
      const schedules::model::PduLayout& layout = cluster_.pdu(message.pdu);
      frames.name = layout.name;
      frames.length = static_cast<std::size_t>(
          *schedules::analysis::can_data_length(bus.flexible_data_rate, layout.fragment_bytes));
      frames.list = std::make_unique<bus::cni::IncomingList>(layout);
      cans_.push_back(std::move(frames));
      if (!cluster_.node(id).flexray) {
        const Duration silence = kPeriodsOfSilence * stretched(message.shortest_period, time_scale_ppm_);
        nodes_[node].longest_silence = std::max(nodes_[node].longest_silence, silence);
      }
    }
  }
  for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
    const schedules::model::Sensor& sensor = cluster_.sensors[s];
    const auto can = schedules::model::can_of_lines(cluster_, static_cast<SensorId>(s));
    if (!can) continue;
    CanFrames frames{.node = node, .can_bus = *can};
    if (sensor.host == id && (sensor.scheduled || sensor.follows())) {
      frames.identifier = schedules::model::trigger_identifier(static_cast<SensorId>(s));
      frames.name = sensor.name + " trigger";
      if (sensor.scheduled) frames.at = sensor.at;
      cans_.push_back(std::move(frames));
    } else if (sensor.device == id) {
      frames.identifier = schedules::model::strobe_identifier(static_cast<SensorId>(s));
      frames.name = sensor.name + " strobe";
      frames.length = schedules::model::kStrobeBytes;
      cans_.push_back(std::move(frames));
    }
  }
}

bus::ports::ReceivedIdentifiers Judge::identifiers() const {
  bus::ports::ReceivedIdentifiers all;
  for (std::size_t slot = 0; slot < others_sync_.size(); ++slot)
    if (others_sync_[slot]) all.slots.push_back(static_cast<int>(slot));
  for (const Turn& turn : turns_) all.slots.push_back(turn.frame->slot);
  std::ranges::sort(all.slots);
  all.slots.erase(std::unique(all.slots.begin(), all.slots.end()), all.slots.end());
  all.can.resize(cluster_.can_buses.size());
  for (const CanFrames& frames : cans_) all.can[frames.can_bus].push_back(frames.identifier);
  return all;
}

void Judge::receive(const ReceivedFrame& received) {
  switch (received.form) {
    case ReceivedFrame::Form::kFrame: return receive_frame(received);
    case ReceivedFrame::Form::kFollowUp:
      if (is_sync_of_others(received.slot))
        grid_.follow_up(static_cast<Channel>(received.line), received.slot, received.cycle_counter, received.late);
      return;
    case ReceivedFrame::Form::kCan: return receive_can(received);
    case ReceivedFrame::Form::kMalformed: return receive_malformed(received);
  }
}

bool Judge::is_sync_of_others(int slot) const {
  return slot >= 1 && static_cast<std::size_t>(slot) < others_sync_.size() &&
         others_sync_[static_cast<std::size_t>(slot)];
}

Judge::Node& Judge::received_from(std::size_t number, MachineTime at) {
  Node& node = nodes_[number];
  if (!node.counts.first) node.counts.first = at;
  node.counts.last = at;
  if (!node.first_cycle && grid_.known()) node.first_cycle = std::max(grid_.cycle_at(at), std::int64_t{0});
  return node;
}

void Judge::count(Node& node, Malformed kind) { ++node.counts.malformed[static_cast<std::size_t>(kind)]; }

void Judge::receive_malformed(const ReceivedFrame& received) {
  if (received.line <= bus::ports::line_of(Channel::kB)) {
    if (const Turn* turn = turn_of(received.slot, static_cast<Channel>(received.line), std::nullopt))
      count(received_from(turn->node, received.at), Malformed::kForm);
  } else if (CanFrames* const frames = frames_of(received.line - bus::ports::line_of_can(0), received.can.identifier)) {
    frames->received = true;
    count(received_from(frames->node, received.at), Malformed::kForm);
  }
}

void Judge::receive_frame(const ReceivedFrame& received) {
  const auto channel = static_cast<Channel>(received.line);
  const bus::wire::DecodedFrame frame = bus::wire::decode_frame(channel, received.bytes);
  if (is_sync_of_others(received.slot)) {
    if (frame.error == bus::wire::FrameError::kNone && frame.header.sync)
      grid_.sync_frame(channel, received.slot, frame.header.cycle, received.at);
    return;
  }
  const Turn* const any = turn_of(received.slot, channel, std::nullopt);
  if (any == nullptr) return;
  Node& node = received_from(any->node, received.at);
  if (!has_header(frame)) return count(node, Malformed::kForm);
  // With a sound header the frame was sent in its cycle, whatever its frame CRC.
  const bool broken = frame.error != bus::wire::FrameError::kNone;
  const auto count_as = [&](Malformed kind) { count(node, broken ? Malformed::kFrameCrc : kind); };
  Turn* const turn = turn_of(received.slot, channel, frame.header.cycle);
  if (turn == nullptr || !is_of(*turn->frame, frame.header)) return count_as(Malformed::kContent);
  if (!grid_.known()) return broken ? count(node, Malformed::kFrameCrc) : void(++node.counts.early);
  const std::int64_t cycle = grid_.nearest(received.at, frame.header.cycle), here = grid_.cycle_at(received.at);
  if (cycle < here - 1 || cycle > here + 1) return count_as(Malformed::kContent);
  if (turn->last == cycle) return count_as(Malformed::kRepeated);
  node.counts.missing += missed(node, turn->frame->base_cycle, turn->frame->repetition, turn->last, cycle);
  turn->last = std::max(turn->last.value_or(cycle), cycle);
  if (broken) return count(node, Malformed::kFrameCrc);
  if (const auto fault = fault_of(*turn->frame, frame)) return count(node, *fault);
  const Duration due = grid_.in_cycle(grid_.action_point(received.slot));
  judge_instant(node, cycle < 0 ? kLongBefore : received.at - (grid_.start_of(cycle) + due));
}

bool Judge::is_of(const FrameSlot& slot, const bus::wire::FrameHeader& header) const {
  const schedules::model::NodeParameters& parameters = *cluster_.node(slot.sender).flexray;
  const bool sync = parameters.pKeySlotUsedForSync && slot.slot == parameters.pKeySlotId;
  return header.payload_words == cluster_.flexray.gPayloadLengthStatic && header.sync == sync &&
         header.startup == (sync && parameters.pKeySlotUsedForStartup) && in_cycle(slot, header.cycle);
}

std::optional<Malformed> Judge::fault_of(const FrameSlot& slot, const bus::wire::DecodedFrame& frame) {
  if (slot.pdu == kNoPdu || frame.header.null_frame) return std::nullopt;
  const auto before = static_cast<std::size_t>(preamble_bytes(cluster_.flexray, slot));
  const auto bytes = static_cast<std::size_t>(cluster_.pdu(slot.pdu).fragment_bytes);
  bus::cni::IncomingList& list = *lists_[index_of(slot.pdu)];
  return fault_of(list.arrive(frame.payload.subspan(before, bytes), slot.fragment));
}

std::optional<Malformed> Judge::fault_of(bus::cni::ArrivalEffect effect) {
  switch (effect) {
    case bus::cni::ArrivalEffect::kMalformed: return Malformed::kList;
    case bus::cni::ArrivalEffect::kTorn: return Malformed::kTorn;
    case bus::cni::ArrivalEffect::kStale: return Malformed::kOldList;
    case bus::cni::ArrivalEffect::kIncomplete:
    case bus::cni::ArrivalEffect::kCompleted:
    case bus::cni::ArrivalEffect::kDuplicate: break;  // on FlexRay the other channel's, or the next cycle's
  }
  return std::nullopt;
}

void Judge::receive_can(const ReceivedFrame& received) {
  CanFrames* const frames = frames_of(received.line - bus::ports::line_of_can(0), received.can.identifier);
  if (frames == nullptr) return;
  Node& node = received_from(frames->node, received.at);
  frames->received = true;
  if (received.can.flexible_data_rate != frames->flexible_data_rate || received.can.data.size() != frames->length)
    return count(node, Malformed::kForm);
  if (frames->list) return judge_list(received, *frames, node);
  if (!frames->at) return void(++node.counts.in_window);  // a strobe, or the trigger of a sensor that follows
  if (!grid_.known()) return void(++node.counts.early);
  judge_trigger(received, *frames, node);
}

void Judge::judge_list(const ReceivedFrame& received, CanFrames& frames, Node& node) {
  const schedules::model::PduLayout& layout = cluster_.pdu(frames.message->pdu);
  const auto effect = frames.list->arrive(received.can.data.first(static_cast<std::size_t>(layout.fragment_bytes)));
  // No other channel brings a list again, and no cycle does.
  if (effect == bus::cni::ArrivalEffect::kDuplicate) return count(node, Malformed::kRepeated);
  const auto fault = fault_of(effect);
  if (fault && fault != Malformed::kTorn) return count(node, *fault);  // it begins no list
  const std::uint32_t sequence = frames.list->arrived();
  const bool begins = frames.sequence != sequence;
  const Duration shortest = stretched(frames.message->shortest_period, time_scale_ppm_);
  // The sender's own lateness may lie between two lists.
  const bool early = begins && frames.sequence && received.at - frames.began + window_.late < shortest;
  if (begins) {
    frames.sequence = sequence;
    frames.began = received.at;
  }
  if (fault) return count(node, *fault);
  ++(early ? node.counts.early : node.counts.in_window);
}

// A trigger states no cycle: it is that of the nearest instant.
void Judge::judge_trigger(const ReceivedFrame& received, CanFrames& frames, Node& node) {
  const Duration offset = grid_.in_cycle(frames.at->offset);
  const std::int64_t here = grid_.cycle_at(received.at), repetition = frames.at->repetition;
  const std::int64_t since = ((here - frames.at->base_cycle) % repetition + repetition) % repetition;
  const auto behind = [&](std::int64_t cycle) { return received.at - (grid_.start_of(cycle) + offset); };
  const std::int64_t before = here - since, next = before + repetition;
  const std::int64_t cycle = -behind(next) < behind(before) ? next : before;
  if (frames.last == cycle) return count(node, Malformed::kRepeated);
  node.counts.missing += missed(node, frames.at->base_cycle, frames.at->repetition, frames.last, cycle);
  frames.last = std::max(frames.last.value_or(cycle), cycle);
  judge_instant(node, cycle < 0 ? kLongBefore : behind(cycle));
}

void Judge::judge_instant(Node& node, Duration behind) const {
  ++(behind < -window_.early ? node.counts.early : behind > window_.late ? node.counts.late : node.counts.in_window);
}

// Returns how many of these cycles lie between two cycles, without both. The cycle of the node's first frame stands
// for a last one: a node that begins within a cycle may have been too late for its other frames.
std::uint64_t Judge::missed(const Node& node, int base_cycle, int repetition, std::optional<std::int64_t> last,
                            std::int64_t next) {
  if (!last) last = node.first_cycle;
  if (!last || next <= *last + 1) return 0;
  const auto passed = [&](std::int64_t cycle) {  // before that one
    return timebase::floor_div(cycle - base_cycle + repetition - 1, repetition);
  };
  return static_cast<std::uint64_t>(passed(next) - passed(*last + 1));
}

Judge::Turn* Judge::turn_of(int slot, Channel channel, std::optional<std::uint8_t> cycle_counter) {
  for (Turn& turn : turns_)
    if (turn.frame->slot == slot && turn.channel == channel &&
        (!cycle_counter || in_cycle(*turn.frame, *cycle_counter)))
      return &turn;
  return nullptr;
}

Judge::CanFrames* Judge::frames_of(std::size_t can_bus, std::uint32_t identifier) {
  for (CanFrames& frames : cans_)
    if (frames.can_bus == can_bus && frames.identifier == identifier) return &frames;
  return nullptr;
}

Counts Judge::counts(std::size_t number) const {
  Counts counts = nodes_[number].counts;
  const auto until = grid_.last_received_cycle();
  if (!until) return counts;
  for (const Turn& turn : turns_)
    if (turn.node == number)
      counts.missing += missed(nodes_[number], turn.frame->base_cycle, turn.frame->repetition, turn.last, *until);
  for (const CanFrames& frames : cans_)
    if (frames.node == number && frames.at)
      counts.missing += missed(nodes_[number], frames.at->base_cycle, frames.at->repetition, frames.last, *until);
  return counts;
}

std::vector<std::string> Judge::never_received(std::size_t number) const {
  std::vector<std::string> names;
  if (!nodes_[number].counts.first) return names;
  for (const CanFrames& frames : cans_)
    if (frames.node == number && !frames.at && !frames.received) names.push_back(frames.name);
  return names;
}

}  // namespace ttf::cli::launch::external
