#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/instants/measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "schedules/analysis/ages.h"
#include "schedules/analysis/parameter_bounds.h"
#include "schedules/check/checker.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/exchange/cluster_yaml.h"
#include "schedules/file/inherit.h"
#include "schedules/file/loader.h"
#include "schedules/synthesis/instants/candidates.h"
#include "schedules/synthesis/instants/placement.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::instants {
namespace {

double worst_use_ms(const model::Cluster& cluster) {
  Duration worst{};
  for (const analysis::AgePath& path : analysis::measurement_ages(cluster)) worst = std::max(worst, path.use_worst);
  return in_ms(worst);
}

// The schedule that was fitted by hand (schedules/paper_fitted.yaml) is beaten, and nothing beats what was found.
TEST(SynthesizePaper, BeatsTheScheduleByHandAndIsProvenBest) {
  const plan::Plan plan = plan::load_plan(plan_path("paper"));
  const Synthesis made = synthesize(plan);
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(check::check(made.cluster).empty());
  EXPECT_TRUE(check::check_real_time(made.cluster, check::kTimeScaleOne).empty());
  const model::Cluster by_hand = check::load_checked_cluster(shipped_path("paper_fitted"));
  EXPECT_LT(worst_use_ms(made.cluster), worst_use_ms(by_hand) - 0.3);
  EXPECT_LT(made.cluster.sensors[0].period, by_hand.sensors[0].period);
  for (const Reached& one : made.reached) {
    EXPECT_TRUE(one.proven) << name_of(one.goal);
    EXPECT_EQ(one.value, one.bound) << name_of(one.goal);
  }
  // The value is that of `schedule check`, by its own walk.
  EXPECT_DOUBLE_EQ(made.reached[1].value, worst_use_ms(made.cluster));
}

// One of four chains is short. By its age, its list might be sent a period before the use. The lists in its way are too few for that,
// so the search proves a value above its bound.
TEST(SynthesizeSensors, FourSensorsAreProvenBest) {
  plan::Plan plan = plan::load_plan(plan_path("paper_two_lasers_radar"));
  plan.cycle.shortest = plan.cycle.longest = Duration::microseconds(8535);
  plan.objective = {plan::Goal::kWorstAge};
  const Synthesis made = synthesize(plan);
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(made.reached[0].proven);
  EXPECT_EQ(made.reached[0].way, "all orders tried");
  EXPECT_NEAR(made.reached[0].value, 56.984, 0.001);
}

// Periods beyond powers of two: in a round of 60 cycles, five cycles of 6.83 ms do what four of 8.535 ms do.
TEST(SynthesizePaper, ARoundOfSixtyCyclesHasOtherPeriods) {
  const plan::Plan plan = plan::load_plan(plan_path("paper_sixty_cycles"));
  std::set<int> tried;
  for (const Candidate& one : candidates(plan)) tried.insert(one.repetitions.begin(), one.repetitions.end());
  EXPECT_EQ(tried, (std::set<int>{5}));
  const Synthesis made = synthesize(plan);
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(check::check(made.cluster).empty());
  EXPECT_EQ(made.cluster.flexray.gCycleCountMax, 59);
  for (const model::Sensor& sensor : made.cluster.sensors) EXPECT_EQ(sensor.at.repetition, 5);
  for (const Reached& one : made.reached) EXPECT_TRUE(one.proven) << name_of(one.goal);
  const Synthesis four = synthesize(plan::load_plan(plan_path("paper")));
  EXPECT_LT(made.reached[0].value, four.reached[0].value);
  EXPECT_LT(made.reached[2].value, four.reached[2].value) << "slots";
  const model::Cluster again = file::parse_cluster(exchange::cluster_yaml(made.cluster, ""), "made.yaml");
  EXPECT_EQ(worst_use_ms(again), worst_use_ms(made.cluster));
}

// With a free payload, a fragment has as many elements as fit, and the slot is as short as may be. Each payload alone is no better.
TEST(SynthesizePayload, TheBestOneIsNoWorseThanAnyAlone) {
  std::string text = file::inherited(plan_path("paper_payload")).text;
  text = changed(changed(text, "shortest: 8.5 ms", "shortest: 8.6 ms"), "longest: 9 ms", "longest: 8.6 ms");
  text = changed(text, "objective: \\[[^\\]]*\\]", "objective: [worst_age]");
  const auto with = [&](int shortest, int longest) {
    const std::string payload = fmt::format("payload: {{shortest: {}, longest: {}, step: 4}}", shortest, longest);
    return synthesize(plan::parse_plan(changed(text, "payload: \\{[^}]*\\}", payload), "plan.yaml"));
  };
  const Synthesis best = with(24, 120);
  ASSERT_TRUE(best.found && best.reached[0].proven);
  int solved = 0;
  for (int bytes = 32; bytes <= 120; bytes += 4) {
    const Synthesis alone = with(bytes, bytes);
    if (!alone.found) continue;
    ++solved;
    EXPECT_GE(alone.reached[0].value, best.reached[0].value) << bytes << " bytes";
    const model::GlobalParameters& g = alone.cluster.flexray;
    EXPECT_EQ(g.gPayloadLengthStatic, bytes / 2);
    EXPECT_EQ(g.gdStaticSlot, analysis::shortest_static_slot(g));
    const model::PduLayout& image = alone.cluster.pdu(*alone.cluster.find_pdu("image"));
    EXPECT_EQ(image.elements_per_fragment, (bytes - 8) * 8 / 192) << "a header of 8 bytes, objects of 24";
    EXPECT_TRUE(check::check(file::parse_cluster(exchange::cluster_yaml(alone.cluster, ""), "made.yaml")).empty());
  }
  EXPECT_GT(solved, 15);
  // An object of the image takes 24 bytes behind a header of 8: it fits no payload below 32.
  EXPECT_THROW((void)with(24, 30), InputError);
}

// A wide range of periods has all repetitions that divide the round, and sensors of different ones.
TEST(SynthesizePaper, SensorsOfDifferentPeriodsCoincideInARound) {
  std::string text = changed(plan_text("paper"), "gCycleCountMax: 63", "gCycleCountMax: 39");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 9 ms, longest: 9 ms, step: 1 ms}");
  text = changed(text, "laser: \\{shortest: [^}]*\\}", "laser: {shortest: 36 ms, longest: 36 ms}");
  text = changed(text, "camera: \\{shortest: [^}]*\\}", "camera: {shortest: 45 ms, longest: 90 ms}");
  text = changed(text, "objective: \\[[^\\]]*\\]", "objective: [worst_age]");
  for (int i = 0; i < 2; ++i) text = changed(text, ", largest_age: 60 ms", "");
  const plan::Plan plan = plan::parse_plan(text, "plan.yaml");
  std::set<std::vector<int>> tried;
  for (const Candidate& one : candidates(plan)) tried.insert(one.repetitions);
  EXPECT_EQ(tried, (std::set<std::vector<int>>{{4, 5}, {4, 8}, {4, 10}}));
  const Synthesis made = synthesize(plan);
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(check::check(made.cluster).empty());
  EXPECT_GE(made.reached[0].value, made.reached[0].bound);
  EXPECT_DOUBLE_EQ(made.reached[0].value, worst_use_ms(made.cluster));
}

