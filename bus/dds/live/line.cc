#include "bus/dds/live/line.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "bus/dds/common/host_identity.h"
#include "bus/dds/common/qos.h"
#include "bus/dds/live/endpoints.h"
#include "bus/dds/live/live_sample.h"
#include "bus/dds/live/sample_check.h"
#include "core/check.h"

namespace ttf::bus::dds::live {

struct LiveLine::Sample {
  ttf_LiveSample fields{};
};

LiveLine::LiveLine(const common::Participant& participant, const std::string& session, NodeId self,
                   const LiveLinePlan& plan, Delivery delivery)
    : line_(plan.line), topic_(plan.topic), self_(self), nodes_(plan.nodes), not_awaited_(plan.not_awaited),
      out_(std::make_unique<Sample>()),
      reception_(participant, session, plan.topic, {plan.line, plan.nodes, self, {}}, delivery) {
  out_->fields.sender = static_cast<std::uint8_t>(self);
  out_->fields.host = common::host_identity();
  out_->fields.incarnation = static_cast<std::uint64_t>(ports::host_now().ns);
  const common::Handle parent = participant.handle();
  const common::Qos qos = live_qualities(delivery, self);
  const common::Qos within = common::partition(session);
  const common::Handle topic = common::checked(
      dds_create_topic(parent, &ttf_LiveSample_desc, topic_.c_str(), nullptr, nullptr), "cannot make topic " + topic_);
  const common::Handle publisher =
      common::checked(dds_create_publisher(parent, within.get(), nullptr), "cannot make a publisher");
  writer_ =
      common::checked(dds_create_writer(publisher, topic, qos.get(), nullptr), "cannot make a writer of " + topic_);
}

LiveLine::~LiveLine() = default;

ports::LiveStatus LiveLine::send(const ports::LiveSignal& signal, ports::MachineTime due) {
  ttf_LiveSample& sample = out_->fields;
  sample.kind = static_cast<std::uint8_t>(signal.signal);
  sample.slot = static_cast<std::uint16_t>(signal.slot);
  sample.duration = signal.duration.ns;
  sample.tells_late = signal.states_late ? 1 : 0;
  return write(signal.bytes, due);
}

ports::LiveStatus LiveLine::send(const ports::CanFrame& frame) {
  out_->fields.kind = frame.flexible_data_rate ? kFastCan : kClassicCan;
  out_->fields.identifier = frame.identifier;
  out_->fields.tells_late = 0;
  return write(frame.data, {});
}

ports::LiveStatus LiveLine::write(std::span<const std::byte> bytes, ports::MachineTime due) {
  ttf_LiveSample& sample = out_->fields;
  sample.number = next_number_;
  sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(bytes.size());
  // The buffer is only read; C cannot declare that here.
  sample.bytes._buffer = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(bytes.data()));
  TTF_CHECK(well_formed(sample, line_), "line {}: kind {}, slot {}, identifier {}, {} bytes, {} ns", line_, sample.kind,
            sample.slot, sample.identifier, bytes.size(), sample.duration);
  sample.sent = ports::host_now().ns;
  sample.late = sample.tells_late == 1 ? sample.sent - due.ns : 0;
  const auto result = dds_write(writer_, &sample);
  if (result == DDS_RETCODE_TIMEOUT || result == DDS_RETCODE_OUT_OF_RESOURCES) return ports::LiveStatus::kNoRoom;
  if (result < 0) {
    write_error_ = result;
    return ports::LiveStatus::kFailed;
  }
  ++next_number_;
  return ports::LiveStatus::kDone;
}

std::string LiveLine::failure() const {
  if (write_error_ != 0) return fmt::format("DDS: cannot write on {}: {}", topic_, dds_strretcode(-write_error_));
  const std::int32_t error = reception_.error();
  return error == 0 ? std::string() : fmt::format("DDS: cannot read from {}: {}", topic_, dds_strretcode(-error));
}

std::vector<NodeId> LiveLine::missing_senders() const { return all_but(reception_.senders()); }

std::vector<NodeId> LiveLine::deaf() const {
  std::vector<dds_instance_handle_t> matched(kMostEndpoints);
  const auto count = common::checked(dds_get_matched_subscriptions(writer_, matched.data(), matched.size()),
                                     "cannot list the nodes on " + topic_);
  matched.resize(std::min(matched.size(), static_cast<std::size_t>(count)));
  return all_but(owners(writer_, matched, dds_get_matched_subscription_data));
}

std::vector<NodeId> LiveLine::all_but(const std::vector<NodeId>& found) const {
  const auto among = [](const std::vector<NodeId>& list, NodeId node) {
    return std::find(list.begin(), list.end(), node) != list.end();
  };
  std::vector<NodeId> missing;
  for (const NodeId node : nodes_)
    if (node != self_ && !among(not_awaited_, node) && !among(found, node)) missing.push_back(node);
  return missing;
}

std::string live_topic(schedules::model::Channel channel) {
  return channel == schedules::model::Channel::kA ? "ttf/flexray/A" : "ttf/flexray/B";
}

std::string live_can_topic(const std::string& name) {
  const auto is_hexadecimal = [&name](std::size_t at) {
    return at < name.size() && ((name[at] >= '0' && name[at] <= '9') || (name[at] >= 'A' && name[at] <= 'F'));
  };
  std::string topic = "ttf/can/";
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto letter = static_cast<unsigned char>(name[i]);
    const bool mistaken = letter == '_' && is_hexadecimal(i + 1) && is_hexadecimal(i + 2);
    if (letter < 128 && (std::isalnum(letter) != 0 || letter == '_') && !mistaken)
      topic += name[i];
    else
      topic += fmt::format("_{:02X}", letter);
  }
  return topic;
}

}  // namespace ttf::bus::dds::live
