// The thesis's examples, the places where it contradicts itself, and properties of any frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "schedules/sequence/generator.h"
#include "schedules/sequence/history.h"
#include "schedules/sequence/intervals.h"
#include "tests/schedules/durations.h"

namespace ttf::schedules::sequence {
namespace {

// Asks for that many slots: the free time is m seconds and a half, a secondary detection takes one.
FrameRequest with_slots(int sensors, std::span<const int> interest, int slots, SlotOrder order = SlotOrder::kText) {
  return {sensors, interest, ms(1000 * sensors), ms(1000), ms(1000 * (sensors + slots) + 500), SlotRule::kFloor, order};
}

Sequence parsed(std::string_view text) {
  Sequence sequence;
  for (const char letter : text)
    sequence.push_back(letter >= 'a' ? Detection{letter - 'a', true} : Detection{letter - 'A', false});
  return sequence;
}

// Table 4: three sensors, a region of interest on A.
std::string table_4(Duration bound, Duration secondary, SlotRule slots) {
  static const std::vector<int> kA{0};
  return letters(generated({3, kA, ms(139), secondary, bound, slots}));
}

TEST(Sequence, FourSensorsOf25ms) {
  const std::vector<int> one{1};
  const Sequence primaries = generated({4, one, ms(100), ms(25), ms(100)});
  EXPECT_EQ(letters(primaries), "ABCD");
  const DetectionTimes times(4, ms(25), ms(25));
  EXPECT_EQ(frame_time(primaries, times), ms(100));
  EXPECT_EQ(frame_time(generated({4, one, ms(100), ms(25), ms(120)}), times), ms(125));
}

TEST(Sequence, IntervalsOfTheTwoOrders) {
  const DetectionTimes times(2, ms(10), ms(10));
  for (const Intervals& of : intervals(parsed("AaBb"), times)) {
    EXPECT_EQ(of.detections, 2);
    EXPECT_DOUBLE_EQ(of.mean_s, 0.020);
    EXPECT_NEAR(of.variance, 0.010 * 0.010, 1e-15) << "tau^2";
  }
  for (const Intervals& of : intervals(parsed("ABab"), times)) {
    EXPECT_DOUBLE_EQ(of.mean_s, 0.020);
    EXPECT_EQ(of.variance, 0.0);
  }
}

std::vector<int> permutation(SlotOrder order, int sensors) {
  std::vector<int> w;
  for (int place = 1; place <= sensors; ++place) w.push_back(permuted(order, place, sensors));
  return w;
}

TEST(Sequence, Permutations) {
  EXPECT_EQ(permutation(SlotOrder::kText, 6), (std::vector<int>{1, 4, 2, 5, 3, 6}));
  EXPECT_EQ(permutation(SlotOrder::kText, 5), (std::vector<int>{1, 4, 2, 5, 3}));
  EXPECT_EQ(permutation(SlotOrder::kReversed, 4), (std::vector<int>{4, 3, 2, 1}));
  for (int sensors = 1; sensors <= kMostSensors; ++sensors) {
    std::vector<int> w = permutation(SlotOrder::kText, sensors);
    std::sort(w.begin(), w.end());
    for (int i = 1; i <= sensors; ++i) EXPECT_EQ(w[static_cast<std::size_t>(i - 1)], i) << sensors;
  }
}

TEST(Sequence, ThePrintedPermutationIsNone) {
  // x_i = i for even i and i + ceil(n / 2) for odd i: 4 comes twice, and 8 is no sensor.
  std::vector<int> printed;
  for (int i = 1; i <= 6; ++i) printed.push_back(i % 2 == 0 ? i : i + 3);
  EXPECT_EQ(printed, (std::vector<int>{4, 2, 6, 4, 8, 6}));
}

TEST(Sequence, TenSlotsOfFiveSensors) {
  const std::vector<int> three{0, 1, 2};
  const Sequence sequence = generated(with_slots(5, three, 10));
  // The numbers of the printed matrix: A 1 2, B 2 3, C 1 3, D 2 3, E 1 3. Its letters say ac, bc, ab in the rows B, C, D.
  EXPECT_EQ(letters(sequence), "AabBbcCacDbcEac");
  EXPECT_NE(letters(sequence), "AabBacCbcDabEac");
  EXPECT_EQ(letters(generated(with_slots(5, three, 10, SlotOrder::kReversed))), "AbcBbcCacDacEab");
}

TEST(Sequence, ThePrintedOriginContradictsItsExample) {
  std::vector<int> ours, printed;
  for (int i = 1; i <= 10; ++i) {
    ours.push_back((3 * i + 9) / 10);
    printed.push_back((3 * i + 9) / 10 + 1);
  }
  EXPECT_EQ(ours, (std::vector<int>{1, 1, 1, 2, 2, 2, 3, 3, 3, 3})) << "the example";
  EXPECT_EQ(printed.back(), 4) << "of 3 regions";
}

TEST(Sequence, OrderOfOneRegionMattersInAColumnWithBlanks) {
  const std::vector<int> one{0};
  EXPECT_EQ(letters(generated(with_slots(3, one, 5))), "AaaBaCaa");
  EXPECT_EQ(letters(generated(with_slots(3, one, 5, SlotOrder::kReversed))), "AaBaaCaa");
  for (const int slots : {0, 3, 6, 9})
    EXPECT_EQ(generated(with_slots(3, one, slots)), generated(with_slots(3, one, slots, SlotOrder::kReversed)));
  // With more regions it matters in full columns, too.
  const std::vector<int> two{0, 1};
  EXPECT_EQ(letters(generated(with_slots(3, two, 3))), "AaBbCb");
  EXPECT_EQ(letters(generated(with_slots(3, two, 3, SlotOrder::kReversed))), "AbBbCa");
}

TEST(Sequence, RegionsAreThoseOfSensorsThatHaveOne) {
  const std::vector<int> b{1}, a_and_c{0, 2};
  EXPECT_EQ(letters(generated(with_slots(3, b, 3))), "AbBbCb") << "the program's number 1 would be A";
  EXPECT_EQ(letters(generated(with_slots(3, a_and_c, 4))), "AacBcCa");
}

TEST(Sequence, Table4ByTheTextsRule) {
  for (const Duration secondary : {us(26'840), us(27'700), us(30'500)}) {
    EXPECT_EQ(table_4(ms(0), secondary, SlotRule::kText), "ABC");
    EXPECT_EQ(table_4(ms(200), secondary, SlotRule::kText), "AaBaCa");
    EXPECT_EQ(table_4(ms(300), secondary, SlotRule::kText), "AaaBaaCaa");
  }
  // The third frame's published time is 0.305 s.
  EXPECT_EQ(ms(139) + us(27'700) * 6, us(305'200));
}

TEST(Sequence, Table4ByTheProgramsRuleNeedsTwoSecondaryTimes) {
  EXPECT_EQ(table_4(ms(200), us(15'300), SlotRule::kFloor), "AaBaCa");
  EXPECT_EQ(table_4(ms(200), us(20'300), SlotRule::kFloor), "AaBaCa");
  EXPECT_EQ(table_4(ms(300), us(23'010), SlotRule::kFloor), "AaaBaaCaa");
  EXPECT_EQ(table_4(ms(300), us(26'800), SlotRule::kFloor), "AaaBaaCaa");
  for (int secondary = 1'000; secondary <= 60'000; secondary += 50)
    EXPECT_FALSE(table_4(ms(200), us(secondary), SlotRule::kFloor) == "AaBaCa" &&
                 table_4(ms(300), us(secondary), SlotRule::kFloor) == "AaaBaaCaa")
        << secondary;
}

TEST(Sequence, NoTimeNoSecondary) {
  const std::vector<int> one{0}, none;
  // The text's rule alone would give one slot without free time.
  EXPECT_EQ(letters(generated({3, one, ms(139), ms(20), ms(139)})), "ABC");
  EXPECT_EQ(letters(generated({3, one, ms(139), ms(20), ms(100)})), "ABC");
  EXPECT_EQ(letters(generated({3, one, ms(139), ms(0), ms(300)})), "ABC") << "the time is not known yet";
  EXPECT_EQ(letters(generated({3, none, ms(139), ms(20), ms(300)})), "ABC");
  EXPECT_EQ(letters(generated({3, one, ms(139), ms(20), Duration::nanoseconds(139'000'001)})), "AaBC");
  EXPECT_EQ(generated({3, one, ms(139), Duration::nanoseconds(1), ms(300)}).size(), 3u + kMostSecondaries);
}

// Primary detections once each, as many secondary ones as slots, both as even as whole numbers allow, and the frame's bound.
TEST(Sequence, PropertiesOfAnyFrame) {
  Sequence sequence;
  for (int sensors = 1; sensors <= 5; ++sensors)
    for (unsigned chosen = 0; chosen < (1u << sensors); ++chosen)
      for (int bound = 0; bound <= 400; bound += 23)
        for (const SlotRule rule : {SlotRule::kText, SlotRule::kFloor})
          for (const SlotOrder order : {SlotOrder::kText, SlotOrder::kReversed}) {
            std::vector<int> interest;
            for (int s = 0; s < sensors; ++s)
              if (chosen >> s & 1u) interest.push_back(s);
            const FrameRequest request{sensors, interest, ms(40 * sensors), ms(17), ms(bound), rule, order};
            generate(request, sequence);
            const int slots = free_slots(request);
            std::vector<int> of_region(static_cast<std::size_t>(sensors)), behind;
            for (const Detection& detection : sequence)
              if (detection.secondary) {
                ++of_region[static_cast<std::size_t>(detection.sensor)];
                ++behind.back();
              } else {
                EXPECT_EQ(detection.sensor, static_cast<int>(behind.size())) << "in the sensors' order";
                behind.push_back(0);
              }
            ASSERT_EQ(static_cast<int>(behind.size()), sensors);
            ASSERT_EQ(static_cast<int>(sequence.size()), sensors + slots);
            for (const int count : behind) {
              EXPECT_GE(count, slots / sensors);
              EXPECT_LE(count, (slots + sensors - 1) / sensors);
            }
            for (const int sensor : interest) {
              const int regions = static_cast<int>(interest.size());
              EXPECT_GE(of_region[static_cast<std::size_t>(sensor)], slots / regions);
              EXPECT_LE(of_region[static_cast<std::size_t>(sensor)], (slots + regions - 1) / regions);
            }
            const Duration frame = frame_time(sequence, DetectionTimes(sensors, ms(40), ms(17)));
            const Duration most = std::max(ms(bound), ms(40 * sensors));
            EXPECT_LE(frame, rule == SlotRule::kText && slots > 0 ? most + ms(17) : most);
          }
}

TEST(DetectionHistory, ExpectsTheMeanOfTheLastTen) {
  DetectionHistory history(3, ms(50));
  EXPECT_EQ(history.primaries(), ms(150)) << "a first guess of 0.25 s on a machine five times as fast";
  for (int i = 0; i < 12; ++i) history.add(0, ms(i < 2 ? 900 : 30 + i));  // ... 900 ms are forgotten
  history.add(1, us(46'300));
  EXPECT_EQ(history.primary(0), us(36'500));
  EXPECT_EQ(history.primaries(), us(36'500 + 46'300 + 50'000));
  EXPECT_EQ(history.secondary(0.6), us(26'560));
  EXPECT_EQ(history.secondary(0.0), Duration{});
  DetectionHistory two(1, ms(50), 2);
  for (const int time : {900, 30, 40}) two.add(0, ms(time));
  EXPECT_EQ(two.primary(0), ms(35));
}

TEST(DetectionHistory, DetectionsOccupyWholeSteps) {
  const Duration step = ms(10);
  EXPECT_EQ(occupied(us(46'300), step), ms(50));
  EXPECT_EQ(occupied(ms(50), step), ms(50));
  EXPECT_EQ(occupied(us(27'700), step), ms(30));
  EXPECT_EQ(occupied(us(1), step), ms(20)) << "at least two";
  // Table 4's intervals of A in steps: 0.154 s and 0.061 s are published.
  const DetectionTimes times(3, occupied(us(46'300), step), occupied(us(27'700), step));
  EXPECT_DOUBLE_EQ(intervals(parsed("ABC"), times)[0].mean_s, 0.150);
  EXPECT_DOUBLE_EQ(intervals(parsed("AaBaCa"), times)[0].mean_s, 0.060);
}

TEST(BestOrder, TheTwoSensorsTakeTurns) {
  const DetectionTimes times(2, ms(10), ms(10));
  EXPECT_EQ(letters(*best_order(parsed("AaBb"), times)), "ABab");
  EXPECT_EQ(letters(*best_order(parsed("ABab"), times)), "ABab");
  EXPECT_EQ(orders(parsed("AaBb")), 6u);
  EXPECT_EQ(orders(parsed("AaaBaaCaa")), 56u);
  EXPECT_EQ(orders(parsed("AabBbcCacDbcEac"), 200'000'000), 100'900'800u);
  EXPECT_FALSE(best_order(parsed("AabBbcCacDbcEac"), times));
}

// A permutation by hand, without rotations or buffers.
double least_variance(Sequence sequence, const DetectionTimes& times) {
  std::sort(sequence.begin(), sequence.end());
  double least = mean_variance(sequence, times);
  do least = std::min(least, mean_variance(sequence, times));
  while (std::next_permutation(sequence.begin(), sequence.end()));
  return least;
}

TEST(BestOrder, IsTheBestOfAllAndTheGeneratorIsNot) {
  const DetectionTimes times(3, us(46'300), us(27'700));
  for (const char* text : {"ABC", "AaBaCa", "AaBbCb", "AacBcCa", "AabBbCc"}) {
    const Sequence sequence = parsed(text);
    EXPECT_NEAR(mean_variance(*best_order(sequence, times), times), least_variance(sequence, times), 1e-15) << text;
  }
  EXPECT_EQ(letters(*best_order(parsed("ABC"), times)), "ABC");
  // One region and a slot for every sensor: table 4's frames are the best.
  for (const char* text : {"AaBaCa", "AaaBaaCaa"}) EXPECT_EQ(letters(*best_order(parsed(text), times)), text);
  // Several regions: the blocks of the origin put the same sensor's detections together.
  const std::vector<int> all{0, 1, 2};
  const Sequence ours = generated(with_slots(3, all, 4));
  EXPECT_EQ(letters(ours), "AacBcCb");
  const Sequence best = *best_order(ours, times);
  EXPECT_EQ(letters(best), "AbCacBc");
  EXPECT_NEAR(std::sqrt(mean_variance(ours, times)), 0.05368, 1e-5);
  EXPECT_NEAR(std::sqrt(mean_variance(best, times)), 0.00840, 1e-5);
}

// Counts frames, for docs/results/detection_orders.md.
struct Tried {
  int better = 0, all = 0;  // frames whose orders are tried: with a better one, together
  int too_many = 0;         // frames with more orders than are tried

  void add(const Sequence& sequence, const DetectionTimes& times) {
    const std::optional<Sequence> best = best_order(sequence, times);
    if (!best) {
      ++too_many;
      return;
    }
    ++all;
    if (*best != sequence) ++better;
  }
};

Tried all_frames(int sensors) {
  const DetectionTimes times(sensors, us(46'300), us(27'700));
  Tried tried;
  for (unsigned chosen = 1; chosen < (1u << sensors); ++chosen) {
    std::vector<int> interest;
    for (int s = 0; s < sensors; ++s)
      if (chosen >> s & 1u) interest.push_back(s);
    for (const SlotOrder order : {SlotOrder::kText, SlotOrder::kReversed})
      for (int slots = 1; slots <= 8; ++slots) tried.add(generated(with_slots(sensors, interest, slots, order)), times);
  }
  return tried;
}

TEST(BestOrder, OfTheRulesFrames) {
  for (int sensors = 1; sensors <= 5; ++sensors)
    for (int region = 0; region < sensors; ++region)
      for (int slots = sensors; slots <= 10; ++slots) {
        const DetectionTimes times(sensors, us(46'300), us(27'700));
        const std::vector<int> one{region};
        const Sequence sequence = generated(with_slots(sensors, one, slots));
        EXPECT_EQ(letters(*best_order(sequence, times)), letters(sequence))
            << "one region, and no sensor without a slot";
      }
  const DetectionTimes times(3, us(46'300), us(27'700));
  const auto deviation_ms = [&](const Sequence& sequence) { return 1e3 * std::sqrt(mean_variance(sequence, times)); };
  const struct {
    const char* order;
    double deviation_ms;
    const char* best;
    double best_deviation_ms;
  } page[] = {{"AcBC", 5.37, "AcBC", 5.37},
              {"AbBC", 32.10, "ABCb", 5.37},
              {"AaBbCb", 39.57, "ABabCb", 10.62},
              {"AabBabCab", 22.89, "AbaBabaCb", 13.49},
              {"AacBcCa", 47.57, "ACacaBc", 13.80},
              {"AaBcCb", 61.13, "AbCaBc", 9.30},
              {"AabcBbcCac", 72.75, "AbCacBacbc", 14.30}};
  for (const auto& [order, deviation, best, best_deviation] : page) {
    const Sequence found = *best_order(parsed(order), times);
    EXPECT_EQ(letters(found), best) << order;
    EXPECT_NEAR(deviation_ms(parsed(order)), deviation, 0.006) << order;
    EXPECT_NEAR(deviation_ms(found), best_deviation, 0.006) << order;
  }
  const Tried three = all_frames(3), four = all_frames(4);
  EXPECT_EQ(three.better, 68);
  EXPECT_EQ(three.all, 112);
  EXPECT_EQ(four.better, 183);
  EXPECT_EQ(four.all, 238);
  EXPECT_EQ(four.too_many, 2);
}

}  // namespace
}  // namespace ttf::schedules::sequence
