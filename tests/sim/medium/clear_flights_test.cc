// Signals close together in time or far apart, on one channel or on both at once. In the fast way and in the
// plain way, arrivals follow from the delays and the overlaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "core/random.h"
#include "sim/medium/flexray_medium.h"

namespace ttf::sim::medium {
namespace {

using bus::ports::Signal;
using schedules::model::Channel;
using schedules::model::Channels;

constexpr std::size_t kNodes = 5;

// One node may be on channel A alone.
schedules::model::Cluster line(bool last_on_a_only) {
  schedules::model::Cluster cluster;
  cluster.flexray.gdMinPropagationDelay_ps = 100'000;
  cluster.flexray.gdMaxPropagationDelay_ps = 2'500'000;
  cluster.nodes.resize(kNodes);
  for (schedules::model::Node& node : cluster.nodes) node.flexray.emplace();
  if (last_on_a_only) cluster.nodes.back().flexray->pChannels = Channels::kA;
  return cluster;
}

// In the order of arriving: end, receiver, channel.
struct Reached {
  std::int64_t end = 0;
  std::size_t receiver = 0;
  Channel channel{};
  std::int64_t start = 0;
  Signal signal{};
  int frame_id = 0;  // 0: no frame
  bool operator==(const Reached&) const = default;
};

struct Line {
  schedules::model::Cluster cluster;
  MediumQueue queue{FlexRayMedium::kMostPending};
  FramePool pool{FlexRayMedium::kMostPending};
  FlexRayMedium medium{cluster, queue, pool};
  bool goes_along;  // with a signal, from receiver to receiver, or arrival by arrival from the queue
  std::vector<Reached> reached;
  struct Sent {
    NodeId sender;
    Channel channel;
    Signal signal;
    TrueTime start, end;
    int frame_id;
  };
  std::vector<Sent> sent;

  Line(bool last_on_a_only, bool along, bool fast) : cluster(line(last_on_a_only)), goes_along(along) {
    medium.set_fast(fast);
  }
  bool attached(std::size_t node, Channel channel) const {
    return includes(cluster.nodes[node].flexray->pChannels, channel);
  }

  void send(const Sent& one) {
    std::array<std::byte, 16> room{};
    bus::ports::Transmission transmission{one.channel, one.signal, {}, {}, one.frame_id, {}};
    if (one.signal == Signal::kFrame) {
      bus::wire::FrameHeader header;
      header.frame_id = static_cast<std::uint16_t>(one.frame_id);
      transmission.bytes = std::span(room).first(bus::wire::encode_frame(header, one.channel, {}, room));
    }
    medium.transmit(one.sender, transmission, one.start, one.end);
    sent.push_back(one);
  }

  void note(const MediumEvent& event, const Arrival& arrival) {
    const int id = arrival.signal == Signal::kFrame ? medium.frame(arrival).header.frame_id : 0;
    reached.push_back({arrival.end.ns, event.node, arrival.channel, arrival.start.ns, arrival.signal, id});
    medium.release(arrival);
  }

  // Everything up to and including `end`.
  void run(TrueTime end) {
    while (!queue.empty() && queue.next().time <= end) {
      TrueTime now = queue.next().time;
      MediumEvent event = queue.pop();
      if (!goes_along) {
        if (const auto arrival = medium.arrive(event, now)) note(event, *arrival);
        continue;
      }
      while (true) {
        const auto [arrival, goes_on] = medium.stop_over(event, now);
        if (arrival) note(event, *arrival);
        if (!goes_on) break;
        const EventOrder next = medium.next_arrival(event);
        now = next.time;
        if (next.time <= end && queue.is_first(next)) continue;
        queue.go_on(next, event);
        break;
      }
    }
  }

  // The past and future receptions of all signals sent so far: overlapping intervals are one.
  std::vector<Reached> expected() const {
    std::vector<Reached> all;
    for (std::size_t node = 0; node < kNodes; ++node)
      for (const Channel channel : {Channel::kA, Channel::kB}) {
        if (!attached(node, channel)) continue;
        std::vector<Reached> here;
        for (const Sent& one : sent) {
          if (index_of(one.sender) == node || one.channel != channel) continue;
          const Duration delay = medium.delay(one.sender, static_cast<NodeId>(node));
          here.push_back({(one.end + delay).ns, node, channel, (one.start + delay).ns, one.signal, one.frame_id});
        }
        std::sort(here.begin(), here.end(), [](const Reached& a, const Reached& b) { return a.start < b.start; });
        for (std::size_t i = 0; i < here.size(); ++i) {
          Reached merged = here[i];
          for (; i + 1 < here.size() && here[i + 1].start < merged.end; ++i) {
            const bool cas = merged.signal == Signal::kCas && here[i + 1].signal == Signal::kCas;
            merged.signal = cas ? Signal::kCas : Signal::kUndecodable;
            merged.frame_id = 0;
            merged.end = std::max(merged.end, here[i + 1].end);
          }
          all.push_back(merged);
        }
      }
    std::sort(all.begin(), all.end(), [](const Reached& a, const Reached& b) {
      return std::tie(a.end, a.receiver, a.channel) < std::tie(b.end, b.receiver, b.channel);
    });
    return all;
  }

