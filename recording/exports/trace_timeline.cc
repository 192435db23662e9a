#include "recording/exports/trace_timeline.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/exports/perfetto.pb.h"

namespace ttf::recording::exports {
namespace {

namespace pb = ttfusion::perfetto;

constexpr Duration kLongestSlice = Duration::milliseconds(10'000);
constexpr std::size_t kMostLanesBeside = 8;
constexpr std::uint32_t kOnlySequence = 1, kSequenceBegins = 1;

// Encodes a packet of a trace: the field's key, the length, the packet.
std::string as_packet(ttfusion::perfetto::TracePacket& packet) {
  packet.set_trusted_packet_sequence_id(kOnlySequence);
  std::string bytes(1, '\x0a');
  std::size_t size = packet.ByteSizeLong();
  for (; size >= 0x80; size >>= 7) bytes += static_cast<char>(0x80 | (size & 0x7f));
  bytes += static_cast<char>(size);
  packet.AppendToString(&bytes);
  return bytes;
}

}  // namespace

std::uint64_t TraceTimeline::group_track(const std::string& group) {
  const auto [entry, first] = groups_.try_emplace(group, tracks_ + 1);
  if (first) {
    ttfusion::perfetto::TracePacket packet;
    if (tracks_ == 0) packet.set_sequence_flags(kSequenceBegins);
    auto& track = *packet.mutable_track_descriptor();
    track.set_uuid(++tracks_);
    track.mutable_process()->set_pid(static_cast<std::int32_t>(groups_.size()));
    track.mutable_process()->set_process_name(group);
    write_(as_packet(packet));
  }
  return entry->second;
}

TraceTimeline::Lane& TraceTimeline::lane_of(const std::string& group, const std::string& lane, bool counts,
                                            std::size_t beside) {
  const std::uint64_t parent = group_track(group);
  const auto [entry, first] = lanes_.try_emplace({group, lane, beside});
  if (first) {
    entry->second.track = ++tracks_;
    ttfusion::perfetto::TracePacket packet;
    auto& track = *packet.mutable_track_descriptor();
    track.set_uuid(tracks_);
    track.set_parent_uuid(parent);
    track.set_name(beside == 0 ? lane : fmt::format("{} ({})", lane, beside + 1));
    if (counts) track.mutable_counter();
    write_(as_packet(packet));
  }
  return entry->second;
}

TraceMark TraceTimeline::put(TrueTime at, Event event) {
  const TraceMark mark{std::max(at, written_), ++serials_};
  last_ = std::max(last_, mark.at);
  waiting_.emplace(Place{mark.at, event.what, mark.serial}, std::move(event));
  return mark;
}

TraceMark TraceTimeline::slice(const std::string& group, const std::string& lane, TrueTime begin, TrueTime end,
                               std::string name, std::vector<TraceNote> notes) {
  begin = std::max(begin, written_);
  if (begin >= end || end - begin > kLongestSlice)
    return instant(group, lane, begin, std::move(name), std::move(notes));
  for (std::size_t beside = 0; beside < kMostLanesBeside; ++beside) {
    Lane& free = lane_of(group, lane, false, beside);
    if (free.busy_until > begin) continue;
    free.busy_until = end;
    ++counts_.slices;
    put(end, {What::kEnd, free.track, 0, "", {}});
    return put(begin, {What::kBegin, free.track, 0, std::move(name), std::move(notes)});
  }
  return instant(group, lane, begin, std::move(name), std::move(notes));
}

TraceMark TraceTimeline::instant(const std::string& group, const std::string& lane, TrueTime at, std::string name,
                                 std::vector<TraceNote> notes) {
  ++counts_.instants;
  return put(at, {What::kInstant, lane_of(group, lane, false).track, 0, std::move(name), std::move(notes)});
}

void TraceTimeline::counter(const std::string& group, const std::string& lane, TrueTime at, double value) {
  ++counts_.counters;
  put(at, {What::kCounter, lane_of(group, lane, true).track, value, "", {}});
}

void TraceTimeline::begin(const std::string& group, const std::string& lane, TrueTime at, std::string name,
                          std::vector<TraceNote> notes) {
  Lane& own = lane_of(group, lane, false);
  if (own.open) return;
  own.open = true;
  ++counts_.slices;
  put(at, {What::kBegin, own.track, 0, std::move(name), std::move(notes)});
}

void TraceTimeline::end(const std::string& group, const std::string& lane, TrueTime at) {
  Lane& own = lane_of(group, lane, false);
  if (!own.open) return;
  own.open = false;
  // One nanosecond later, as the begin may be at this very instant.
  put(at + Duration{1}, {What::kEnd, own.track, 0, "", {}});
}

void TraceTimeline::note(const TraceMark& mark, TraceNote note) {
  for (const What what : {What::kBegin, What::kInstant})
    if (const auto found = waiting_.find({mark.at, what, mark.serial}); found != waiting_.end())
      found->second.notes.push_back(std::move(note));
}

void TraceTimeline::write_before(TrueTime at) {
  while (!waiting_.empty() && std::get<TrueTime>(waiting_.begin()->first) < at) {
    write(waiting_.begin()->first, waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
  written_ = std::max(written_, at);
}

void TraceTimeline::finish() {
  for (auto& [name, lane] : lanes_) {
    if (lane.open) put(last_ + Duration{1}, {What::kEnd, lane.track, 0, "", {}});
    lane.open = false;
  }
  write_before(kNever<TrueTime>);
}

void TraceTimeline::write(const Place& place, const Event& event) {
  const auto [at, what, serial] = place;
  ttfusion::perfetto::TracePacket packet;
  packet.set_timestamp(static_cast<std::uint64_t>(at.ns));
  auto& out = *packet.mutable_track_event();
  out.set_track_uuid(event.track);
  switch (what) {
    case What::kEnd: out.set_type(ttfusion::perfetto::TrackEvent::TYPE_SLICE_END); break;
    case What::kCounter:
      out.set_type(ttfusion::perfetto::TrackEvent::TYPE_COUNTER);
      out.set_double_counter_value(event.value);
      break;
    case What::kInstant: out.set_type(ttfusion::perfetto::TrackEvent::TYPE_INSTANT); break;
    case What::kBegin: out.set_type(ttfusion::perfetto::TrackEvent::TYPE_SLICE_BEGIN); break;
  }
  if (what == What::kInstant || what == What::kBegin) {
    out.set_name(event.name);
    for (const TraceNote& note : event.notes) {
      auto& annotation = *out.add_debug_annotations();
      annotation.set_name(note.name);
      if (const auto* number = std::get_if<std::int64_t>(&note.value))
        annotation.set_int_value(*number);
      else
        annotation.set_string_value(std::get<std::string>(note.value));
    }
    for (const TraceFlow& flow : flows_of_({at, serial})) {
      if (flow.ends)
        out.add_terminating_flow_ids(flow.id), ++counts_.flows;
      else
        out.add_flow_ids(flow.id);
    }
  }
  write_(as_packet(packet));
}

}  // namespace ttf::recording::exports
