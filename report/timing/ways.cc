#include "report/timing/ways.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "recording/exports/measurement_ways.h"

namespace ttf::report::timing {
namespace {

using recording::exports::MeasurementWays;
using recording::exports::WayMark;
using Deed = MeasurementWays::Deed;

// The stay of a list in one lane.
struct Stay {
  LaneKey lane;
  TrueTime in, out;
};

// Feeds the window's records to the follower in the order of time. A mark's serial is the index of its stay.
class Followed {
 public:
  explicit Followed(const TimingData& data) : data_(data) {
    for (const Event& event : events()) {
      follower_.advance(event.at, [](const MeasurementWays::Act&, const WayMark&) {});
      report(event);
    }
    follower_.advance(TrueTime{std::numeric_limits<std::int64_t>::max()},
                      [](const MeasurementWays::Act&, const WayMark&) {});
    follower_.finish();
  }

  const Stay& stay(const WayMark& mark) const { return stays_[mark.serial]; }
  // Returns the ways in the order of the records.
  const std::vector<MeasurementWays::Way>& ways() const { return ways_; }
  const std::vector<MeasurementWays::Image>& images() const { return images_; }

 private:
  enum class What : std::uint8_t { kSlotFrame, kCanFrame, kHop, kMeasured, kFused, kImage, kUse, kExecution };
  struct Event {
    TrueTime at;
    What what;          // causes before effects, as in merged logs (recording/merge/record_place.h)
    std::size_t about;  // the node; for frames on FlexRay the channel
    std::size_t index;
    auto operator<=>(const Event&) const = default;
  };

  std::vector<Event> events() const {
    std::vector<Event> events;
    const auto add = [&](What what, const auto& list, auto place) {
      for (std::size_t i = 0; i < list.size(); ++i) {
        const auto [at, about] = place(list[i]);
        events.push_back({at, what, about, i});
      }
    };
    const auto stamped = [](const auto& one) { return std::pair(one.stamp.true_time, index_of(one.stamp.node)); };
    using Data = TimingData;
    add(What::kSlotFrame, data_.slot_frames,
        [](const Data::SlotFrame& one) { return std::pair(one.start, std::size_t{one.channel}); });
    add(What::kCanFrame, data_.can_frames, [](const Data::CanFrame& one) { return std::pair(one.end, one.bus); });
    add(What::kHop, data_.hops, stamped);
    add(What::kMeasured, data_.measurements,
        [](const Data::Measurement& one) { return std::pair(one.at, index_of(one.id.sensor)); });
    add(What::kFused, data_.fused, stamped);
    add(What::kImage, data_.images, stamped);
    add(What::kUse, data_.uses, stamped);
    add(What::kExecution, data_.executions, [](const recording::records::TaskRun& one) {
      return std::pair(one.start.true_time, index_of(one.start.node));
    });
    std::ranges::sort(events);
    return events;
  }

  WayMark mark(const Stay& stay) {
    stays_.push_back(stay);
    return {stay.in, stays_.size() - 1};
  }

  void report(const Event& event) {
    using Kind = LaneKey::Kind;
    switch (event.what) {
      case What::kSlotFrame: {
        const auto& f = data_.slot_frames[event.index];
        if (!f.null_frame && f.pdu != kNoPdu)
          follower_.frame(true, f.channel, f.node, f.sensor, f.sequence, f.fragment,
                          mark({{Kind::kChannel, f.channel, 0}, f.start, f.end}));
        break;
      }
      case What::kCanFrame: {
        const auto& f = data_.can_frames[event.index];
        follower_.frame(false, static_cast<std::uint8_t>(f.bus), f.node, f.sensor, f.sequence, f.fragment,
                        mark({{Kind::kCan, f.bus, 0}, f.start, f.end}));
        break;
      }
      case What::kHop: report(data_.hops[event.index]); break;
      case What::kMeasured: {
        const auto& m = data_.measurements[event.index];
        records_.push_back(event.index);
        follower_.measured(m.id, kNoNode, mark({{Kind::kSensor, index_of(m.id.sensor), 0}, m.at, m.at}));
        break;
      }
      case What::kFused: report(data_.fused[event.index]); break;
      case What::kImage: {
        const auto& i = data_.images[event.index];
        follower_.act({Deed::kImage, i.stamp.true_time, i.stamp.node, i.newest, i.sequence});
        break;
      }
      case What::kUse: {
        const auto& u = data_.uses[event.index];
        if (!u.stale) follower_.act({Deed::kUsed, u.stamp.true_time, u.stamp.node, {}, u.image});
        break;
      }
      case What::kExecution: {
        const auto& r = data_.executions[event.index];
        const TrueTime start = r.start.true_time, end = r.end.true_time;
        follower_.executed(r.start.node, start, end, mark({{Kind::kTask, index_of(r.start.node), r.task}, start, end}));
        break;
      }
    }
  }
  void report(const recording::records::ListHop& h) {
    if (h.sensor == kNoSensor) {
      if (h.hop == recording::records::Hop::kRead) follower_.read(h.stamp.node, h.pdu, h.sequence);
      if (h.hop == recording::records::Hop::kWritten) follower_.wrote(h.stamp.node, h.pdu);
      return;
    }
    const auto act = [&](Deed deed) {
      follower_.act({deed, h.stamp.true_time, h.stamp.node, {{h.sensor, h.sequence}}});
    };
    switch (h.hop) {
      case recording::records::Hop::kRead: act(Deed::kRead); break;
      case recording::records::Hop::kWritten: act(Deed::kWritten); break;
      case recording::records::Hop::kTorn:
      case recording::records::Hop::kOverwritten:
      case recording::records::Hop::kDiscarded: act(Deed::kLost); break;
      case recording::records::Hop::kSent:
      case recording::records::Hop::kReceived:
      case recording::records::Hop::kStale: break;
    }
  }
  void report(const recording::records::ListFused& f) {
    const auto act = [&](Deed deed) { follower_.act({deed, f.stamp.true_time, f.stamp.node, {f.id}}); };
    switch (f.disposition) {
      case recording::records::Disposition::kFused:
      case recording::records::Disposition::kFusedLate: act(Deed::kFused); break;
      case recording::records::Disposition::kHeld: act(Deed::kHeld); break;
      case recording::records::Disposition::kDroppedTooOld:
      case recording::records::Disposition::kDuplicate: act(Deed::kRefused); break;
    }
  }

