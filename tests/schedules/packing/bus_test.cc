// Packings as frames, as a bus that the cluster's rules hold for, and as FIBEX that is read again.
#include "schedules/packing/bus.h"

#include <gtest/gtest.h>

#include <map>

#include "schedules/check/checker.h"
#include "schedules/exchange/fibex/file.h"
#include "schedules/exchange/fibex/import.h"
#include "schedules/exchange/fibex/references.h"
#include "schedules/packing/packer.h"
#include "tests/schedules/packing/like_instance.h"

namespace ttf::schedules::packing {
namespace {

namespace fibex = exchange::fibex;

const BusRequest kRequest{"drawn", "drawn.csv", Duration::milliseconds(5)};

struct PackedBus {
  Instance instance;
  Assignment assignment;
  std::vector<PackedFrame> frames;
};

PackedBus packed_bus(Instance instance, ChannelUse use = ChannelUse::kOne) {
  const Solution solution = pack(instance);
  Assignment assignment = assigned(solution.places, slot_numbers({}, solution.bins, 1, use));
  std::vector<std::vector<PackedFrame>> vehicles{frames_of(instance, assignment)};
  add_key_slots(vehicles);
  return {std::move(instance), std::move(assignment), std::move(vehicles.front())};
}

std::string all_sentences(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) text += finding.sentence() + '\n';
  return text;
}

TEST(PackedFrames, HaveEachSignalInItsCyclesAndNoOther) {
  for (const bool shared : {false, true}) {
    Instance drawn = like_instance(300, 3);
    drawn.shared_slots = shared;
    const PackedBus bus = packed_bus(drawn);
    for (int node = 0; node < 6; ++node) EXPECT_TRUE(key_slot(bus.frames, node));
    std::map<std::tuple<int, int, std::size_t>, int> sent;  // slot, cycle, signal
    std::map<std::pair<int, int>, int> frames;
    for (const PackedFrame& frame : bus.frames)
      for (int cycle = frame.base_cycle; cycle < 64; cycle += frame.repetition) {
        EXPECT_EQ(++frames[std::pair(frame.number.slot, cycle)], 1);
        for (const std::size_t signal : frame.signals) {
          ++sent[std::tuple(frame.number.slot, cycle, signal)];
          EXPECT_EQ(bus.instance.signals[signal].node, frame.node);
        }
      }
    std::size_t expected = 0;
    for (std::size_t i = 0; i < bus.assignment.size(); ++i)
      for (int cycle = bus.assignment[i]->first_cycle; cycle < 64; cycle += bus.instance.signals[i].repetition) {
        EXPECT_EQ(sent[std::tuple(bus.assignment[i]->number.slot, cycle, i)], 1);
        ++expected;
      }
    EXPECT_EQ(sent.size(), expected);
    if (!shared) {
      EXPECT_EQ(frames.size() % 64, 0u);  // all cycles of each slot
    }
  }
}

TEST(PackedFrames, AreTheFewest) {
  const Instance instance{{"a"}, {{"x", 0, 2, {0, 0}, 4}, {"y", 0, 4, {1, 1}, 4}}, 8, 64, false};
  const PackedBus bus = packed_bus(instance);
  ASSERT_EQ(bus.frames.size(), 4u);  // x in 0 of 2, y in 1 of 4, none in 3 of 4; a key slot
  EXPECT_EQ(bus.frames[0].repetition, 2);
  EXPECT_EQ(bus.frames[1].repetition, 4);
  EXPECT_TRUE(bus.frames[2].signals.empty());
  EXPECT_EQ(bus.frames[2].base_cycle, 3);
  EXPECT_EQ(bus.frames[3].number.slot, 2);
  EXPECT_EQ(bus.frames[3].repetition, 1);
}

TEST(PackedFrames, OfVariantsHaveTheSameKeySlots) {
  // Node 0 has a whole slot in each vehicle, but not the same one. Node 1 has one in the first alone, node 2 in both.
  const auto frame = [](int slot, int node, int repetition) {
    return PackedFrame{{slot, model::Channels::kA}, 0, repetition, node, {}};
  };
  std::vector<std::vector<PackedFrame>> vehicles{{frame(1, 0, 1), frame(2, 1, 1), frame(4, 2, 1)},
                                                 {frame(2, 0, 1), frame(3, 1, 2), frame(4, 2, 1)}};
  const auto key_slots = add_key_slots(vehicles);
  EXPECT_EQ(key_slots, (std::map<int, int>{{0, 5}, {1, 6}, {2, 4}}));
  for (const auto& frames : vehicles) {
    EXPECT_EQ(frames.size(), 5u);
    EXPECT_EQ(frames[3].number.slot, 5);
    EXPECT_EQ(frames[3].node, 0);
  }
  std::vector<std::vector<PackedFrame>> without{{frame(1, 0, 1)}, {frame(1, 1, 1)}};
  EXPECT_EQ(add_key_slots(without), (std::map<int, int>{{0, 1}, {1, 1}}));  // the nodes never meet
  std::vector<std::vector<PackedFrame>> slow{{frame(1, 0, 1), frame(2, 1, 2)}, {frame(1, 0, 1), frame(3, 2, 2)}};
  EXPECT_EQ(add_key_slots(slow), (std::map<int, int>{{0, 1}, {1, 3}, {2, 2}}));
}

TEST(PackedBus, StartersAreThreeInEachVehicleWithOneRoleInAll) {
  const auto vehicle = [](const std::vector<int>& nodes) {
    std::vector<PackedFrame> frames;
    for (const int node : nodes) frames.push_back({{node + 1, model::Channels::kA}, 0, 1, node, {}});
    return frames;
  };
  EXPECT_EQ(starters_of({vehicle({0, 1, 2, 3})}), (std::set{0, 1, 2}));
  EXPECT_EQ(starters_of({vehicle({1, 4})}), (std::set{1, 4}));
  EXPECT_EQ(starters_of({vehicle({0, 1, 2, 3}), vehicle({0, 2, 3, 5}), vehicle({2, 3, 5, 6})}), (std::set{0, 2, 3, 5}));
}

TEST(PackedBus, OfAVariantHasTheSlotsAndKeySlotsThatItIsGiven) {
  const PackedBus bus = packed_bus(like_instance(60, 2));
  BusRequest request = kRequest;
  request.slots = 40;
  const int node = bus.frames.back().node;
  request.key_slots = {{node, bus.frames.back().number.slot}};
  const model::Cluster cluster = bus_of(bus.instance, bus.frames, request);
  EXPECT_EQ(cluster.flexray.gNumberOfStaticSlots, 40);
  EXPECT_EQ(cluster.nodes[static_cast<std::size_t>(node)].flexray->pKeySlotId, bus.frames.back().number.slot);
  EXPECT_EQ(all_sentences(check::check(cluster)), "");
}

TEST(PackedBus, ObeysTheRulesOfACluster) {
  for (const ChannelUse use : {ChannelUse::kOne, ChannelUse::kSame})
    for (const int signals : {40, 400, 4000}) {
      const PackedBus bus = packed_bus(like_instance(signals, 2), use);
      const model::Cluster cluster = bus_of(bus.instance, bus.frames, kRequest);
      EXPECT_EQ(all_sentences(check::check(cluster)), "") << signals << " signals";
      EXPECT_EQ(cluster.cycle(), Duration::milliseconds(5));
    }
}

TEST(PackedBus, RefusesSlotsThatDoNotFitTheCycle) {
  const PackedBus bus = packed_bus(like_instance(4000, 2));
  EXPECT_THROW(bus_of(bus.instance, bus.frames, {"drawn", "drawn.csv", Duration::milliseconds(1)}), InputError);
  EXPECT_THROW(bus_of(bus.instance, bus.frames, {"drawn", "drawn.csv", Duration::nanoseconds(5'000'500)}), InputError);
}

TEST(PackedBus, IsReadAgainFromFibex) {
  const PackedBus bus = packed_bus(like_instance(400, 7));
  const model::Cluster cluster = bus_of(bus.instance, bus.frames, kRequest);
  const std::string text = bus_fibex(bus.instance, bus.assignment, bus.frames, cluster);
  const fibex::XmlFile xml = fibex::XmlFile::parse(text, "packed.xml");
  Findings wrong, left_out;
  check_references(xml, wrong);
  const fibex::FibexFile file = read_fibex(xml, wrong, left_out);
  EXPECT_EQ(all_sentences(wrong.list()) + all_sentences(left_out.list()), "");

  std::map<std::string, const fibex::FibexPdu*> pdus;
  for (const fibex::FibexPdu& pdu : file.pdus) pdus[pdu.id] = &pdu;
  std::map<std::string, const fibex::FibexFrame*> frames;
  for (const fibex::FibexFrame& frame : file.frames) frames[frame.id] = &frame;
  std::map<std::string, int> sent;  // signal's name -> frames
  for (const fibex::FibexTriggering& triggering : file.triggerings)
    for (const auto& place : frames.at(triggering.frame)->places)
      for (const fibex::FibexSignal& signal : pdus.at(place.pdu)->signals) {
        const auto index = static_cast<std::size_t>(std::stoi(signal.name));  // a drawn signal's name is its number
        EXPECT_EQ(signal.meaning.bits, bus.instance.signals[index].bits);
        EXPECT_EQ(signal.offset(), bus.assignment[index]->offset);
        EXPECT_EQ(triggering.slot, bus.assignment[index]->number.slot);
        EXPECT_EQ(triggering.base_cycle % bus.instance.signals[index].repetition, bus.assignment[index]->first_cycle);
        sent[signal.name] += 64 / triggering.repetition;
      }
  for (std::size_t i = 0; i < bus.instance.signals.size(); ++i)
    EXPECT_EQ(sent[std::to_string(i)], 64 / bus.instance.signals[i].repetition);
  EXPECT_EQ(all_sentences(check::check(fibex::parse_fibex(text, "packed.xml").cluster)), "");
}

}  // namespace
}  // namespace ttf::schedules::packing
