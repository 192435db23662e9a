// A bus that was written as FIBEX stands like the packing it was made of. Any other file is refused with a sentence.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/schedule/packing/signal_file.h"
#include "schedules/packing/bus.h"
#include "schedules/packing/imported/bus_signals.h"
#include "schedules/packing/packer.h"
#include "schedules/packing/variants/packer.h"
#include "schedules/packing/variants/projection.h"
#include "tests/schedules/packing/like_variants.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using table::ChannelUse;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string signals_csv(const table::Instance& instance, std::size_t count) {
  std::string text = "signal,node,period_ms,release_ms,deadline_ms,bits,variants\n";
  for (std::size_t i = 0; i < count; ++i) {
    const table::Signal& signal = instance.signals[i];
    std::string variants;
    for (std::size_t v = 0; v < instance.variants.size(); ++v)
      if ((signal.variants >> v & 1) != 0) variants += (variants.empty() ? "" : "|") + instance.variants[v];
    text += fmt::format("{},{},{},{},{},{},{}\n", signal.name, instance.nodes[static_cast<std::size_t>(signal.node)],
                        5 * signal.repetition, 5 * signal.window.earliest, 5 * (signal.window.latest + 1), signal.bits,
                        variants);
  }
  return text;
}

std::string bus_text(const table::Instance& instance, const table::Assignment& assignment) {
  std::vector<std::vector<table::PackedFrame>> vehicles{frames_of(instance, assignment)};
  add_key_slots(vehicles);
  return bus_fibex(instance, assignment, vehicles.front(),
                   bus_of(instance, vehicles.front(), {"drawn", "drawn.csv", Duration::milliseconds(5)}));
}

TEST(StandingBus, IsThePackingThatItWasMadeOf) {
  for (const ChannelUse use : {ChannelUse::kOne, ChannelUse::kSame}) {
    const table::Instance drawn = table::like_instance(400, 7);
    const SignalFile first = parse_signals(signals_csv(drawn, 300), "first.csv", {});
    const SignalFile grown = parse_signals(signals_csv(drawn, 400), "grown.csv", {});
    const auto stands = pack(first.instance);
    const auto assignment = assigned(stands.places, slot_numbers({}, stands.bins, 3, use));
    const StandingPlaces bus = parse_standing(bus_text(first.instance, assignment), "bus.xml", grown, use);
    const StandingPlaces csv = parse_standing(packing_csv(first, assignment), "packing.csv", grown, use);
    EXPECT_EQ(bus.places, csv.places);
    EXPECT_EQ(bus.numbers, csv.numbers);
    EXPECT_THAT(bus.notes, IsEmpty());
    const auto packed = [&](const StandingPlaces& standing) {
      const auto solution = pack(grown.instance, standing.places);
      return packing_csv(grown, assigned(solution.places, slot_numbers(standing.numbers, solution.bins, 3, use)));
    };
    const std::string text = packed(bus);
    EXPECT_EQ(text, packed(csv));
    const StandingPlaces again = parse_standing(text, "grown.csv", grown, use);
    for (std::size_t i = 0; i < 300; ++i)
      EXPECT_EQ(again.numbers[static_cast<std::size_t>(again.places[i]->bin)], assignment[i]->number);
  }
}

TEST(StandingBus, OfEachVariantStandsTogether) {
  const table::Instance drawn = table::like_variants(table::like_instance(200, 3), 3, 3);
  const SignalFile file = parse_signals(signals_csv(drawn, 200), "signals.csv", {});
  const auto stands = table::variants::pack_variants(file.instance);
  const auto numbers = slot_numbers({}, stands.bins, 1, ChannelUse::kOne);
  const auto assignment = assigned(stands.places, numbers);
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "standing_bus";
  std::filesystem::create_directories(folder);
  std::vector<std::string> paths;
  for (int variant = 0; variant < 3; ++variant) {
    const auto vehicle = table::variants::projection(file.instance, variant);
    paths.push_back((folder / fmt::format("{}.xml", variant)).string());
    std::ofstream(paths.back()) << bus_text(vehicle.instance, vehicle.of(assignment));
  }
  const StandingPlaces standing = read_standing(paths, file, ChannelUse::kOne);
  EXPECT_EQ(assigned(standing.places, standing.numbers), assignment);
  std::filesystem::remove_all(folder);
}

