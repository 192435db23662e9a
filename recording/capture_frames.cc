#include "recording/capture_frames.h"

#include <fmt/format.h>

#include <algorithm>

namespace ttf::recording {
namespace {

std::string name_or_number(const std::vector<std::string>& names, std::size_t index, const char* what) {
  return index < names.size() && !names[index].empty() ? names[index] : fmt::format("{} {}", what, index);
}

}  // namespace

std::string LogNames::node(NodeId id) const { return name_or_number(manifest_.node_names, index_of(id), "node"); }
std::string LogNames::pdu(PduId id) const { return name_or_number(manifest_.pdu_names, index_of(id), "pdu"); }
std::string LogNames::can_bus(std::size_t index) const { return name_or_number(manifest_.can_bus_names, index, "can"); }

std::string LogNames::measurement(const LoggedFrame& frame) const {
  if (frame.null_frame || frame.sensor == kNoSensor) return "";
  return fmt::format("{} {}", name_or_number(manifest_.sensor_names, index_of(frame.sensor), "sensor"), frame.sequence);
}

void FrameCollector::on(const records::SlotFrameSent& record) {
  LoggedFrame frame;
  frame.time_ns = record.stamp.true_time.ns;
  frame.flexray = true;
  frame.channel = record.channel == 0 ? 0 : 1;
  frame.id = record.slot;
  frame.cycle = record.cycle;
  frame.null_frame = record.null_frame;
  frame.sender = record.stamp.node;
  frame.pdu = record.pdu;
  frame.sensor = record.sensor;
  frame.sequence = record.sequence;
  frame.fragment = record.fragment;
  keep(frame, record.bytes);
}

void FrameCollector::on(const records::CanFrameSent& record) {
  LoggedFrame frame;
  frame.time_ns = record.end.true_time.ns;
  frame.channel = record.bus;
  frame.id = record.identifier;
  frame.flexible_data_rate = record.flexible_data_rate;
  frame.sender = record.end.node;
  frame.pdu = record.pdu;
  frame.sensor = record.sensor;
  frame.sequence = record.sequence;
  frame.fragment = record.fragment;
  keep(frame, record.data);
}

void FrameCollector::keep(LoggedFrame frame, std::span<const std::byte> data) {
  frame.data_begin = bytes_.size();
  frame.data_size = data.size();
  bytes_.insert(bytes_.end(), data.begin(), data.end());
  frames_.push_back(frame);
}

std::vector<LoggedFrame> FrameCollector::in_order() const {
  std::vector<LoggedFrame> frames = frames_;
  std::stable_sort(frames.begin(), frames.end(),
                   [](const LoggedFrame& a, const LoggedFrame& b) { return a.time_ns < b.time_ns; });
  return frames;
}

}  // namespace ttf::recording
