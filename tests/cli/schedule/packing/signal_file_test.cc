// Files of signals and of packings: what is read, what is written, and one sentence for each mistake.
#include "cli/schedule/packing/signal_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schedules/packing/packer.h"
#include "schedules/packing/variants/packer.h"

namespace ttf::cli::schedule::packing {
namespace {

using schedules::model::Channels;
using schedules::packing::ChannelUse;
using schedules::packing::Window;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kThree =
    "signal,node,period_ms,release_ms,deadline_ms,bits\n"
    "speed,chassis,5,,,16\n"
    "\"gear, wanted\",engine,40,10,29,4\n"
    "rain,chassis,320,0,320,4\n";

SignalFile three() { return parse_signals(kThree, "signals.csv", {}); }

std::vector<std::string> sentences_of(const std::function<void()>& reads) {
  std::vector<std::string> sentences;
  try {
    reads();
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings()) sentences.push_back(finding.sentence());
  }
  return sentences;
}
std::vector<std::string> mistakes(const std::string& text) {
  return sentences_of([&] { parse_signals(text, "s.csv", {}); });
}
std::vector<std::string> standing_mistakes(const std::string& rows, ChannelUse use = ChannelUse::kOne) {
  return sentences_of([&] {
    const SignalFile file = three();
    parse_standing("signal,node,period_ms,bits,slot,first_cycle,bit_offset,channel\n" + rows, "p.csv", file, use);
  });
}

TEST(SignalFile, HasNodesWindowsAndTimes) {
  const SignalFile file = three();
  EXPECT_THAT(file.instance.nodes, ElementsAre("chassis", "engine"));
  ASSERT_THAT(file.instance.signals, SizeIs(3));
  EXPECT_EQ(file.instance.signals[1].name, "gear, wanted");
  EXPECT_EQ(file.instance.signals[1].repetition, 8);
  EXPECT_EQ(file.instance.signals[1].window, (Window{2, 5}));
  EXPECT_EQ(file.instance.signals[2].window, (Window{0, 63}));
  EXPECT_EQ(file.times[0].deadline, Duration::milliseconds(5));
  EXPECT_EQ(file.times[2].line, 4);
  EXPECT_THAT(file.impossible, IsEmpty());
}

TEST(SignalFile, NamesSignalsWithoutAPlaceAndKeepsTheOthers) {
  const SignalFile file = parse_signals(
      "signal,node,period_ms,release_ms,deadline_ms,bits\na,n,5,5,5,2\nb,n,5,0,5,33\nc,n,5,0,5,32\n", "s.csv", {});
  ASSERT_THAT(file.impossible, SizeIs(2));
  EXPECT_THAT(file.impossible[0].sentence(),
              HasSubstr("s.csv:2: signal = a: has no place: a cycle of 5 ms must begin at or after its release, 5 ms"));
  EXPECT_THAT(file.impossible[1].sentence(), HasSubstr("s.csv:3: signal = b: has no place: its 33 bits must fit"));
  EXPECT_THAT(file.instance.signals, SizeIs(3));
}

TEST(SignalFile, EachMistakeIsASentence) {
  const std::string heading = "signal,node,period_ms,bits\n";
  EXPECT_THAT(mistakes(""), ElementsAre(HasSubstr("must name the columns")));
  EXPECT_THAT(mistakes("signal,node,bits\n"), ElementsAre(HasSubstr("period_ms: is missing")));
  EXPECT_THAT(mistakes("signal,node,period_ms,bits,colour\n"),
              ElementsAre(HasSubstr("column = colour: must be one of")));
  EXPECT_THAT(mistakes("signal,node,period_ms,bits,bits\n"), ElementsAre(HasSubstr("column = bits: occurs twice")));
  EXPECT_THAT(mistakes(heading), ElementsAre(HasSubstr("must have a line for each")));
  EXPECT_THAT(mistakes(heading + "a,n,5\n"), ElementsAre(HasSubstr("s.csv:2: line = 3 fields: must have 4")));
  EXPECT_THAT(mistakes(heading + "a,n,5,1\na,n,5,1\n"),
              ElementsAre(HasSubstr("s.csv:3: signal = a: must be a name of its own: line 2")));
  EXPECT_THAT(mistakes(heading + ",n,5,1\n"), ElementsAre(HasSubstr("must be a name of 1..100")));
  EXPECT_THAT(mistakes(heading + "a,,5,1\n"), ElementsAre(HasSubstr("must be the name of the sender")));
  EXPECT_THAT(mistakes(heading + "a,n,15,1\n"),
              ElementsAre(HasSubstr(
                  "period_ms = 15: must be a cycle of 5 ms times 1, 2, 4, ...: 5, 10, 20, 40, 80, 160, 320 ms")));
  EXPECT_THAT(mistakes(heading + "a,n,2.5,1\n"), ElementsAre(HasSubstr("must be a decimal number 5..320 ms")));
  EXPECT_THAT(mistakes(heading + "a,n,5,0\n"), ElementsAre(HasSubstr("bits = 0: must be a whole number 1..2032")));
  EXPECT_THAT(mistakes(heading + "a,n,fast,many\nb,n,5,\n"), SizeIs(3));
  EXPECT_THAT(mistakes("signal,node,period_ms,bits,release_ms\na,n,5,1,6\n"),
              ElementsAre(HasSubstr("release_ms = 6: must be a decimal number 0..5 ms")));
}

constexpr const char* kWithVariants =
    "signal,node,period_ms,bits,variants\nspeed,chassis,5,16,\nrain,body,320,4,base|sport\ntaxi,cab,5,8,base\n"
    "spoiler,wing,5,8,sport\n";

TEST(SignalVariants, AreNumberedAsTheyCome) {
  const SignalFile file = parse_signals(kWithVariants, "s.csv", {});
  EXPECT_THAT(file.instance.variants, ElementsAre("base", "sport"));
  std::vector<schedules::packing::VariantSet> sets;
  for (const auto& signal : file.instance.signals) sets.push_back(signal.variants);
  EXPECT_THAT(sets, ElementsAre(schedules::packing::kAllVariants, 3u, 1u, 2u));
  EXPECT_THAT(three().instance.variants, IsEmpty());
}

TEST(SignalVariants, EachMistakeIsASentence) {
  const std::string heading = "signal,node,period_ms,bits,variants\n";
  for (const char* field :
       {"|", "base|", "|base", "base||sport", "sport line", "a/b", "12345678901234567890123456789012345678901"})
    EXPECT_THAT(mistakes(heading + "a,n,5,1," + field + "\n"),
                ElementsAre(HasSubstr("must be names as in base|sport, each of 1..40 letters")))
        << field;
  EXPECT_THAT(mistakes(heading + "a,n,5,1,base|sport|base\n"),
              ElementsAre(HasSubstr("s.csv:2: variants = base|sport|base: must name base once")));
  std::string many = "v0";
  for (int i = 1; i < 64; ++i) many += "|v" + std::to_string(i);
  EXPECT_THAT(mistakes(heading + "a,n,5,1," + many + "\n"), IsEmpty());
  EXPECT_THAT(mistakes(heading + "a,n,5,1," + many + "\nb,n,5,1,v64\n"),
              ElementsAre(HasSubstr("s.csv:3: variants = v64: must not name another variant: there are at most 64")));
}

TEST(SignalVariants, OverlapInWhatStandsUnlessAVariantHasBoth) {
  const SignalFile file = parse_signals(kWithVariants, "s.csv", {});
  const std::string heading = "signal,node,period_ms,bits,slot,first_cycle,bit_offset\n";
  const auto stand = [&](const std::string& rows) {
    return sentences_of([&] { parse_standing(heading + rows, "p.csv", file, ChannelUse::kOne); });
  };
  EXPECT_THAT(stand("taxi,cab,5,8,1,0,0\nspoiler,wing,5,8,1,0,0\n"), IsEmpty());
  EXPECT_THAT(stand("rain,body,320,4,1,0,0\nspoiler,wing,5,8,1,0,8\n"),
              ElementsAre(HasSubstr("p.csv:3: signal = spoiler: must not be in slot 1, which belongs to node body of "
                                    "signal rain, in variant sport")));
}

TEST(SignalVariants, AWrittenScheduleIsReadAgain) {
  const SignalFile file = parse_signals(kWithVariants, "s.csv", {});
  const auto solution = schedules::packing::variants::pack_variants(file.instance);
  const auto numbers = slot_numbers({}, solution.bins, 1, ChannelUse::kOne);
  const std::string text = packing_csv(file, assigned(solution.places, numbers));
  EXPECT_THAT(text, HasSubstr("bits,variants,slot"));
  EXPECT_THAT(text, HasSubstr("\nrain,body,320,0,320,4,base|sport,"));
  EXPECT_THAT(text, HasSubstr("\nspeed,chassis,5,0,5,16,,"));
  const StandingPlaces standing = parse_standing(text, "p.csv", file, ChannelUse::kOne);
  EXPECT_EQ(packing_csv(file, assigned(standing.places, standing.numbers)), text);
  EXPECT_EQ(packing_csv(parse_signals(text, "p.csv", {}), assigned(solution.places, numbers)), text);
}

TEST(StandingPlaces, AreReadByNameWithBinsWithoutAGap) {
  const SignalFile file = three();
  const StandingPlaces standing = parse_standing(
      "signal,node,period_ms,bits,slot,first_cycle,bit_offset\nrain,chassis,320,4,9,60,16\nspeed,chassis,5,16,4,0,0\n"
      "gone,chassis,5,16,4,0,16\n\"gear, wanted\",engine,40,4,,,\n",
      "p.csv", file, ChannelUse::kOne);
  EXPECT_EQ(standing.places[0]->bin, 0);
  EXPECT_FALSE(standing.places[1]);
  EXPECT_EQ(standing.places[2]->bin, 1);
  EXPECT_EQ(standing.places[2]->first_cycle, 60);
  EXPECT_EQ(standing.numbers[1].slot, 9);
  EXPECT_THAT(standing.notes,
              ElementsAre("p.csv:4: signal gone is not among the signals of signals.csv; its place is free"));
}

TEST(StandingPlaces, EachMistakeIsASentence) {
  EXPECT_THAT(standing_mistakes("speed,engine,5,16,1,0,0,A\n"),
              ElementsAre(HasSubstr("node = engine: must be chassis, as in signals.csv:2")));
  EXPECT_THAT(standing_mistakes("speed,chassis,10,16,1,0,0,A\n"),
              ElementsAre(HasSubstr("period_ms = 10: must be 5, as in")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,15,1,0,0,A\n"),
              ElementsAre(HasSubstr("bits = 15: must be 16, as in")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1024,0,0,A\n"),
              ElementsAre(HasSubstr("slot = 1024: must be a whole number 0..1023")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1,0,0,B\n"),
              ElementsAre(HasSubstr("channel = B: must be A with --channels one")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1,0,0,A\n", ChannelUse::kSame),
              ElementsAre(HasSubstr("must be AB with")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1,0,0,AB\n", ChannelUse::kIndependent),
              ElementsAre(HasSubstr("must be A or B with")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1,0,0,A\nspeed,chassis,5,16,1,0,0,A\n"),
              ElementsAre(HasSubstr("p.csv:3: signal = speed: occurs twice")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1,0,17,A\n"),
              ElementsAre(HasSubstr("p.csv:2: signal = speed: must have its 16 bits within")));
  EXPECT_THAT(standing_mistakes("speed,chassis,5,16,1,0,0,A\nrain,chassis,320,4,1,3,12,A\n"),
              ElementsAre(HasSubstr("p.csv:3: signal = rain: overlaps signal speed at bit 12 of slot 1 in cycle 3")));
}

TEST(StandingPlaces, AWrittenPackingIsReadAgain) {
  for (const ChannelUse use : {ChannelUse::kOne, ChannelUse::kSame, ChannelUse::kIndependent}) {
    const SignalFile file = three();
    const auto solution = pack(file.instance);
    const auto numbers = slot_numbers({}, solution.bins, 7, use);
    const std::string text = packing_csv(file, assigned(solution.places, numbers));
    const StandingPlaces standing = parse_standing(text, "p.csv", file, use);
    EXPECT_EQ(packing_csv(file, assigned(standing.places, standing.numbers)), text);
    EXPECT_EQ(packing_csv(parse_signals(text, "p.csv", {}), assigned(solution.places, numbers)), text);
  }
}

}  // namespace
}  // namespace ttf::cli::schedule::packing