// Two signals of a node: x in every cycle, y in every 2nd one. So there are two frames.
constexpr const char* kTwo = "signal,node,period_ms,bits\nx,n,5,10\ny,n,10,8\n";

std::string bus_of_two() {
  const SignalFile file = parse_signals(kTwo, "two.csv", {});
  const table::BitPlace x{0, 0, 0}, y{0, 0, 10};
  return bus_text(file.instance, assigned({x, y}, slot_numbers({}, 1, 1, ChannelUse::kOne)));
}

std::string replaced(std::string text, const std::string& part, const std::string& by, int times = 1) {
  std::size_t at = 0;
  for (int i = 0; i < times; ++i) {
    at = text.find(part, at);
    if (at == std::string::npos) {
      ADD_FAILURE() << part << " is not in the file";
      return text;
    }
    text.replace(at, part.size(), by);
    at += by.size();
  }
  return text;
}

std::vector<std::string> refusals(const std::string& bus, const TableShape& shape = {}, const char* signals = kTwo) {
  SignalFile file = parse_signals(signals, "two.csv", {});
  file.shape = shape;
  try {
    parse_standing(bus, "bus.xml", file, ChannelUse::kOne);
  } catch (const InputError& error) {
    std::vector<std::string> sentences;
    for (const Finding& finding : error.findings()) sentences.push_back(finding.sentence());
    return sentences;
  }
  return {};
}

TEST(StandingBus, OfAnotherShapeIsRefused) {
  const std::string bus = bus_of_two();
  EXPECT_THAT(refusals(bus), IsEmpty());
  EXPECT_THAT(refusals(bus, {Duration::milliseconds(10)}),
              ElementsAre(HasSubstr("cycle = 5 ms: must be 10 ms, as --cycle says")));
  EXPECT_THAT(refusals(bus, {Duration::milliseconds(5), 64}),
              ElementsAre(HasSubstr("bus.xml:10: gPayloadLengthStatic = 2: must be 4, for the 64 bits of --payload")));
}

TEST(StandingBus, ThatChangedItsSignalsIsRefused) {
  EXPECT_THAT(refusals(bus_of_two(), {}, "signal,node,period_ms,bits\nx,m,5,10\n"),
              ElementsAre(HasSubstr(": node = n: must be m, as in two.csv:2: a signal that stands keeps")));
  EXPECT_THAT(refusals(bus_of_two(), {}, "signal,node,period_ms,bits\nx,n,10,10\ny,n,10,7\n"),
              ElementsAre(HasSubstr("period_ms = 5: must be 10"), HasSubstr("bits = 8: must be 7")));
}

TEST(StandingBus, WithoutOnePlaceOfASignalIsRefused) {
  const std::string bus = bus_of_two(), slot = "SLOT-ID-TYPE\">1<", repetition = "CYCLE-REPETITION-TYPE\">2<";
  // The second frame moves to another slot; or it is sent in half of its cycles alone.
  const std::string moved =
      bus.substr(0, bus.find(slot) + 1) + replaced(bus.substr(bus.find(slot) + 1), slot, "SLOT-ID-TYPE\">2<");
  EXPECT_THAT(refusals(moved), ElementsAre(HasSubstr("= x: must have one place, sender and length: in line ")));
  const std::size_t second = bus.find(repetition) + 1;
  const std::string slower =
      bus.substr(0, second) + replaced(bus.substr(second), repetition, "CYCLE-REPETITION-TYPE\">4<");
  EXPECT_THAT(refusals(slower), ElementsAre(HasSubstr("= x: must be sent in every cycle, or in every 2nd, 4th, 8th")));
}

