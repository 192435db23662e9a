// A Perfetto trace as its readers see it: its problems and its contents.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "recording/exports/perfetto.pb.h"

namespace ttf::recording::exports {

struct PerfettoTrace {
  struct Slice {
    std::string group, lane, name;
    std::uint64_t begin = 0, end = 0;  // the same for an instant
    std::map<std::string, std::string> notes;
  };
  struct Value {
    std::string group, counter;
    std::uint64_t at = 0;
    double value = 0;
  };
  std::vector<Slice> slices;  // in the order of their begins
  std::vector<Value> values;
  std::map<std::uint64_t, std::vector<std::size_t>> flows;  // through which slices, in order
  std::vector<std::string> problems;                        // the trace's as a trace

  explicit PerfettoTrace(std::string_view bytes) {
    ttfusion::perfetto::Trace trace;
    if (!trace.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) problems.push_back("is no trace");
    for (const auto& packet : trace.packet()) {
      if (packet.trusted_packet_sequence_id() != 1) problems.push_back("a packet of no sequence");
      if (packet.has_track_descriptor()) describe(packet.track_descriptor());
      if (packet.has_track_event()) event(packet);
    }
    for (const auto& [track, open] : open_)
      if (!open.empty())
        problems.push_back(fmt::format("{} of {} never ends", slices[open.back()].name, tracks_[track].name()));
    for (const auto& [flow, through] : flows) {
      if (through.size() < 2) problems.push_back(fmt::format("flow {} joins nothing", flow));
      if (!ended_[flow]) problems.push_back(fmt::format("flow {} never ends", flow));
    }
  }

  // "laser_can: laser_scan 3" of every slice that a flow passes.
  std::vector<std::string> way(std::uint64_t flow) const {
    std::vector<std::string> stops;
    for (const std::size_t slice : flows.at(flow)) stops.push_back(slices[slice].lane + ": " + slices[slice].name);
    return stops;
  }
  std::size_t count(std::string_view lane) const {
    std::size_t there = 0;
    for (const Slice& slice : slices) there += slice.lane == lane ? 1u : 0u;
    return there;
  }

 private:
  using Packet = ttfusion::perfetto::TracePacket;
  using Track = ttfusion::perfetto::TrackDescriptor;
  using Event = ttfusion::perfetto::TrackEvent;

  void describe(const Track& track) {
    if (track.uuid() == 0 || !tracks_.try_emplace(track.uuid(), track).second)
      problems.push_back(fmt::format("track {} is described twice", track.uuid()));
    if (!track.has_process() && !tracks_.contains(track.parent_uuid()))
      problems.push_back(fmt::format("{} is of no group", track.name()));
  }

  void event(const Packet& packet) {
    const Event& event = packet.track_event();
    if (packet.timestamp() < now_) problems.push_back(fmt::format("{} comes after {}", packet.timestamp(), now_));
    now_ = packet.timestamp();
    const auto track = tracks_.find(event.track_uuid());
    if (track == tracks_.end()) {
      problems.push_back(fmt::format("track {} is not described", event.track_uuid()));
      return;
    }
    const std::string group = tracks_[track->second.parent_uuid()].process().process_name(),
                      lane = track->second.name();
    auto& open = open_[event.track_uuid()];
    if ((event.type() == Event::TYPE_COUNTER) != track->second.has_counter())
      problems.push_back(lane + ": counts and does not");
    switch (event.type()) {
      case Event::TYPE_SLICE_BEGIN:
        if (!open.empty()) problems.push_back(fmt::format("{}: {} begins within another", lane, event.name()));
        open.push_back(slices.size());
        break;
      case Event::TYPE_SLICE_END:
        if (open.empty()) {
          problems.push_back(lane + ": what never began ends");
        } else {
          if (slices[open.back()].begin >= now_) problems.push_back(lane + ": a slice without length");
          slices[open.back()].end = now_;
          open.pop_back();
        }
        return;
      case Event::TYPE_INSTANT: break;
      case Event::TYPE_COUNTER: values.push_back({group, lane, now_, event.double_counter_value()}); return;
      case Event::TYPE_UNSPECIFIED: problems.push_back(lane + ": an event of no type"); return;
    }
    Slice slice{group, lane, event.name(), now_, now_, {}};
    for (const auto& note : event.debug_annotations())
      slice.notes[note.name()] = note.has_int_value() ? std::to_string(note.int_value()) : note.string_value();
    for (const std::uint64_t flow : event.flow_ids()) pass(flow, false);
    for (const std::uint64_t flow : event.terminating_flow_ids()) pass(flow, true);
    slices.push_back(std::move(slice));
  }

  void pass(std::uint64_t flow, bool ends) {
    if (ended_[flow]) problems.push_back(fmt::format("flow {} goes on after its end", flow));
    ended_[flow] = ends;
    flows[flow].push_back(slices.size());
  }

  std::map<std::uint64_t, Track> tracks_;
  std::map<std::uint64_t, std::vector<std::size_t>> open_;
  std::map<std::uint64_t, bool> ended_;
  std::uint64_t now_ = 0;
};

}  // namespace ttf::recording::exports
