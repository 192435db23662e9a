// The transparent medium and the bit-true one, the fast way and the plain way, are indistinguishable.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "recording/log/writer.h"
#include "sim/engine/bus_simulation.h"
#include "sim/engine/cluster_simulation.h"
#include "sim/medium/channel_log.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim::engine {
namespace {

using schedules::model::Channel;

// All of a controller's reports, without the bytes.
struct Diary final : bus::controller::ControllerEvents {
  std::vector<std::int64_t> entries;
  template <class... Numbers> void write(Numbers... numbers) {
    (entries.push_back(static_cast<std::int64_t>(numbers)), ...);
  }
  bool wants_bytes() const override { return false; }
  void cycle_started(std::int64_t cycle, Microticks at) override { write(1, cycle, at.value); }
  void slot_problem(std::int64_t cycle, int slot, Channel channel, bus::controller::SlotStatus status,
                    Microticks at) override {
    write(2, cycle, slot, channel, status, at.value);
  }
  void frame_sent(const bus::ports::Transmission& sent, std::int64_t cycle, bool null_frame, PduId, std::uint32_t, int,
                  bool) override {
    write(3, sent.channel, sent.start.value, sent.end.value, sent.slot, cycle, null_frame);
    encoded += sent.bytes.empty() ? 0 : 1;
    ++frames;
  }
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks at) override {
    write(4, cycle, offset.value, rate.value, offset.missing, rate.missing, at.value);
  }
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    write(5, from, step.next.kind, step.reason, at.value);
  }
  int frames = 0, encoded = 0;
};

