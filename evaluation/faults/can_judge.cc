#include "evaluation/faults/can_judge.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/analysis/can_load.h"

namespace ttf::evaluation::faults {
namespace {

using recording::records::CanError;
using recording::records::CanState;

constexpr std::int64_t kBitsToNextFrame = 31;  // behind an error

CanCheck check_of(CanError error) {
  switch (error) {
    case CanError::kBit: return CanCheck::kBit;
    case CanError::kStuff: return CanCheck::kStuff;
    case CanError::kForm: return CanCheck::kForm;
    case CanError::kCrc: return CanCheck::kCrc;
    case CanError::kAcknowledgement: return CanCheck::kAcknowledgement;
    case CanError::kNone: break;
  }
  TTF_CHECK(false, "CAN error {}", static_cast<int>(error));
}

}  // namespace

std::string_view name_of(CanCheck check) {
  switch (check) {
    case CanCheck::kBit: return "bit";
    case CanCheck::kStuff: return "stuff";
    case CanCheck::kForm: return "form";
    case CanCheck::kCrc: return "crc";
    case CanCheck::kAcknowledgement: return "acknowledgement";
    case CanCheck::kForeign: return "foreign";
    case CanCheck::kTorn: return "torn";
    case CanCheck::kPassive: return "passive";
    case CanCheck::kBusOff: return "bus_off";
  }
  TTF_CHECK(false, "check {}", static_cast<int>(check));
}

std::string_view name_of(CanHarm harm) {
  switch (harm) {
    case CanHarm::kFrameLost: return "frame_lost";
    case CanHarm::kFrameLate: return "frame_late";
    case CanHarm::kFrameWrong: return "frame_wrong";
    case CanHarm::kFrameTwice: return "frame_twice";
    case CanHarm::kUncontained: return "uncontained";
  }
  TTF_CHECK(false, "harm {}", static_cast<int>(harm));
}

CanJudge::CanJudge(const schedules::model::Cluster& cluster, const CanJudgeSettings& settings)
    : CanJudgeBase(settings.from, settings.until, cluster.nodes.size()), settings_(settings),
      states_(cluster.nodes.size()) {
  const schedules::model::CanBus& bus = cluster.can_buses[settings.bus];
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    if (is_on_can(cluster.nodes[n], settings.bus) && static_cast<NodeId>(n) != settings.faulty)
      receivers_.push_back(static_cast<NodeId>(n));
  Duration longest{};
  for (const schedules::model::CanMessage& message : bus.messages) {
    longest = std::max(longest, schedules::analysis::can_worst_case(bus, cluster.pdu(message.pdu).fragment_bytes));
    if (message.sender == settings.faulty) continue;
    const auto response = schedules::analysis::can_worst_response(cluster, bus, message);
    TTF_CHECK(response.has_value(), "no bound for {}", cluster.pdu(message.pdu).name);
    messages_.push_back(
        {message.identifier, message.sender, *response, {}, std::vector<std::size_t>(cluster.nodes.size())});
  }
  cost_of_error_ = longest + schedules::analysis::can_duration(bus, {kBitsToNextFrame, 0});
}

CanJudge::Message* CanJudge::message_of(std::uint32_t identifier) {
  for (Message& message : messages_)
    if (message.identifier == identifier) return &message;
  return nullptr;
}

bool CanJudge::is_late(const Message& message, const Owed& frame, TrueTime at) const {
  const auto errors = std::min<std::int64_t>(kMostErrors, static_cast<std::int64_t>(errors_ - frame.errors_before));
  return at > frame.queued + message.response + cost_of_error_ * errors;
}

void CanJudge::lose(const Message& message, std::size_t first, std::size_t end, NodeId receiver, TrueTime at) {
  if (first < end) harm(CanHarm::kFrameLost, at, receiver, message.sender, static_cast<int>(message.identifier));
}

void CanJudge::queued(NodeId sender, std::uint32_t identifier, std::span<const std::byte> data, TrueTime at) {
  Message* const message = message_of(identifier);
  if (message == nullptr || message->sender != sender) return;
  message->frames.push_back({at, errors_, {data.begin(), data.end()}});
}

void CanJudge::received(NodeId receiver, std::uint32_t identifier, std::span<const std::byte> data, bool torn,
                        bool foreign, TrueTime at) {
  const bool itself = receiver == settings_.faulty;
  if (torn) notice(CanCheck::kTorn, !itself, itself, at);
  if (foreign) notice(CanCheck::kForeign, !itself, itself, at);
  Message* const message = message_of(identifier);
  if (itself || message == nullptr) return;
  const auto is_it = [&](const Owed& frame) {
    return std::equal(frame.data.begin(), frame.data.end(), data.begin(), data.end());
  };
  std::size_t& next = message->next[index_of(receiver)];
  const auto found =
      std::find_if(message->frames.begin() + static_cast<std::ptrdiff_t>(next), message->frames.end(), is_it);
  if (found == message->frames.end()) {
    const bool twice = std::any_of(message->frames.begin(), found, is_it);
    return harm(twice ? CanHarm::kFrameTwice : CanHarm::kFrameWrong, at, receiver, message->sender,
                static_cast<int>(identifier));
  }
  const auto index = static_cast<std::size_t>(found - message->frames.begin());
  lose(*message, next, index, receiver, at);
  if (is_late(*message, *found, at))
    harm(CanHarm::kFrameLate, at, receiver, message->sender, static_cast<int>(identifier));
  next = index + 1;
}

// The lowest identifier of frames that begin together wins.
void CanJudge::begun(const recording::records::CanFrameSent& frame) {
  const TrueTime start = frame.start.true_time;
  if (lowest_ && start == frame_began_ && *lowest_ <= frame.identifier) return;
  frame_began_ = start;
  lowest_ = frame.identifier;
  winner_ = frame.start.node;
}

void CanJudge::sent(NodeId sender) {
  if (sender == settings_.faulty) fails_ = 0;
}

void CanJudge::fails(CanError error, TrueTime at) {
  const bool of_faulty = lowest_ && winner_ == settings_.faulty;
  lowest_.reset();
  if (!of_faulty || error == CanError::kAcknowledgement) return;
  if (++fails_ > kMostErrors && states_[index_of(settings_.faulty)] != CanState::kBusOff)
    harm(CanHarm::kUncontained, at, kNoNode, settings_.faulty, 0);
}

// All controllers see an error frame, except one that an error-passive receiver begins: it is recessive.
void CanJudge::error_frame(const recording::records::CanErrorFrame& error) {
  const TrueTime at = error.stamp.true_time;
  ++errors_;
  const bool itself = error.stamp.node == settings_.faulty;
  const bool silent = !error.as_transmitter && states_[index_of(error.stamp.node)] != CanState::kActive;
  notice(check_of(error.error), !itself || !silent, itself, at);
  fails(error.error, at);
}

void CanJudge::state_changed(const recording::records::CanStateChanged& change) {
  const TrueTime at = change.stamp.true_time;
  const NodeId node = change.stamp.node;
  const bool itself = node == settings_.faulty;
  states_[index_of(node)] = change.to;
  if (change.to == CanState::kActive) return came_back(node, at);
  const bool off = change.to == CanState::kBusOff;
  notice(off ? CanCheck::kBusOff : CanCheck::kPassive, !itself, itself, at);
  if (itself && off) fails_ = 0;
  went_out(node, at);
  set_first(off ? judgement_.halt : judgement_.passive, at);
}

const CanJudgement& CanJudge::finish(TrueTime at) {
  for (const Message& message : messages_)
    for (const NodeId receiver : receivers_) {
      if (receiver == message.sender) continue;
      for (std::size_t f = message.next[index_of(receiver)]; f < message.frames.size(); ++f)
        if (is_late(message, message.frames[f], at)) lose(message, f, f + 1, receiver, at);
    }
  return finished();
}

}  // namespace ttf::evaluation::faults
