#include "bus/dds/live/listener.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <span>

#include "bus/wire/flexray_frame.h"
#include "core/check.h"

namespace ttf::bus::dds::live {
namespace {

Identifiers heard_on(ports::Line line, const ports::HeardIdentifiers& identifiers) {
  Identifiers heard;
  const auto add = [&](auto identifier) { heard.set(static_cast<std::size_t>(identifier)); };
  if (line < ports::line_of_can(0)) {
    for (const int slot : identifiers.slots) add(slot);
  } else {
    TTF_CHECK(line - ports::line_of_can(0) < identifiers.can.size(), "line {}", line);
    for (const std::uint32_t identifier : identifiers.can[line - ports::line_of_can(0)]) add(identifier);
  }
  return heard;
}

}  // namespace

DdsListener::DdsListener(const common::Session& session, const std::vector<LiveLinePlan>& lines,
                         const ports::HeardIdentifiers& identifiers)
    : participant_(common::validate(session).domain, session.lease) {
  for (const LiveLinePlan& plan : lines) {
    const Identifiers heard = heard_on(plan.line, identifiers);
    if (heard.none()) continue;
    auto reception =
        std::make_unique<Reception>(participant_, session.name, plan.topic,
                                    Reception::Setting{plan.line, plan.nodes, kNoNode, heard}, Delivery::kBestEffort);
    lines_.push_back({plan, std::move(reception)});
  }
}

std::optional<ports::Heard> DdsListener::hear() {
  if (follow_up_) {
    const ports::Heard heard = *follow_up_;
    follow_up_.reset();
    return heard;
  }
  for (const OnLine& line : lines_) {
    if (!line.reception->queue().pop(last_)) continue;
    const ports::LiveArrival& arrival = last_.arrival;
    ports::Heard heard;
    if (arrival.kind == ports::LiveArrival::Kind::kFlexRay) {
      heard = on_channel();
    } else {
      heard.form = ports::Heard::Form::kCan;
      heard.can = arrival.can;
      heard.can.data = std::span<const std::byte>(last_.bytes).first(last_.size);
    }
    if (last_.malformed) heard.form = ports::Heard::Form::kMalformed;
    heard.line = line.plan.line;
    heard.at = arrival.at;
    if (follow_up_) follow_up_->line = heard.line;
    return heard;
  }
  return std::nullopt;
}

ports::Heard DdsListener::on_channel() {
  const ports::LiveArrival& arrival = last_.arrival;
  ports::Heard heard;
  heard.slot = arrival.signal.slot;
  heard.bytes = std::span<const std::byte>(last_.bytes).first(last_.size);
  if (!arrival.late) return heard;
  follow_up_ = heard;
  follow_up_->form = ports::Heard::Form::kFollowUp;
  follow_up_->bytes = {};
  follow_up_->at = arrival.at;
  // The count as written: a judge compares it with that of the frame.
  follow_up_->cycle_counter = static_cast<std::uint8_t>(last_.bytes[wire::kHeaderBytes - 1] & std::byte{0x3F});
  follow_up_->late = *arrival.late;
  return heard;
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