  const TimingData& data_;
  std::vector<Stay> stays_;
  std::vector<std::size_t> records_;  // the measurements', by number - 1
  std::vector<MeasurementWays::Way> ways_ = std::vector<MeasurementWays::Way>(data_.measurements.size());
  std::vector<MeasurementWays::Image> images_;
  MeasurementWays follower_{{[this](const MeasurementWays::Way& way) { ways_[records_[way.number - 1]] = way; },
                             [this](const MeasurementWays::Image& image) { images_.push_back(image); }}};
};

// Returns the lists that reached the fusion node after a younger one.
std::set<std::pair<MeasurementId, TrueTime>> out_of_sequence(const TimingData& data) {
  std::set<std::pair<MeasurementId, TrueTime>> late;
  std::map<MeasurementId, TrueTime> seen;
  std::optional<GlobalTime> newest;
  std::size_t i = 0;
  while (i < data.fused.size()) {
    // Lists of one fusion instant arrive together: they are compared with earlier instants only.
    std::optional<GlobalTime> newest_here = newest;
    const TrueTime at = data.fused[i].stamp.true_time;
    for (; i < data.fused.size() && data.fused[i].stamp.true_time == at; ++i) {
      const auto& f = data.fused[i];
      const auto [entry, first] = seen.try_emplace(f.id, at);
      if (!first && at - entry->second < MeasurementWays::kLongestWay &&
          f.disposition != recording::records::Disposition::kFusedLate)
        continue;
      entry->second = at;
      if ((newest && f.measured < *newest) || f.disposition == recording::records::Disposition::kFusedLate)
        late.insert({f.id, at});
      if (!newest_here || f.measured > *newest_here) newest_here = f.measured;
    }
    newest = newest_here;
  }
  return late;
}

// Turns the ways into arrows.
class Arrows {
 public:
  Arrows(const TimingData& data, const Followed& followed)
      : followed_(followed), fusion_(fusion_nodes(data)), late_(out_of_sequence(data)) {}

  Way of(const MeasurementWays::Way& followed) const {
    const Stop measured{{LaneKey::Kind::kSensor, index_of(followed.id.sensor), 0}, followed.measured};
    Way way = through(followed.id, measured, stays_to_fusion(followed));
    way.dropped = followed.lost.has_value();
    const MeasurementWays::Stop* end = lead_to_fusion(followed, way);
    if (end != nullptr && !way.dropped) lead_to_image(followed, *end, way);
    return way;
  }

  Way of(const MeasurementWays::Image& image) const {
    const MeasurementWays::Stop& written = image.stops.front();
    std::vector<Stay> stays;
    for (const MeasurementWays::Stop& stop : image.stops)
      if (stop.deed == Deed::kImageFrame) add(followed_.stay(*stop.mark), stays);
    Way way = through({kNoSensor, image.sequence}, {lane_of(written), end_of(written)}, std::move(stays));
    for (const MeasurementWays::Stop& stop : image.stops) {
      if (stop.deed != Deed::kUsed) continue;
      const Stop use = start_of(stop);
      // The way goes down to the reader's lane when the last frame has arrived, then along it until the read.
      const Stop received{use.lane, std::min(way.last.at, use.at)};
      way.legs.push_back({way.last, received, Leg::Kind::kMoves});
      way.legs.push_back({received, use, Leg::Kind::kStored});
      way.last = use;
    }
    return way;
  }