// Some nodes' frames are sometimes cut, flipped, moved, swapped or lost; noise, and supplies that fail.
class Trouble final : public medium::Disturbance {
 public:
  Trouble(BusSimulation& plant, std::uint64_t seed, int nodes)
      : plant_(plant), draw_({seed, 0, Purpose::kTest, 3, 0}), nodes_(nodes) {}
  bool touches(NodeId sender, Channel) const override { return index_of(sender) < 2 && troubled_; }
  bool leaving(medium::Leaving& signal) override {
    if (!touches(signal.sender, signal.channel)) {
      EXPECT_TRUE(signal.bytes.empty() || !transparent);
      return true;
    }
    const int what = static_cast<int>(draw_.integer(0, 9));
    if (what == 0) return false;
    if (what == 1) signal.channel = signal.channel == Channel::kA ? Channel::kB : Channel::kA;
    if (what < 5 && signal.signal == bus::ports::Signal::kFrame) {
      std::copy(signal.bytes.begin(), signal.bytes.end(), changed_.begin());
      const auto bit =
          static_cast<std::size_t>(draw_.integer(0, 8 * static_cast<std::int64_t>(signal.bytes.size()) - 1));
      changed_[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
      signal.bytes = std::span<const std::byte>(changed_).first(signal.bytes.size());
    }
    return true;
  }
  bool arriving(medium::Arriving& signal) override {
    if (!troubled_) return true;
    const int what = static_cast<int>(draw_.integer(0, 49));
    if (what == 0) signal.signal = bus::ports::Signal::kUndecodable;
    if (what == 1) signal.start = signal.start + Duration{5'000}, signal.end = signal.end + Duration{5'000};
    return what != 2;
  }
  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    troubled_ = !troubled_;
    const auto node = static_cast<NodeId>(draw_.integer(0, nodes_ - 1));
    const int what = static_cast<int>(draw_.integer(0, 5));
    if (what == 0) plant_.power_on(node, now + Duration{draw_.integer(0, 30'000'000)});
    if (what == 1)
      plant_.emit(
          {node, Channel::kA, bus::ports::Signal::kUndecodable, now, now + Duration{draw_.integer(1, 100'000)}, {}},
          std::nullopt);
    next_ = now + Duration{draw_.integer(1, 30'000'000)};
  }
  bool transparent = false;

 private:
  BusSimulation& plant_;
  RandomStream draw_;
  int nodes_;
  bool troubled_ = false;
  std::array<std::byte, bus::wire::kMaxFrameBytes> changed_{};
  TrueTime next_{20'000'000};
};

// The fate of frames on their way, with their bytes.
struct ChannelDiary final : recording::records::Sink {
  std::vector<std::int64_t> entries;
  int frames = 0;
  using recording::records::Sink::on;
  void on(const recording::records::ChannelFrame& frame) override {
    ++frames;
    for (const std::int64_t entry :
         {frame.start.ns, frame.end.ns, frame.sent.ns, std::int64_t{frame.channel}, std::int64_t{frame.sent_channel},
          static_cast<std::int64_t>(frame.state), std::int64_t{frame.slot}, std::int64_t{frame.cycle_counter},
          static_cast<std::int64_t>(frame.sender), static_cast<std::int64_t>(frame.bytes.size())})
      entries.push_back(entry);
    for (const std::byte byte : frame.bytes) entries.push_back(static_cast<std::int64_t>(byte));
  }
};

struct Reported {
  std::vector<Diary> diaries;
  ChannelDiary channels;
  int frames = 0, encoded = 0;
};

struct How {
  bool transparent, fast;
};
constexpr How kReference{false, false}, kBitTrue{false, true}, kTransparent{true, true};

Reported run(std::uint64_t seed, bool troubled, const How& how, bool logged = false) {
  RandomStream draw({seed, 0, Purpose::kTest, 4, 0});
  const int nodes = static_cast<int>(draw.integer(2, 9));
  const int coldstart = static_cast<int>(draw.integer(2, nodes));
  const schedules::model::Cluster cluster =
      bus_cluster(nodes, coldstart, static_cast<int>(draw.integer(coldstart, nodes)));
  Reported reported;
  reported.diaries.resize(static_cast<std::size_t>(nodes));
  std::vector<BusNode> begin;
  std::vector<bus::controller::ControllerEvents*> events;
  for (int n = 0; n < nodes; ++n) {
    begin.push_back({timebase::Oscillator{25'000, draw.integer(-1'500'000, 1'500'000), draw.integer(0, 24'999)},
                     TrueTime{draw.integer(0, 20'000'000)}});
    events.push_back(&reported.diaries[static_cast<std::size_t>(n)]);
  }
  BusSimulation simulation(cluster, std::move(begin), std::move(events));
  simulation.medium().set_transparent(how.transparent);
  simulation.medium().set_fast(how.fast);
  medium::ChannelLog log(cluster.flexray, medium::FlexRayMedium::kMostLogged, reported.channels);
  if (logged) simulation.medium().set_log(&log);
  Trouble trouble(simulation, seed, nodes);
  trouble.transparent = how.transparent;
  if (troubled) simulation.set_disturbance(&trouble);
  simulation.run_until(TrueTime{1'000'000'000});
  for (const Diary& diary : reported.diaries) {
    reported.frames += diary.frames;
    reported.encoded += diary.encoded;
  }
  return reported;
}

TEST(TransparentMedium, ControllersReceiveTheSame) {
  for (const bool troubled : {false, true})
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const Reported reference = run(seed, troubled, kReference), transparent = run(seed, troubled, kTransparent);
      ASSERT_EQ(reference.diaries.size(), transparent.diaries.size());
      for (std::size_t n = 0; n < reference.diaries.size(); ++n)
        ASSERT_EQ(reference.diaries[n].entries, transparent.diaries[n].entries) << "seed " << seed << " node " << n;
      EXPECT_GT(reference.frames, 100);
      EXPECT_EQ(reference.encoded, reference.frames);
      EXPECT_EQ(transparent.encoded == 0, !troubled) << "only what a fault may touch has bytes";
      EXPECT_LT(transparent.encoded, transparent.frames * 3 / 4);
    }
}

TEST(TransparentMedium, TheLogReceivesTheSameOfTheChannels) {
  for (const bool troubled : {false, true})
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const Reported unlogged = run(seed, troubled, kBitTrue), reference = run(seed, troubled, kReference, true),
                     transparent = run(seed, troubled, kTransparent, true);
      ASSERT_EQ(reference.channels.entries, transparent.channels.entries) << "seed " << seed;
      for (std::size_t n = 0; n < unlogged.diaries.size(); ++n)
        ASSERT_EQ(unlogged.diaries[n].entries, reference.diaries[n].entries) << "seed " << seed << " node " << n;
      if (troubled) {
        EXPECT_GT(reference.channels.frames, 20) << "seed " << seed;
      }
    }
}

// Two bits of every seventh frame of one node.
class Flips final : public medium::Disturbance {
 public:
  explicit Flips(NodeId node) : node_(node) {}
  bool touches(NodeId sender, Channel) const override { return sender == node_; }
  bool leaving(medium::Leaving& signal) override {
    if (signal.sender != node_ || ++frames_ % 7 != 0) return true;
    std::copy(signal.bytes.begin(), signal.bytes.end(), changed_.begin());
    changed_[6] ^= std::byte{0x21};
    signal.bytes = std::span<const std::byte>(changed_).first(signal.bytes.size());
    return true;
  }

 private:
  NodeId node_;
  int frames_ = 0;
  std::array<std::byte, bus::wire::kMaxFrameBytes> changed_{};
};

std::uint64_t hash(fusion::strategies::StrategyKind strategy, std::uint64_t seed, bool flips, const How& how) {
  const sim::drives::Drive drive("scenarios/paper_scenario1.yaml", strategy);
  const auto scene = std::make_shared<sensors::WorldScene>(drive.scenario.world, seed, 0, kFirstCycle);
  const sim::drives::NodeSetConfig nodes{&drive.scenario, &drive.cluster, strategy, seed, 0, scene, nullptr};
  SimulationConfig config;
  config.cluster = &drive.cluster;
  config.seed = seed;
  config.make_steps = [&](NodeId node) { return sim::drives::make_steps(nodes, node); };
  const std::string path = testing::TempDir() + "/transparent.mcap";
  recording::log::LogWriter log(path, {});
  ClusterSimulation simulation(config, log);
  simulation.medium().set_transparent(how.transparent);
  simulation.medium().set_fast(how.fast);
  Flips disturbance(*drive.cluster.find_node("gateway"));
  if (flips) simulation.set_disturbance(&disturbance);
  simulation.run_until(TrueTime{3'000'000'000});
  EXPECT_EQ(simulation.counts().slot_problems > 0, flips);
  log.close();
  std::filesystem::remove(path);
  return log.content_hash();
}

TEST(TransparentMedium, DrivesLeaveTheSameRecords) {
  for (const fusion::strategies::StrategyKind strategy : fusion::strategies::kAllStrategies)
    for (const bool flips : {false, true})
      for (std::uint64_t seed = 1; seed < 4; ++seed)
        EXPECT_EQ(hash(strategy, seed, flips, kReference), hash(strategy, seed, flips, kTransparent))
            << "seed " << seed;
}

}  // namespace
}  // namespace ttf::sim::engine
