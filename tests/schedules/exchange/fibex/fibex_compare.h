// Compares two clusters in everything that FIBEX can express: timing, controllers, slots, PDUs and signals.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "schedules/file/parameter_table.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange::fibex {

// Every difference on a line; "" if they are equal.
class FibexDifference {
 public:
  static std::string of(const model::Cluster& a, const model::Cluster& b) {
    FibexDifference d;
    d.value("name", a.name, b.name);
    d.value("topology", static_cast<int>(a.topology), static_cast<int>(b.topology));
    d.value("guardian", a.guardian, b.guardian);
    d.parameters("flexray", a.flexray, b.flexray, file::kGlobalIntegers, file::kGlobalScaled);
    d.nodes(nodes_of(a), nodes_of(b));
    d.pdus(a.pdus, b.pdus);
    d.frames(a, b);
    return d.text_;
  }

 private:
  template <class T> void value(const std::string& what, const T& a, const T& b) {
    if (!(a == b)) text_ += fmt::format("{}: {} and {}\n", what, a, b);
  }

  template <class Parameters, class Integers, class Scaled>
  void parameters(const std::string& what, const Parameters& a, const Parameters& b, const Integers& integers,
                  const Scaled& scaled) {
    for (const auto& p : integers) value(fmt::format("{}.{}", what, p.name), a.*p.member, b.*p.member);
    for (const auto& p : scaled) value(fmt::format("{}.{}", what, p.name), a.*p.member, b.*p.member);
  }

  // Nodes off FlexRay are not in FIBEX.
  static std::vector<const model::Node*> nodes_of(const model::Cluster& cluster) {
    std::vector<const model::Node*> nodes;
    for (const model::Node& node : cluster.nodes)
      if (node.flexray) nodes.push_back(&node);
    return nodes;
  }

  void nodes(const std::vector<const model::Node*>& a, const std::vector<const model::Node*>& b) {
    value("nodes", a.size(), b.size());
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
      value("node", a[i]->name, b[i]->name);
      value(a[i]->name + " microtick", a[i]->microtick_ps, b[i]->microtick_ps);
      parameters(a[i]->name, *a[i]->flexray, *b[i]->flexray, file::kNodeIntegers, file::kNodeScaled);
      value(a[i]->name + " channels", channels_text(a[i]->flexray->pChannels), channels_text(b[i]->flexray->pChannels));
      value(a[i]->name + " wake-up", static_cast<int>(a[i]->flexray->pWakeupChannel),
            static_cast<int>(b[i]->flexray->pWakeupChannel));
      for (const auto& p : file::kNodeFlags)
        value(fmt::format("{}.{}", a[i]->name, p.name), (*a[i]->flexray).*p.member, (*b[i]->flexray).*p.member);
    }
  }

  void signals(const std::string& what, const std::vector<model::Signal>& a, const std::vector<model::Signal>& b) {
    value(what, a.size(), b.size());
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
      const std::string name = fmt::format("{}.{}", what, a[i].name);
      value(name, a[i].name, b[i].name);
      value(name + " unit", a[i].unit, b[i].unit);
      value(name + " bits", a[i].bits, b[i].bits);
      value(name + " low", a[i].low, b[i].low);
      value(name + " high", a[i].high, b[i].high);
      value(name + " resolution", a[i].resolution, b[i].resolution);
      value(name + " offset", a[i].bit_offset, b[i].bit_offset);
    }
  }

  void pdus(const std::vector<model::PduLayout>& a, const std::vector<model::PduLayout>& b) {
    value("pdus", a.size(), b.size());
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
      value("pdu", a[i].name, b[i].name);
      value(a[i].name + " bytes", a[i].fragment_bytes, b[i].fragment_bytes);
      value(a[i].name + " elements", a[i].max_elements, b[i].max_elements);
      value(a[i].name + " elements per fragment", a[i].elements_per_fragment, b[i].elements_per_fragment);
      value(a[i].name + " header bits", a[i].header_bits, b[i].header_bits);
      value(a[i].name + " element bits", a[i].element_bits, b[i].element_bits);
      signals(a[i].name + " header", a[i].header, b[i].header);
      signals(a[i].name + " element", a[i].element, b[i].element);
    }
  }

  static std::string frame_text(const model::Cluster& cluster, const model::FrameSlot& frame) {
    return fmt::format(
        "slot {} channels {} cycle {} of {} by {}{}{}: {} {}", frame.slot, static_cast<int>(frame.channels),
        frame.base_cycle, frame.repetition, cluster.node(frame.sender).name,
        frame.network_management ? " with vector" : "",
        frame.message_id ? fmt::format(" as message {}", *frame.message_id) : "",
        frame.pdu == kNoPdu ? fmt::format("status of {} bytes", frame.payload_bytes) : cluster.pdu(frame.pdu).name,
        frame.fragment);
  }

  // Frames of one slot and cycle, channel A first.
  static std::vector<model::FrameSlot> ordered(std::vector<model::FrameSlot> frames) {
    std::stable_sort(frames.begin(), frames.end(), [](const model::FrameSlot& x, const model::FrameSlot& y) {
      return std::tuple{x.slot, x.base_cycle, x.repetition, static_cast<int>(x.channels)} <
             std::tuple{y.slot, y.base_cycle, y.repetition, static_cast<int>(y.channels)};
    });
    return frames;
  }

  void frames(const model::Cluster& a, const model::Cluster& b) {
    value("frames", a.frames.size(), b.frames.size());
    const std::vector<model::FrameSlot> of_a = ordered(a.frames), of_b = ordered(b.frames);
    for (std::size_t i = 0; i < of_a.size() && i < of_b.size(); ++i)
      value("frame", frame_text(a, of_a[i]), frame_text(b, of_b[i]));
  }

  std::string text_;
};

}  // namespace ttf::schedules::exchange::fibex