 private:
  LaneKey lane_of(const MeasurementWays::Stop& stop) const {
    return stop.mark ? followed_.stay(*stop.mark).lane : LaneKey{LaneKey::Kind::kTask, index_of(stop.node), 0};
  }
  Stop start_of(const MeasurementWays::Stop& stop) const {
    return {lane_of(stop), stop.mark ? followed_.stay(*stop.mark).in : stop.at};
  }
  TrueTime end_of(const MeasurementWays::Stop& stop) const {
    return stop.mark ? followed_.stay(*stop.mark).out : stop.at;
  }

  // A list stays on a medium from its first frame to its last; in a task, only its first stay counts.
  static void add(const Stay& stay, std::vector<Stay>& stays) {
    const auto there = std::ranges::find(stays, stay.lane, &Stay::lane);
    if (there == stays.end())
      stays.push_back(stay);
    else if (stay.lane.kind != LaneKey::Kind::kTask)
      there->out = std::max(there->out, stay.out);
  }
  std::vector<Stay> stays_to_fusion(const MeasurementWays::Way& followed) const {
    std::vector<Stay> stays;
    for (const MeasurementWays::Stop& stop : followed.stops) {
      const bool task = (stop.deed == Deed::kRead || stop.deed == Deed::kWritten) && !fusion_.contains(stop.node);
      if ((task || stop.deed == Deed::kFrame) && stop.mark) add(followed_.stay(*stop.mark), stays);
    }
    return stays;
  }

  static Way through(const MeasurementId& id, const Stop& first, std::vector<Stay> stays) {
    std::ranges::stable_sort(stays, {}, [](const Stay& s) { return std::tuple(s.in, s.out, s.lane); });
    Way way{id, {}, false, false, first};
    for (const Stay& stay : stays) {
      way.legs.push_back({way.last, {stay.lane, stay.in}, Leg::Kind::kMoves});
      way.last = {stay.lane, stay.out};
    }
    return way;
  }

  // Leads the way to the step that fused or refused the list, or to the last that held it; null without such a step.
  const MeasurementWays::Stop* lead_to_fusion(const MeasurementWays::Way& followed, Way& way) const {
    const MeasurementWays::Stop* last = nullptr;
    for (const MeasurementWays::Stop& stop : followed.stops) {
      if (stop.deed != Deed::kHeld && stop.deed != Deed::kFused && stop.deed != Deed::kRefused) continue;
      const Stop step = start_of(stop);
      // Several holds in a row are one wait.
      if (last != nullptr && way.legs.back().kind == Leg::Kind::kHeld)
        way.legs.back().to = step;
      else
        way.legs.push_back({way.last, step, last != nullptr ? Leg::Kind::kHeld : Leg::Kind::kMoves});
      way.last = step;
      way.out_of_sequence |= late_.contains({followed.id, stop.at});
      way.dropped = stop.deed == Deed::kRefused;
      last = &stop;
      if (stop.deed != Deed::kHeld) break;
    }
    return last;
  }

  // Leads from there to the first image in which it is its sensor's newest list.
  void lead_to_image(const MeasurementWays::Way& followed, const MeasurementWays::Stop& fused, Way& way) const {
    const auto image = std::ranges::find(followed.stops, Deed::kImage, &MeasurementWays::Stop::deed);
    if (image == followed.stops.end()) return;
    const Stop start = start_of(*image);
    const TrueTime done = end_of(fused) <= start.at ? end_of(fused) : way.last.at;
    if (start.lane != way.last.lane) way.legs.push_back({{way.last.lane, done}, start, Leg::Kind::kMoves});
  }

  const Followed& followed_;
  std::set<NodeId> fusion_;
  std::set<std::pair<MeasurementId, TrueTime>> late_;
};

}  // namespace

std::set<NodeId> fusion_nodes(const TimingData& data) {
  std::set<NodeId> nodes;
  for (const auto& s : data.steps) nodes.insert(s.stamp.node);
  for (const auto& i : data.images) nodes.insert(i.stamp.node);
  return nodes;
}

Ways ways_of(const TimingData& data) {
  const Followed followed(data);
  const Arrows arrows(data, followed);
  Ways ways;
  for (const MeasurementWays::Way& way : followed.ways()) ways.measurements.push_back(arrows.of(way));
  for (const MeasurementWays::Image& image : followed.images()) ways.images.push_back(arrows.of(image));
  return ways;
}

}  // namespace ttf::report::timing
