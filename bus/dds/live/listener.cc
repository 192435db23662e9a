#include "bus/dds/live/listener.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <span>

#include "bus/wire/flexray_frame.h"
#include "core/check.h"

namespace ttf::bus::dds::live {
namespace {

Identifiers received_on(ports::Line line, const ports::ReceivedIdentifiers& identifiers) {
  Identifiers received;
  const auto add = [&](auto identifier) { received.set(static_cast<std::size_t>(identifier)); };
  if (line < ports::line_of_can(0)) {
    for (const int slot : identifiers.slots) add(slot);
  } else {
    TTF_CHECK(line - ports::line_of_can(0) < identifiers.can.size(), "line {}", line);
    for (const std::uint32_t identifier : identifiers.can[line - ports::line_of_can(0)]) add(identifier);
  }
  return received;
}

}  // namespace

DdsListener::DdsListener(const common::Session& session, const std::vector<LiveLinePlan>& lines,
                         const ports::ReceivedIdentifiers& identifiers)
    : participant_(common::validate(session).domain, session.lease) {
  for (const LiveLinePlan& plan : lines) {
    const Identifiers received = received_on(plan.line, identifiers);
    if (received.none()) continue;
    auto reception = std::make_unique<Reception>(participant_, session.name, plan.topic,
                                                 Reception::Setting{plan.line, plan.nodes, kNoNode, received},
                                                 Delivery::kBestEffort);
    lines_.push_back({plan, std::move(reception)});
  }
}

std::optional<ports::ReceivedFrame> DdsListener::receive() {
  if (follow_up_) {
    const ports::ReceivedFrame received = *follow_up_;
    follow_up_.reset();
    return received;
  }
  for (const OnLine& line : lines_) {
    if (!line.reception->queue().pop(last_)) continue;
    const ports::LiveArrival& arrival = last_.arrival;
    ports::ReceivedFrame received;
    if (arrival.kind == ports::LiveArrival::Kind::kFlexRay) {
      received = on_channel();
    } else {
      received.form = ports::ReceivedFrame::Form::kCan;
      received.can = arrival.can;
      received.can.data = std::span<const std::byte>(last_.bytes).first(last_.size);
    }
    if (last_.malformed) received.form = ports::ReceivedFrame::Form::kMalformed;
    received.line = line.plan.line;
    received.at = arrival.at;
    if (follow_up_) follow_up_->line = received.line;
    return received;
  }
  return std::nullopt;
}

ports::ReceivedFrame DdsListener::on_channel() {
  const ports::LiveArrival& arrival = last_.arrival;
  ports::ReceivedFrame received;
  received.slot = arrival.signal.slot;
  received.bytes = std::span<const std::byte>(last_.bytes).first(last_.size);
  if (!arrival.late) return received;
  follow_up_ = received;
  follow_up_->form = ports::ReceivedFrame::Form::kFollowUp;
  follow_up_->bytes = {};
  follow_up_->at = arrival.at;
  // The count as written: a judge compares it with that of the frame.
  follow_up_->cycle_counter = static_cast<std::uint8_t>(last_.bytes[wire::kHeaderBytes - 1] & std::byte{0x3F});
  follow_up_->late = *arrival.late;
  return received;
}

std::uint64_t DdsListener::lost() const {
  std::uint64_t lost = 0;
  for (const OnLine& line : lines_) lost += line.reception->lost();
  return lost;
}

const std::string& DdsListener::failure() const {
  for (const OnLine& line : lines_)
    if (const std::int32_t error = line.reception->error(); failure_.empty() && error != 0)
      failure_ = fmt::format("DDS: cannot read from {}: {}", line.plan.topic, dds_strretcode(-error));
  return failure_;
}

}  // namespace ttf::bus::dds::live