// The paper's plan in a cycle of 9 ms and a round of 40 cycles, with a range of periods for each sensor.
plan::Plan with_periods(const std::string& laser, const std::string& camera, const std::string& objective) {
  std::string text = changed(plan_text("paper"), "gCycleCountMax: 63", "gCycleCountMax: 39");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 9 ms, longest: 9 ms, step: 1 ms}");
  text = changed(text, "laser: \\{shortest: [^}]*\\}", "laser: {" + laser + "}");
  text = changed(text, "camera: \\{shortest: [^}]*\\}", "camera: {" + camera + "}");
  text = changed(text, "objective: \\[[^\\]]*\\]", "objective: [" + objective + "]");
  for (int i = 0; i < 2; ++i) text = changed(text, ", largest_age: 60 ms", "");
  return plan::parse_plan(text, "plan.yaml");
}

// Periods that differ make jitter. The search proves no least one, so those that it drops may still have the most room.
TEST(SynthesizePaper, ACandidateThatIsDroppedWithoutAProofBoundsLaterObjectives) {
  const auto made = [](const std::string& objective) {
    return synthesize(with_periods("shortest: 36 ms, longest: 72 ms", "shortest: 36 ms, longest: 90 ms", objective));
  };
  const Synthesis room = made("room"), behind = made("jitter, room");
  ASSERT_TRUE(room.found && behind.found);
  EXPECT_TRUE(room.reached[0].proven);
  EXPECT_LT(behind.reached[1].value, room.reached[0].value);
  EXPECT_EQ(behind.reached[1].bound, room.reached[0].value);
  EXPECT_FALSE(behind.reached[1].proven);
}

