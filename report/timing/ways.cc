#include "report/timing/ways.h"

#include <algorithm>
#include <bitset>
#include <map>
#include <optional>
#include <set>
#include <tuple>

namespace ttf::report::timing {
namespace {

constexpr Duration kSameList = Duration::milliseconds(100);    // largest gap between two frames of one list
constexpr Duration kLongestWay = Duration::milliseconds(500);  // from a measurement to the last trace of it
constexpr Duration kTolerance = Duration::microseconds(2);     // between a task's start and what it reports then

bool same_sequence(std::uint32_t a, std::uint32_t b) { return ((a ^ b) & 0xffu) == 0; }

std::set<NodeId> fusion_nodes(const TimingData& data) {
  std::set<NodeId> nodes;
  for (const auto& s : data.steps) nodes.insert(s.node);
  for (const auto& i : data.images) nodes.insert(i.node);
  return nodes;
}

// The run of a task of `node` that was going on at `at` (a run that starts there wins over one that ends
// there).
const TimingData::Run* run_at(const TimingData& data, NodeId node, TrueTime at) {
  const TimingData::Run* best = nullptr;
  for (const auto& run : data.runs)
    if (run.node == node && run.start <= at + kTolerance && at <= run.end + kTolerance &&
        (best == nullptr || run.start > best->start))
      best = &run;
  return best;
}

LaneKey task_lane(NodeId node, const TimingData::Run* run) {
  return {LaneKey::Kind::kTask, index_of(node), run != nullptr ? run->task : std::uint8_t{0}};
}

// A stay of a list in one lane.
struct Segment {
  LaneKey lane;
  TrueTime in, out;
};

bool belongs(const MeasurementId& id, TrueTime measured, const drawing::Names& names, PduId pdu, std::uint32_t sequence,
             TrueTime at) {
  return same_sequence(sequence, id.sequence) && at >= measured && at < measured + kLongestWay &&
         names.sensor_of(pdu) == id.sensor;
}

// Drops later stays in a lane the list has already been in, and channel B where channel A carried it.
void sort_and_thin(std::vector<Segment>& segments) {
  std::ranges::stable_sort(segments, {}, [](const Segment& s) { return std::tuple(s.in, s.out, s.lane); });
  std::set<LaneKey> seen;
  std::erase_if(segments, [&](const Segment& s) {
    LaneKey lane = s.lane;
    if (lane.kind == LaneKey::Kind::kChannel) lane.index = 0;
    return !seen.insert(lane).second;
  });
}

std::vector<Leg> legs_through(const Stop& first, const std::vector<Segment>& segments) {
  std::vector<Leg> legs;
  Stop from = first;
  for (const Segment& s : segments) {
    legs.push_back({from, {s.lane, s.in}, Leg::Kind::kMoves});
    from = {s.lane, s.out};
  }
  return legs;
}

// Ids of the lists that arrived at the fusion node after one that had been measured later.
std::set<std::pair<MeasurementId, TrueTime>> out_of_sequence(const TimingData& data) {
  std::set<std::pair<MeasurementId, TrueTime>> late;
  std::map<MeasurementId, TrueTime> seen;
  std::optional<GlobalTime> newest;
  std::size_t i = 0;
  while (i < data.fused.size()) {
    // Lists of one step arrive together: they are compared with earlier steps only.
    std::optional<GlobalTime> newest_here = newest;
    const TrueTime at = data.fused[i].at;
    for (; i < data.fused.size() && data.fused[i].at == at; ++i) {
      const auto& f = data.fused[i];
      const auto [entry, first] = seen.try_emplace(f.id, f.at);
      if (!first && f.at - entry->second < kLongestWay && f.what != recording::records::Disposition::kFusedLate)
        continue;
      entry->second = f.at;
      if ((newest && f.measured < *newest) || f.what == recording::records::Disposition::kFusedLate)
        late.insert({f.id, f.at});
      if (!newest_here || f.measured > *newest_here) newest_here = f.measured;
    }
    newest = newest_here;
  }
  return late;
}

// From the step that fused a measurement to the first image that has it as its sensor's newest.
void lead_to_image(const TimingData& data, Way& way) {
  for (const auto& image : data.images) {
    if (image.at < way.last.at || image.at >= way.last.at + kLongestWay) continue;
    const bool in_it = std::ranges::any_of(image.newest, [&](const MeasurementId& id) {
      return id.sensor == way.id.sensor && same_sequence(id.sequence, way.id.sequence);
    });
    if (!in_it) continue;
    const TimingData::Run* writer = run_at(data, image.node, image.at);
    const TimingData::Run* fuser = run_at(data, image.node, way.last.at);
    const Stop start{task_lane(image.node, writer), writer != nullptr ? writer->start : image.at};
    const Stop fused{way.last.lane, fuser != nullptr && fuser->end <= start.at ? fuser->end : way.last.at};
    if (start.lane != fused.lane) way.legs.push_back({fused, start, Leg::Kind::kMoves});
    return;
  }
}

}  // namespace

std::vector<Transfer> transfers_of(const TimingData& data) {
  std::vector<Transfer> transfers;
  std::map<std::tuple<LaneKey, PduId, std::uint32_t>, std::size_t> open;
  const auto add = [&](const Transfer& t) {
    const auto [entry, first] = open.try_emplace({t.lane, t.pdu, t.sequence}, transfers.size());
    if (!first && t.start - transfers[entry->second].end < kSameList) {
      transfers[entry->second].end = std::max(transfers[entry->second].end, t.end);
      return;
    }
    entry->second = transfers.size();
    transfers.push_back(t);
  };
  for (const auto& f : data.can_frames) add({{LaneKey::Kind::kCan, f.bus, 0}, f.start, f.end, f.pdu, f.sequence});
  // A state message is sent again whenever its slots come round: what travels is the first time of each
  // fragment.
  struct Sent {
    std::bitset<256> fragments;
    TrueTime last;
  };
  std::map<std::tuple<std::uint8_t, PduId, std::uint32_t>, Sent> sent;
  for (const auto& f : data.slot_frames) {
    if (f.null_frame || f.pdu == kNoPdu) continue;
    const auto [entry, first] = sent.try_emplace({f.channel, f.pdu, f.sequence}, Sent{{}, f.end});
    if (f.start - entry->second.last >= kSameList) entry->second.fragments.reset();  // the counter has come round
    entry->second.last = f.end;
    if (entry->second.fragments[f.fragment]) continue;
    entry->second.fragments.set(f.fragment);
    add({{LaneKey::Kind::kChannel, f.channel, 0}, f.start, f.end, f.pdu, f.sequence});
  }
  return transfers;
}

std::vector<Way> measurement_ways(const TimingData& data, const drawing::Names& names,
                                  const std::vector<Transfer>& transfers) {
  const std::set<NodeId> fusion = fusion_nodes(data);
  const auto late = out_of_sequence(data);
  std::vector<Way> ways;
  for (const auto& m : data.measurements) {
    std::vector<Segment> segments;
    for (const Transfer& t : transfers)
      if (belongs(m.id, m.at, names, t.pdu, t.sequence, t.start)) segments.push_back({t.lane, t.start, t.end});
    bool lost = false;
    for (const auto& h : data.hops) {
      if (!belongs(m.id, m.at, names, h.pdu, h.sequence, h.at)) continue;
      if (h.hop == recording::records::Hop::kTorn || h.hop == recording::records::Hop::kOverwritten ||
          h.hop == recording::records::Hop::kDiscarded)
        lost = true;
      const bool passes = h.hop == recording::records::Hop::kRead || h.hop == recording::records::Hop::kWritten;
      if (!passes || fusion.contains(h.node)) continue;
      const TimingData::Run* run = run_at(data, h.node, h.at);
      if (run != nullptr && run->start >= m.at) segments.push_back({task_lane(h.node, run), run->start, run->end});
    }
    sort_and_thin(segments);

    Way way{m.id, legs_through({{LaneKey::Kind::kSensor, index_of(m.id.sensor), 0}, m.at}, segments), false, false, {}};
    way.last = segments.empty() ? Stop{{LaneKey::Kind::kSensor, index_of(m.id.sensor), 0}, m.at}
                                : Stop{segments.back().lane, segments.back().out};
    bool reached = false;
    for (const auto& f : data.fused) {
      const bool mine = f.id.sensor == m.id.sensor && same_sequence(f.id.sequence, m.id.sequence) && f.at >= m.at &&
                        f.at < m.at + kLongestWay;
      if (!mine) continue;
      const TimingData::Run* run = run_at(data, f.node, f.at);
      const Stop step{task_lane(f.node, run), run != nullptr ? run->start : f.at};
      // However many steps hold a list back, it waits once.
      if (reached && way.legs.back().kind == Leg::Kind::kHeld)
        way.legs.back().to = step;
      else
        way.legs.push_back({way.last, step, reached ? Leg::Kind::kHeld : Leg::Kind::kMoves});
      way.last = step;
      reached = true;
      if (late.contains({f.id, f.at})) way.out_of_sequence = true;
      lost = f.what == recording::records::Disposition::kDroppedTooOld ||
             f.what == recording::records::Disposition::kDuplicate;
      if (f.what != recording::records::Disposition::kHeld) break;
    }
    way.dropped = lost;
    if (reached && !lost) lead_to_image(data, way);
    ways.push_back(std::move(way));
  }
  return ways;
}

std::vector<Way> image_ways(const TimingData& data, const drawing::Names& names,
                            const std::vector<Transfer>& transfers) {
  std::vector<Way> ways;
  for (const auto& image : data.images) {
    const TimingData::Run* writer = run_at(data, image.node, image.at);
    const TrueTime written = writer != nullptr ? writer->end : image.at;
    // The image's PDU descends from no sensor; its slots belong to the node that wrote it.
    std::set<PduId> own;
    for (const auto& f : data.slot_frames)
      if (f.node == image.node && f.pdu != kNoPdu && names.sensor_of(f.pdu) == kNoSensor) own.insert(f.pdu);
    std::vector<Segment> segments;
    for (const Transfer& t : transfers)
      if (t.lane.kind == LaneKey::Kind::kChannel && own.contains(t.pdu) && same_sequence(t.sequence, image.sequence) &&
          t.start >= image.at && t.start < image.at + kLongestWay)
        segments.push_back({t.lane, t.start, t.end});
    sort_and_thin(segments);
    Way way{{kNoSensor, image.sequence},
            legs_through({task_lane(image.node, writer), written}, segments),
            false,
            false,
            {}};
    way.last = segments.empty() ? Stop{task_lane(image.node, writer), written}
                                : Stop{segments.back().lane, segments.back().out};
    for (const auto& u : data.uses) {
      if (u.stale || !same_sequence(u.image, image.sequence) || u.at < image.at || u.at >= image.at + kLongestWay)
        continue;
      const TimingData::Run* run = run_at(data, u.node, u.at);
      const Stop use{task_lane(u.node, run), run != nullptr ? run->start : u.at};
      // Down to the reader's lane when the last frame has arrived, then along it until it is read.
      const Stop received{use.lane, std::min(way.last.at, use.at)};
      way.legs.push_back({way.last, received, Leg::Kind::kMoves});
      way.legs.push_back({received, use, Leg::Kind::kStored});
      way.last = use;
      break;
    }
    ways.push_back(std::move(way));
  }
  return ways;
}

std::vector<Lane> lanes_of(const TimingData& data, const drawing::Names& names, const std::vector<Way>& ways) {
  using Kind = LaneKey::Kind;
  const std::set<NodeId> fusion = fusion_nodes(data);
  std::set<NodeId> features;
  for (const auto& u : data.uses) features.insert(u.node);
  std::set<LaneKey> keys;
  for (const auto& m : data.measurements) keys.insert({Kind::kSensor, index_of(m.id.sensor), 0});
  for (const auto& f : data.can_frames) keys.insert({Kind::kCan, f.bus, 0});
  for (const auto& f : data.slot_frames) keys.insert({Kind::kChannel, f.channel, 0});
  for (const auto& r : data.runs) keys.insert({Kind::kTask, index_of(r.node), r.task});
  // Steps are reported without a task where the log holds no task runs.
  for (const Way& way : ways)
    for (const Leg& leg : way.legs) keys.insert({leg.from.lane, leg.to.lane});

  // Mean position along the ways, for whole nodes so that their tasks stay together.
  struct Mean {
    double sum = 0;
    int n = 0;
  };
  std::map<std::pair<Kind, std::size_t>, Mean> position;
  for (const Way& way : ways) {
    double p = 0;
    for (const Leg& leg : way.legs) {
      Mean& mean = position[{leg.to.lane.kind, leg.to.lane.index}];
      mean.sum += ++p;
      ++mean.n;
    }
  }
  struct Ranked {
    double rank;
    Lane lane;
  };
  std::vector<Ranked> ranked;
  for (const LaneKey& key : keys) {
    Lane lane{key, {}, 1};
    const auto mean = position.find({key.kind, key.index});
    double rank = mean != position.end() ? mean->second.sum / mean->second.n : 1e9;
    switch (key.kind) {
      case Kind::kSensor: lane.label = names.sensor(SensorId(key.index)), lane.section = 0, rank = 0; break;
      case Kind::kCan: lane.label = names.can_bus(key.index); break;
      case Kind::kChannel: lane.label = key.index == 0 ? "FlexRay A" : "FlexRay B", lane.section = 2, rank = 0; break;
      case Kind::kTask: {
        const NodeId node{static_cast<std::uint8_t>(key.index)};
        const std::string task = names.task(node, key.task);
        lane.label = names.node(node) == task ? task : names.node(node) + ": " + task;
        if (fusion.contains(node))
          lane.section = 3, rank = 0;
        else if (features.contains(node))
          lane.section = 4, rank = 0;
        break;
      }
    }
    ranked.push_back({rank, std::move(lane)});
  }
  std::ranges::stable_sort(ranked, {}, [](const Ranked& r) { return std::tuple(r.lane.section, r.rank, r.lane.key); });
  std::vector<Lane> lanes;
  for (Ranked& r : ranked) lanes.push_back(std::move(r.lane));
  return lanes;
}

}  // namespace ttf::report::timing
