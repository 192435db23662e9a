#include "bus/socketcan/medium.h"

#include <algorithm>
#include <set>
#include <utility>

#include "bus/socketcan/error_report.h"
#include "bus/socketcan/stamp.h"
#include "core/check.h"
#include "core/errors.h"

namespace ttf::bus::socketcan {
namespace {

constexpr std::size_t kChannels = 2, kLongestFailure = 512;
// Limits that keep a flood on one line from hiding the others or holding up the caller.
constexpr int kTurn = 64, kMostAtOnce = 4096;

bool is_can_fd(const canfd_frame& can) { return (can.flags & CANFD_FDF) != 0; }

}  // namespace

SocketCanMedium::SocketCanMedium(const LiveOptions& options) {
  std::set<std::string> named;
  const auto join = [&](const std::string& interface, bool flexible, std::optional<FlexRay> flexray) {
    if (interface.empty()) {
      lines_.emplace_back();
      return;
    }
    if (!named.insert(interface).second)
      throw InputError(Finding{interface, 0, "", "", "carries two lines: each line needs an interface of its own"});
    Socket socket({.interface = interface,
                   .flexible_data_rate = flexible,
                   .own_frames = flexray.has_value(),
                   .error_frames = true,
                   .receive_buffer_frames = options.receive_buffer_frames,
                   .filters = {}});
    lines_.emplace_back(OnLine{.socket = std::move(socket), .flexray = std::move(flexray)});
  };
  for (const auto channel : {schedules::model::Channel::kA, schedules::model::Channel::kB})
    join(options.channels[ports::line_of(channel)], true, FlexRay{channel, Reassembly(channel), {}});
  for (const LiveOptions::Can& can : options.cans) join(can.interface, can.flexible_data_rate, {});
  failure_.reserve(kLongestFailure);
}

SocketCanMedium::OnLine& SocketCanMedium::on(ports::Line line) {
  TTF_CHECK(line < lines_.size() && lines_[line], "line {}: this node is not on it", line);
  return *lines_[line];
}

ports::LiveStatus SocketCanMedium::done(Status status, const OnLine& line) {
  switch (status) {
    case Status::kDone:
    case Status::kNothing: return ports::LiveStatus::kDone;
    case Status::kNoRoom: ++not_sent_; return ports::LiveStatus::kNoRoom;
    case Status::kDown:
    case Status::kGone:
    case Status::kFailed: break;
  }
  if (failure_.empty()) line.socket.report_failure(failure_);
  return ports::LiveStatus::kFailed;
}

ports::LiveStatus SocketCanMedium::send_all(OnLine& line, std::span<const canfd_frame> frames) {
  for (const canfd_frame& can : frames)
    if (const Status status = line.socket.send(can); status != Status::kDone) return done(status, line);
  ++sent_;
  return ports::LiveStatus::kDone;
}

ports::LiveStatus SocketCanMedium::send(const ports::LiveSignal& signal, ports::MachineTime due) {
  OnLine& line = on(ports::line_of(signal.channel));
  if (signal.signal != ports::Signal::kFrame) {
    const canfd_frame can = symbol_to_can(signal.channel, signal.signal, signal.duration);
    const ports::LiveStatus status = send_all(line, {&can, 1});
    confirm(line);
    return status;
  }
  const CanFrames can = frame_to_can(signal.slot, signal.bytes);
  const ports::LiveStatus status = send_all(line, can.all());
  if (status == ports::LiveStatus::kDone && signal.states_late)
    line.flexray->departures.expect(can.all().back(), signal.slot, wire::header_of(signal.bytes)->cycle, due);
  confirm(line);
  return status;
}

ports::LiveStatus SocketCanMedium::send_can(std::size_t can_bus, const ports::CanFrame& frame) {
  TTF_CHECK(frame.identifier <= CAN_SFF_MASK, "identifier {}", frame.identifier);
  TTF_CHECK(frame.flexible_data_rate ? can_fd_length(frame.data.size()) == frame.data.size()
                                     : frame.data.size() <= CAN_MAX_DLEN,
            "{} bytes", frame.data.size());
  canfd_frame can{};
  can.can_id = frame.identifier;
  can.len = static_cast<std::uint8_t>(frame.data.size());
  can.flags = frame.flexible_data_rate ? CANFD_BRS | CANFD_FDF : 0;
  std::copy(frame.data.begin(), frame.data.end(), std::as_writable_bytes(std::span(can.data)).begin());
  return send_all(on(ports::line_of_can(can_bus)), {&can, 1});
}

// Takes in this node's own frames at the head of the queue, without waiting for frames that have not left yet.
// A kernel that has put off the echo continues at the first read, so there are two.
void SocketCanMedium::confirm(OnLine& line) {
  for (int look = 0; look < 2; ++look) {
    Status status = Status::kDone;
    while ((status = line.socket.receive_own(own_)) == Status::kDone) confirmed(line, own_);
    done(status, line);
    if (line.flexray->departures.none()) return;
  }
}

void SocketCanMedium::confirmed(OnLine& line, const Received& own) {
  FlexRay& flexray = *line.flexray;
  if (flexray.departures.none()) return;
  if (const auto follow_up = flexray.departures.left(own.can, on_host(own.stamp_ns, clock_pair())))
    done(line.socket.send(follow_up_to_can(flexray.channel, *follow_up)), line);
}

std::optional<ports::LiveArrival> SocketCanMedium::receive() {
  std::size_t idle = 0;
  for (int looked_at = 0; idle < lines_.size() && looked_at < kMostAtOnce;) {
    const ports::Line line = turn_;
    const Status status = lines_[line] ? lines_[line]->socket.receive(received_) : Status::kNothing;
    if (status != Status::kDone || ++in_turn_ == kTurn) {
      turn_ = (turn_ + 1) % lines_.size();
      in_turn_ = 0;
    }
    if (status != Status::kDone) {
      ++idle;
      if (lines_[line]) done(status, *lines_[line]);
      continue;
    }
    idle = 0;
    ++looked_at;
    if (auto arrival = take(line)) {
      const bool counts =
          arrival->kind != ports::LiveArrival::Kind::kFollowUp && arrival->kind != ports::LiveArrival::Kind::kCanReport;
      if (counts) ++received_count_;
      return arrival;
    }
  }
  return {};
}

// Returns the frame just received on this line if it is to be handed over.
std::optional<ports::LiveArrival> SocketCanMedium::take(ports::Line number) {
  OnLine& line = *lines_[number];
  if (received_.own) {
    confirmed(line, received_);
    return {};
  }
  ports::LiveArrival arrival;
  if (line.flexray ? !take_signal(*line.flexray, arrival) : !take_can(line, arrival)) return {};
  if (!line.flexray) arrival.can_bus = number - kChannels;
  const ClockPair pair = clock_pair();
  arrival.at = on_host(received_.stamp_ns, pair);
  arrival.received = pair.now;
  return arrival;
}

bool SocketCanMedium::take_signal(FlexRay& flexray, ports::LiveArrival& arrival) const {
  const Arrival arrived = flexray.reassembly.arrive(received_.can);
  if (arrived.outcome != Outcome::kComplete) return false;
  arrival.signal.channel = flexray.channel;
  if (arrived.follow_up) {
    arrival.kind = ports::LiveArrival::Kind::kFollowUp;
    arrival.signal.slot = arrived.follow_up->slot;
    arrival.cycle_counter = arrived.follow_up->cycle_counter;
    arrival.late = arrived.follow_up->late;
    return true;
  }
  arrival.signal.signal = arrived.signal;
  arrival.signal.slot = arrived.slot;
  arrival.signal.duration = arrived.duration;
  arrival.signal.bytes = arrived.frame;
  return true;
}

bool SocketCanMedium::take_can(OnLine& line, ports::LiveArrival& arrival) const {
  const canfd_frame& can = received_.can;
  if (const auto report = error_report_of(can)) {
    arrival.kind = ports::LiveArrival::Kind::kCanReport;
    arrival.report = *report;
    return true;
  }
  if (can.can_id > CAN_SFF_MASK) return ++line.foreign, false;  // any of the flags, or 29 bits
  const std::size_t most = is_can_fd(can) ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
  if (can.len > most || can_fd_length(can.len) != can.len) return ++line.malformed, false;
  arrival.kind = ports::LiveArrival::Kind::kCan;
  arrival.can = {can.can_id, is_can_fd(can), std::as_bytes(std::span(can.data)).first(can.len)};
  return true;
}

int SocketCanMedium::descriptor(ports::Line line) const {
  TTF_CHECK(line < lines_.size(), "line {} of {}", line, lines_.size());
  return lines_[line] ? lines_[line]->socket.descriptor() : -1;
}

ports::LiveCounts SocketCanMedium::counts() const {
  ports::LiveCounts counts{.sent = sent_, .received = received_count_, .not_sent = not_sent_};
  for (const std::optional<OnLine>& line : lines_) {
    if (!line) continue;
    counts.lost += line->socket.lost();
    counts.foreign += line->foreign;
    counts.malformed += line->malformed;
    if (!line->flexray) continue;
    const Reassembly& reassembly = line->flexray->reassembly;
    counts.lost += reassembly.abandoned();
    counts.foreign += reassembly.count(Outcome::kForeign);
    counts.malformed += reassembly.count(Outcome::kMalformed) + reassembly.count(Outcome::kDisplaced);
  }
  return counts;
}

std::vector<std::string> SocketCanMedium::shortages() const {
  std::vector<std::string> sentences;
  for (const std::optional<OnLine>& line : lines_)
    if (line && !line->socket.shortage().empty()) sentences.push_back(line->socket.shortage());
  return sentences;
}

}  // namespace ttf::bus::socketcan