// A limit of jitter is kept, as an objective before others.
TEST(SynthesizeJitter, ALimitIsKept) {
  const plan::Plan plan = with_periods("shortest: 36 ms, longest: 36 ms", "shortest: 45 ms, longest: 45 ms", "jitter");
  const auto read = read_of(plan, candidates(plan).front());
  const Search free = place(read->reading, {});
  ASSERT_TRUE(free.best);
  Limits limits;
  for (limits.jitter = free.best->jitter(); *limits.jitter > 0; limits.jitter = *limits.jitter / 2) {
    const Search found = place(read->reading, limits);
    EXPECT_LE(found.best ? found.best->jitter() : 0, *limits.jitter);
    EXPECT_FALSE(found.exact);
    EXPECT_TRUE(found.best || limits.jitter < free.best->jitter());
  }
}

TEST(SynthesizePaper, WrittenAndReadAgainItIsTheSame) {
  const Synthesis made = synthesize(plan::load_plan(plan_path("paper")));
  const std::string text = exchange::cluster_yaml(made.cluster, "A heading\nof two lines");
  const model::Cluster again = file::parse_cluster(text, "made.yaml");
  EXPECT_TRUE(check::check(again).empty());
  EXPECT_EQ(exchange::cluster_yaml(again, "A heading\nof two lines"), text);
  EXPECT_EQ(worst_use_ms(again), worst_use_ms(made.cluster));
}

TEST(SynthesizePaper, TheSamePlanHasTheSameCluster) {
  const auto text = [] { return exchange::cluster_yaml(synthesize(plan::load_plan(plan_path("paper"))).cluster, ""); };
  EXPECT_EQ(text(), text());
}

TEST(SynthesizePaper, FurtherSensorsFit) {
  const plan::Plan plan = plan::load_plan(plan_path("paper_two_lasers_radar"));
  const Synthesis made = synthesize(plan);
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(check::check(made.cluster).empty());
  EXPECT_EQ(analysis::measurement_ages(made.cluster).size(), 4u);
  for (const Reached& one : made.reached) EXPECT_LE(one.bound, one.value);
  // Four tasks of 2 ms stand on one processor, so the oldest list cannot be as new as in the paper's plan.
  EXPECT_GT(made.reached[0].value, 90.5);
}

// Lists are fused in the order of their measurements, as far as clocks can resolve it.
TEST(SynthesizePaper, ListsAreFusedInTheOrderOfTheirMeasurements) {
  const Synthesis made = synthesize(plan::load_plan(plan_path("paper_two_lasers_radar")));
  struct Fused {
    Duration at, measured;
  };
  std::vector<Fused> all;
  const model::Node& fusion = made.cluster.node(*made.cluster.find_node("fusion"));
  for (const analysis::AgePath& path : analysis::measurement_ages(made.cluster)) {
    const model::Sensor& sensor = made.cluster.sensor(path.sensor);
    for (const model::Task& task : fusion.tasks)
      for (const model::PortBinding& in : task.reads)
        if (made.cluster.pdu(in.pdu).sensor == path.sensor) {
          const auto at = time_of(made.cluster.flexray, 64 + task.activation.at.base_cycle, task.activation.at.offset);
          const auto measured = time_of(made.cluster.flexray, sensor.at.base_cycle, sensor.at.offset);
          const std::int64_t period = sensor.period.ns;
          all.push_back(
              {Duration{at.ns}, Duration{measured.ns + (at.ns - path.fused_best.ns - measured.ns) / period * period}});
        }
  }
  ASSERT_EQ(all.size(), 4u);
  for (const Fused& a : all)
    for (const Fused& b : all) EXPECT_EQ(a.at < b.at, a.measured < b.measured);
}

// Instants and slots that a plan says stay where they are.
TEST(SynthesizeFixed, PartsDoNotMove) {
  std::string text = plan_text("paper");
  const Synthesis free = synthesize(plan::parse_plan(text, "plan.yaml"));
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 8600 us, longest: 8600 us, step: 100 us}");
  text = changed(text, "\\{sender: fusion, pdu: image\\}", "{slot: 30, base_cycle: 1, sender: fusion, pdu: image}");
  text = changed(text, "(step: laser_preprocessing\n *activation: \\{kind: time)", "$1, base_cycle: 0, offset: 5000");
  const Synthesis made = synthesize(plan::parse_plan(text, "plan.yaml"));
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(check::check(made.cluster).empty());
  EXPECT_EQ(made.cluster.cycle(), Duration::microseconds(8600));
  const PduId image = *made.cluster.find_pdu("image");
  for (const model::FrameSlot& frame : made.cluster.frames)
    if (frame.pdu == image) {
      EXPECT_EQ(frame.slot, 30 + frame.fragment);
      EXPECT_EQ(frame.base_cycle, 1);
    }
  const model::Task& task = made.cluster.node(*made.cluster.find_node("laser_pre")).tasks[0];
  EXPECT_EQ(task.activation.at.base_cycle, 0);
  EXPECT_EQ(task.activation.at.offset.value, 5000);
  EXPECT_GE(made.reached[0].value, free.reached[0].value);
}