TEST(StandingBus, OfUnknownBitsIsRefused) {
  const std::string bus = bus_of_two();
  const std::string order =
      "BYTE-ORDER>true</fx:IS-HIGH-LOW-BYTE-ORDER>\n            <fx:SIGNAL-REF ID-REF=\"signal_0\"";
  EXPECT_THAT(refusals(replaced(
                  bus, order,
                  "BYTE-ORDER>false</fx:IS-HIGH-LOW-BYTE-ORDER>\n            <fx:SIGNAL-REF ID-REF=\"signal_0\"", 1)),
              ElementsAre(HasSubstr("= x: must be in high-low byte order")));
  EXPECT_THAT(
      refusals(replaced(bus, "<fx:CODING-REF ID-REF=\"coding_10\" />", "")),
      ElementsAre(HasSubstr("= x: must have a signal with a coding"), HasSubstr("= x: must have a signal with")));
  const std::size_t begin = bus.find("<fx:SIGNAL-INSTANCES>"), end = bus.find("</fx:SIGNAL-INSTANCES>");
  EXPECT_THAT(refusals(bus.substr(0, begin) + "<fx:SIGNAL-INSTANCES>" + bus.substr(end)),
              ElementsAre(HasSubstr("must have signals: the bits of a PDU without them are not known")));
}

TEST(StandingBus, WithoutASenderOrDamagedIsRefused) {
  const std::string bus = bus_of_two();
  const std::size_t begin = bus.find("<fx:OUTPUT-PORT "), end = bus.find("</fx:OUTPUT-PORT>", begin) + 17;
  EXPECT_THAT(refusals(bus.substr(0, begin) + bus.substr(end)),
              ElementsAre(HasSubstr("FRAME-TRIGGERING = triggering_0_A: must have one ECU that sends it, not 0")));
  EXPECT_THAT(refusals("<fx:FIBEX"), ElementsAre(HasSubstr("bus.xml:1")));
  EXPECT_THAT(refusals("<html/>"), ElementsAre(HasSubstr("must be fx:FIBEX, the root of a FIBEX file")));
}

TEST(StandingFiles, HaveASignalAtOnePlace) {
  const SignalFile file = parse_signals(kTwo, "two.csv", {});
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "standing_files";
  std::filesystem::create_directories(folder);
  const std::string bus = (folder / "bus.xml").string(), csv = (folder / "more.csv").string();
  std::ofstream(bus) << bus_of_two();
  const auto read_with = [&](const std::string& row) -> std::string {
    std::ofstream(csv) << "signal,node,period_ms,bits,slot,first_cycle,bit_offset\n" << row;
    try {
      read_standing({bus, csv}, file, ChannelUse::kOne);
    } catch (const InputError& error) {
      return error.findings().front().sentence();
    }
    return {};
  };
  EXPECT_EQ(read_with("y,n,10,8,1,0,10\n"), "");
  EXPECT_THAT(read_with("y,n,10,8,1,1,10\n"), HasSubstr("signal = y: must have the place that it has in"));
  EXPECT_THAT(read_with("y,n,10,8,1,1,10\n"), HasSubstr(": slot 1, first cycle 0, bit 10"));
  std::filesystem::remove_all(folder);
}

TEST(BusSignals, HaveTheirPlacesAndLines) {
  const auto bus = table::imported::parse_bus_signals(bus_of_two(), "bus.xml");
  EXPECT_EQ(bus.cycle, Duration::milliseconds(5));
  EXPECT_EQ(bus.payload_words, 2);
  EXPECT_EQ(bus.cycles, 64);
  ASSERT_EQ(bus.signals.size(), 2u);
  EXPECT_EQ(bus.signals[0].name, "x");
  EXPECT_EQ(bus.signals[1].repetition, 2);
  EXPECT_EQ(bus.signals[1].place.offset, 10);
  EXPECT_LT(bus.signals[0].line, bus.signals[1].line);
}

}  // namespace
}  // namespace ttf::cli::schedule::packing