  void expect_carriers(TrueTime now) const {
    std::array<std::array<bool, 2>, kNodes> carrier{};
    for (const Reached& one : expected())
      if (one.start <= now.ns && one.end > now.ns) carrier[one.receiver][index_of(one.channel)] = true;
    for (std::size_t node = 0; node < kNodes; ++node)
      for (const Channel channel : {Channel::kA, Channel::kB})
        EXPECT_EQ(medium.carrier(static_cast<NodeId>(node), channel, now), carrier[node][index_of(channel)])
            << "node " << node << " at " << now.ns;
  }
};

class ClearFlights : public testing::TestWithParam<std::tuple<bool, bool, bool>> {
 protected:
  Line made() const { return std::make_from_tuple<Line>(GetParam()); }
};

TEST_P(ClearFlights, ArrivalsFollowFromDelaysAndOverlaps) {
  int alone = 0, drawn_together = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Line line = made();
    RandomStream draw({seed, 0, Purpose::kTest, 0, 0});
    TrueTime now{1'000};
    for (int s = 1; s <= 40; ++s) {
      now = now + Duration{draw.integer(0, 1) == 0 ? draw.integer(0, 3'000) : draw.integer(3'000, 12'000)};
      line.run(now);
      line.expect_carriers(now);
      const auto sender = static_cast<NodeId>(draw.integer(0, kNodes - 1));
      constexpr std::array kinds = {Signal::kFrame, Signal::kFrame, Signal::kCas, Signal::kUndecodable};
      const Signal signal = kinds[static_cast<std::size_t>(draw.integer(0, 3))];
      const TrueTime end = now + Duration{draw.integer(500, 4'000)};
      const std::int64_t where = draw.integer(0, 3);  // on A, on B, or on both, now and then not for the same time
      for (const Channel channel : {Channel::kA, Channel::kB}) {
        if (!line.attached(index_of(sender), channel) || where == 1 - static_cast<int>(index_of(channel))) continue;
        const Duration longer{channel == Channel::kB && draw.integer(0, 9) == 0 ? 100 : 0};
        line.send({sender, channel, signal, now, end + longer, signal == Signal::kFrame ? s : 0});
      }
    }
    line.run(now + Duration{100'000});
    EXPECT_TRUE(line.queue.empty());
    const std::vector<Reached> expected = line.expected();
    ASSERT_EQ(line.reached, expected) << "seed " << seed;
    for (const Reached& one : expected) ++(one.frame_id > 0 ? alone : drawn_together);
  }
  EXPECT_GT(alone, 300);
  EXPECT_GT(drawn_together, 300);
}

// A noise of 100 ms with 10 us bursts and frames in it, one behind the other: more than there is room for at
// once.
TEST_P(ClearFlights, SignalsDrawnIntoALongNoiseAreOverWhenItEnds) {
  Line line = made();
  const TrueTime begins{1'000}, ends = begins + Duration::milliseconds(100);
  line.send({NodeId{0}, Channel::kA, Signal::kUndecodable, begins, ends, 0});
  int sent = 0;
  for (TrueTime now = begins + Duration::microseconds(50); now < ends; now += Duration::microseconds(50), ++sent) {
    line.run(now);
    const auto sender = static_cast<NodeId>(1 + sent % 4);
    const bool frame = sent % 2 != 0;
    const TrueTime end = now + Duration::microseconds(10);
    for (const Channel channel : {Channel::kA, Channel::kB})
      if (line.attached(index_of(sender), channel))
        line.send({sender, channel, frame ? Signal::kFrame : Signal::kUndecodable, now, end, frame ? 7 : 0});
  }
  ASSERT_GT(sent, 2 * static_cast<int>(FlexRayMedium::kFlights));
  line.run(ends + Duration{100'000});
  EXPECT_TRUE(line.queue.empty());
  ASSERT_EQ(line.reached, line.expected());
}

// Each ends later than all before it: none ends before the last one has begun.
TEST_P(ClearFlights, WhereThereAreMoreThanThereIsRoomForThereIsMoreRoom) {
  Line line = made();
  TrueTime now{1'000};
  const TrueTime ends = now + Duration::milliseconds(2);
  for (int sent = 0; sent < 3 * static_cast<int>(FlexRayMedium::kFlights); ++sent, now += Duration::microseconds(1)) {
    line.run(now);
    line.send({static_cast<NodeId>(sent % 4), Channel::kA, Signal::kCas, now, ends + Duration{10 * sent}, 0});
  }
  // Beside it, on the other channel, a clear signal.
  line.send({NodeId{1}, Channel::kB, Signal::kFrame, now, now + Duration{5'000}, 7});
  ASSERT_LT(now, ends);
  line.run(ends + Duration{100'000});
  EXPECT_TRUE(line.queue.empty());
  ASSERT_EQ(line.reached, line.expected());
}

INSTANTIATE_TEST_SUITE_P(Lines, ClearFlights, testing::Combine(testing::Bool(), testing::Bool(), testing::Bool()));

}  // namespace
}  // namespace ttf::sim::medium