// A shipped cluster with all instants said is a plan without choices: its own instants come out.
TEST(SynthesizeFixed, AClusterWithoutChoicesIsItself) {
  const std::string text = shipped_text("paper_fitted") + "\nplan: {objective: [worst_age, jitter, room]}\n";
  const Synthesis made = synthesize(plan::parse_plan(text, "plan.yaml"));
  ASSERT_TRUE(made.found);
  const model::Cluster by_hand = check::load_checked_cluster(shipped_path("paper_fitted"));
  EXPECT_EQ(exchange::cluster_yaml(made.cluster, ""), exchange::cluster_yaml(by_hand, ""));
  EXPECT_DOUBLE_EQ(made.reached[0].value, worst_use_ms(by_hand));
}

// Schedules by hand are found again, and no worse.
class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, FromAPlanItIsNoWorseThanByHand) {
  const plan::Plan plan = plan::parse_plan(without_instants(shipped_text(GetParam())) + "\nplan: {}\n", "plan.yaml");
  EXPECT_FALSE(plan.lists.empty());
  const Synthesis made = synthesize(plan);
  ASSERT_TRUE(made.found);
  EXPECT_TRUE(check::check(made.cluster).empty());
  const double by_hand = worst_use_ms(check::load_checked_cluster(shipped_path(GetParam())));
  EXPECT_LE(worst_use_ms(made.cluster), by_hand);
  EXPECT_LE(made.reached[0].bound, by_hand);
}

INSTANTIATE_TEST_SUITE_P(Clusters, Shipped,
                         testing::Values("paper_fitted", "paper_synchronised", "moving_synchronised", "twin_cameras",
                                         "laser_radar_synchronised", "two_lasers_synchronised", "surround_synchronised",
                                         "laser_and_radar_synchronised", "four_kinds_synchronised"),
                         [](const auto& parameter) { return parameter.param; });

// Camera and laser measure at once and differ in nothing: on one channel their lists have to take turns.
TEST(SynthesizeChannels, ListsOnOneChannelEachAreSentAtOnce) {
  std::string text = changed(plan_text("paper"), "objective: \\[[^\\]]*\\]", "objective: [room, slots, worst_age]");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 8600 us, longest: 8600 us, step: 100 us}");
  const Synthesis both = synthesize(plan::parse_plan(text, "plan.yaml"));
  const Synthesis one = synthesize(plan::parse_plan(
      changed(text, "plan:\n", "plan:\n  one_channel: [laser_objects, camera_objects, image]\n"), "plan.yaml"));
  ASSERT_TRUE(both.found && one.found);
  EXPECT_EQ(one.candidates, 4U * both.candidates);  // eight choices, alike in pairs
  // 29 frames in four cycles, each on one channel of two.
  const double slots = both.cluster.flexray.gNumberOfStaticSlots;
  EXPECT_NEAR(both.reached[0].value, 1.0 - (5.0 + 29.0 / 4.0) / slots, 1e-9);
  EXPECT_NEAR(one.reached[0].value, 1.0 - (5.0 + 29.0 / 8.0) / slots, 1e-9);
  EXPECT_TRUE(check::check(one.cluster).empty());
  for (const model::FrameSlot& frame : one.cluster.frames)
    EXPECT_EQ(frame.channels == model::Channels::kAB, frame.pdu == kNoPdu);
  EXPECT_LE(one.reached[1].value, both.reached[1].value);
}

