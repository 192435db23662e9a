#include "bus/socketcan/listener.h"

#include "bus/socketcan/stamp.h"

namespace ttf::bus::socketcan {
namespace {

constexpr std::size_t kMostFilters = 512;  // the kernel's limit

// Matches one identifier, in classic CAN and CAN FD alike, remote frames too.
can_filter filter_of(std::uint32_t identifier) { return {identifier, CAN_SFF_MASK | CAN_EFF_FLAG}; }

std::vector<can_filter> filters_of(const std::vector<std::uint32_t>& identifiers) {
  std::vector<can_filter> filters;
  if (identifiers.size() > kMostFilters) return filters;
  for (const std::uint32_t identifier : identifiers) filters.push_back(filter_of(identifier));
  return filters;
}

}  // namespace

SocketCanListener::SocketCanListener(const std::array<std::string, 2>& channels, const std::vector<Can>& cans,
                                     const ports::ReceivedIdentifiers& identifiers) {
  const auto join = [&](ports::Line line, const std::string& interface, bool flexible,
                        const std::vector<std::uint32_t>& received, std::optional<Reassembly> reassembly) {
    if (interface.empty() || received.empty()) return;
    Socket socket({.interface = interface, .flexible_data_rate = flexible, .filters = filters_of(received)});
    lines_.push_back({line, std::move(socket), std::move(reassembly)});
  };
  std::vector<std::uint32_t> slots{kSymbolIdentifier};  // follow-ups
  for (const int slot : identifiers.slots) slots.push_back(static_cast<std::uint32_t>(slot));
  for (const auto channel : schedules::model::kBothChannels)
    join(ports::line_of(channel), channels[index_of(channel)], true, slots, Reassembly(channel));
  for (std::size_t b = 0; b < cans.size(); ++b)
    join(ports::line_of_can(b), cans[b].interface, cans[b].flexible_data_rate, identifiers.can[b], {});
}

std::optional<ports::ReceivedFrame> SocketCanListener::receive() {
  for (std::size_t idle = 0; idle < lines_.size();) {
    OnLine& line = lines_[turn_];
    const Status status = line.socket.receive(received_);
    if (status != Status::kDone) {
      if (status != Status::kNothing && failure_.empty()) failure_ = line.socket.failure();
      ++idle;
      turn_ = (turn_ + 1) % lines_.size();
      continue;
    }
    idle = 0;
    if ((received_.can.can_id & CAN_EFF_FLAG) != 0) continue;  // without filters
    auto received = line.reassembly ? on_channel(line) : on_can();
    if (!received) continue;
    received->line = line.line;
    received->at = on_host(received_.stamp_ns, clock_pair());
    return received;
  }
  return std::nullopt;
}

std::optional<ports::ReceivedFrame> SocketCanListener::on_channel(OnLine& line) {
  const Arrival arrival = line.reassembly->arrive(received_.can);
  if (arrival.outcome == Outcome::kFragment) return std::nullopt;
  ports::ReceivedFrame received;
  received.slot = static_cast<int>(received_.can.can_id & CAN_SFF_MASK);
  if (arrival.outcome != Outcome::kComplete) {
    if (received.slot == kSymbolIdentifier) return std::nullopt;  // nobody's
    received.form = ports::ReceivedFrame::Form::kMalformed;
  } else if (arrival.follow_up) {
    received.form = ports::ReceivedFrame::Form::kFollowUp;
    received.slot = arrival.follow_up->slot;
    received.cycle_counter = arrival.follow_up->cycle_counter;
    received.late = arrival.follow_up->late;
  } else if (arrival.signal == ports::Signal::kFrame) {
    received.bytes = arrival.frame;
  } else {
    return std::nullopt;
  }
  return received;
}

std::optional<ports::ReceivedFrame> SocketCanListener::on_can() const {
  const canfd_frame& can = received_.can;
  ports::ReceivedFrame received;
  const bool flexible = (can.flags & CANFD_FDF) != 0;
  const std::size_t most = flexible ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
  const bool fits = can.can_id <= CAN_SFF_MASK && can.len <= most && can_fd_length(can.len) == can.len;
  received.form = fits ? ports::ReceivedFrame::Form::kCan : ports::ReceivedFrame::Form::kMalformed;
  received.can = {can.can_id & CAN_SFF_MASK, flexible, {}};
  if (fits) received.can.data = std::as_bytes(std::span(can.data)).first(can.len);
  return received;
}

std::uint64_t SocketCanListener::lost() const {
  std::uint64_t lost = 0;
  for (const OnLine& line : lines_) lost += line.socket.lost();
  return lost;
}

}  // namespace ttf::bus::socketcan