// FlexRay 2.1 gives a static slot to one node in all cycles.
TEST(SynthesizeSlots, MayHaveOneSenderEach) {
  std::string text = changed(plan_text("paper"), "objective: \\[[^\\]]*\\]", "objective: [slots, worst_age]");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 8600 us, longest: 8600 us, step: 100 us}");
  const auto senders = [](const model::Cluster& cluster) {
    std::map<int, std::set<NodeId>> found;
    for (const model::FrameSlot& frame : cluster.frames) found[frame.slot].insert(frame.sender);
    return std::count_if(found.begin(), found.end(), [](const auto& slot) { return slot.second.size() > 1; });
  };
  const Synthesis shared = synthesize(plan::parse_plan(text, "plan.yaml"));
  const Synthesis owned =
      synthesize(plan::parse_plan(changed(text, "plan:\n", "plan:\n  slot_multiplexing: false\n"), "plan.yaml"));
  ASSERT_TRUE(shared.found && owned.found);
  EXPECT_GT(senders(shared.cluster), 0);
  EXPECT_EQ(senders(owned.cluster), 0);
  EXPECT_EQ(shared.reached[0].value, 18.0);  // 5 key slots, and the 13 of the image
  EXPECT_EQ(owned.reached[0].value, 34.0);   // and 9 and 7 of the lists
  EXPECT_TRUE(check::check(owned.cluster).empty());
}

TEST(SynthesizeChannels, NodesMustReceiveThem) {
  std::string text =
      changed(plan_text("paper"), "cycle: \\{[^}]*\\}", "cycle: {shortest: 8600 us, longest: 8600 us, step: 100 us}");
  text = changed(text, "plan:\n", "plan:\n  one_channel: [image]\n");
  const Synthesis made = synthesize(plan::parse_plan(
      changed(text, "flexray: \\{pKeySlotId: 5\\}", "flexray: {pKeySlotId: 5, pChannels: B}"), "plan.yaml"));
  ASSERT_TRUE(made.found);
  const PduId image = *made.cluster.find_pdu("image");
  for (const model::FrameSlot& frame : made.cluster.frames)
    EXPECT_TRUE(frame.pdu != image || frame.channels == model::Channels::kB);
}

// The slots that a plan needs are found from both sides: fewer do not suffice.
// Clocks make jitter, too, in proportion to the age. So no jitter above 0 is proven.
TEST(SynthesizeJitter, HasNoBetterBoundThanZero) {
  std::string text = changed(plan_text("paper"), "objective: \\[[^\\]]*\\]", "objective: [jitter]");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 8600 us, longest: 8600 us, step: 100 us}");
  const Synthesis made = synthesize(plan::parse_plan(text, "plan.yaml"));
  ASSERT_TRUE(made.found);
  EXPECT_GT(made.reached[0].value, 0.0);
  EXPECT_EQ(made.reached[0].bound, 0.0);
  EXPECT_FALSE(made.reached[0].proven);
}

TEST(SynthesizeSlots, FewerSlotsDoNotSuffice) {
  std::string text = changed(plan_text("paper"), "objective: \\[[^\\]]*\\]", "objective: [slots]");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 8600 us, longest: 8600 us, step: 100 us}");
  const Synthesis made = synthesize(plan::parse_plan(text, "plan.yaml"));
  ASSERT_TRUE(made.found && made.reached[0].proven);
  int last = 0;
  for (const model::FrameSlot& frame : made.cluster.frames) last = std::max(last, frame.slot);
  EXPECT_EQ(made.reached[0].value, last);
  EXPECT_EQ(last, 18);  // five key slots, and the image's thirteen; the other lists lie in other cycles
}

TEST(SynthesizeFinds, ContradictionsOfTheBusAtOnce) {
  const std::string text = changed(plan_text("paper"), "gPayloadLengthStatic: 28 ", "gPayloadLengthStatic: 20 ");
  try {
    (void)synthesize(plan::parse_plan(text, "plan.yaml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.findings()[0].sentence().find("must fit the payload of 40 bytes"), std::string::npos);
    EXPECT_GT(error.findings()[0].line, 0);
  }
}

// The best of the others is not the best of all, if other instants of a refused candidate might pass.
TEST(Synthesize, ARefusedCandidateKeepsItsBound) {
  using plan::Goal;
  const std::vector<Reached> of_all{{Goal::kDataAge, 90, 90, true, "bound"}, {Goal::kRoom, 0.3, 0.3, true, "bound"}};
  const std::vector<Reached> others{{Goal::kDataAge, 95, 95, true, "bound"}, {Goal::kRoom, 0.2, 0.2, true, "bound"}};
  const std::vector<Reached> held = bounded_by(others, of_all);
  EXPECT_EQ(held[0].bound, 90);
  EXPECT_FALSE(held[0].proven);
  EXPECT_EQ(held[1].bound, 0.3);
  EXPECT_FALSE(held[1].proven);
  for (const Reached& one : bounded_by(of_all, of_all)) EXPECT_TRUE(one.proven);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::instants
