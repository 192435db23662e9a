#include "experiments/sweep/file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "experiments/sweep/drives.h"
#include "tests/experiments/sweep/small_sweep.h"
#include "tests/support/refusals.h"

namespace ttf::experiments::sweep {
namespace {

using testing::HasSubstr;

const std::string kHead =
    "kind: sweep\nname: small\nquestion: q\nscenario: ../scenarios/dynamics.yaml\nseed: 1\nreplications: 2\n"
    "paradigms: {a: {strategy: adva}, t: {strategy: tt}}\n";

SweepFile file(const std::string& more) { return parse_sweep(kHead + more, TTF_SOURCE_DIR "/experiments/small.yaml"); }
std::string refusal(const std::string& text) {
  return support::refusal_of(
      [&] {
        const SweepFile sweep = parse_sweep(text, TTF_SOURCE_DIR "/experiments/small.yaml");
        const SweepDrives drives(sweep);
      },
      "taken");
}

TEST(SweepFile, ListsRangesSettingsAndDraws) {
  const SweepFile sweep = file(
      "axes:\n"
      "  list: {keys: [world.acceleration_noise], values: [0.5, 2]}\n"
      "  range: {keys: [cluster.sensors.camera.period], from: 10, to: 1000, count: 3, scale: logarithmic, unit: ms}\n"
      "  named: {settings: {dry: {world.own_speed: 15}, wet: {world.own_speed: 12, duration: 4 s}}}\n"
      "  load: {keys: [tracker.process_noise], uniform: [1, 3]}\n");
  ASSERT_EQ(sweep.grid().size(), 3u);
  ASSERT_EQ(sweep.drawn().size(), 1u);
  EXPECT_EQ(sweep.points(), 12u);
  EXPECT_EQ(sweep.label_of(0), "list 0.5, range 10 ms, named dry");
  EXPECT_EQ(sweep.label_of(1), "list 0.5, range 10 ms, named wet");
  EXPECT_EQ(sweep.label_of(2), "list 0.5, range 100 ms, named dry");
  EXPECT_EQ(sweep.label_of(11), "list 2, range 1000 ms, named wet");
  EXPECT_EQ(sweep.settings_of(2)[1]->number, 100.0);
  EXPECT_TRUE(sweep.grid()[1]->logarithmic);
  EXPECT_EQ(sweep.settings_of(1)[2]->edits.size(), 2u);
  const SweepFile with_unit =
      file("axes: {period: {keys: [a/cluster.sensors.camera.period], values: [42, 84], unit: ms}}\n");
  EXPECT_EQ(with_unit.label_of(1), "period 84 ms");
  EXPECT_EQ(with_unit.settings_of(1)[0]->number, 84.0);
  EXPECT_EQ(SweepDrives(with_unit).prepare({1, 0, 0}).cluster.sensors[1].period, Duration::milliseconds(84));
  EXPECT_GT(sweep.measures.size(), 10u) << "all of them where none is named";
}

TEST(SweepFile, MistakesAreRefusedWithTheirPlace) {
  const auto axis = [](const std::string& text) { return refusal(kHead + "axes:\n  one: " + text + "\n"); };
  EXPECT_THAT(axis("{keys: [tracker.process_noise], values: [1, 1]}"), HasSubstr("must not have the value 1 twice"));
  EXPECT_THAT(axis("{keys: [tracker.process_noise], from: 0, to: 4, count: 1}"), HasSubstr("count"));
  EXPECT_THAT(axis("{keys: [tracker.process_noise], from: 0, to: 4, count: 3, scale: logarithmic}"),
              HasSubstr("both ends above 0"));
  EXPECT_THAT(axis("{keys: [tracker.process_noise], uniform: [4, 1]}"),
              HasSubstr("must be two numbers, the lower one first"));
  EXPECT_THAT(axis("{keys: [tracker.process_noise], values: [1], to: 4}"), HasSubstr("small.yaml:9: axes.one.to"));
  EXPECT_THAT(axis("{keys: [world.speed], values: [1]}"), HasSubstr("world.speed: must be in the file"));
  EXPECT_THAT(axis("{keys: [world.acceleration_noise], values: [51]}"),
              AllOf(HasSubstr("dynamics.yaml:13: world.acceleration_noise = 51: must be a number 0..50 m/s^2"),
                    HasSubstr("(with a, one 51)")));
  EXPECT_THAT(axis("{keys: [cluster.sensors.laser.period], values: [80 m]}"), HasSubstr("paper_unsynchronised.yaml:"));
  EXPECT_THAT(refusal(kHead), HasSubstr("axes"));
  const std::string axes = "axes: {one: {keys: [tracker.process_noise], values: [1, 2]}}\n";
  EXPECT_EQ(refusal(kHead + axes), "taken");
  EXPECT_THAT(refusal(kHead + axes + "measures: [speed]\n"),
              HasSubstr("measures[0] = speed: must be one of position_rmse_truth"));
  EXPECT_THAT(refusal(kHead + axes + "compare: {baseline: b}\n"), HasSubstr("must be one of the paradigms"));
  EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, less: a, than: a}]\n"),
              HasSubstr("must differ from `less`"));
  EXPECT_EQ(refusal(kHead + axes + "expect: [{measure: nees, less: his, than: a}]\n"),
            TTF_SOURCE_DIR "/experiments/small.yaml:9: expect[0].less = his: must be one of the paradigms: a, t");
  EXPECT_EQ(refusal(kHead + axes + "expect: [{measure: nees, less: t}]\n"),
            TTF_SOURCE_DIR "/experiments/small.yaml:9: expect[0].than: is missing: must be a text");
  EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, agrees: speed, of: a}]\n"),
              HasSubstr("one of `measures`"));
  EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, agrees: nees, of: a}]\n"),
              HasSubstr("must differ from `measure`"));
  EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, agrees: missed, less: a}]\n"),
              HasSubstr("expect[0].of"));
  EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, agrees: age_fused, of: a}]\n"),
              HasSubstr("expect[0].agrees = age_fused: must have the unit of `measure`"));
  for (const char* margin : {"0", "-1", "much", "0 %", "101 %", "5%", "0.1 m", "nan"})
    EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, agrees: missed, of: a, margin: " + margin + "}]\n"),
                HasSubstr("must be a share above 0 and up to 100 of the second measure, as 5 %, or a difference above "
                          "0, as 0.1"))
        << margin;
  EXPECT_THAT(refusal(kHead + axes + "expect: [{measure: nees, less: a, than: t, where: {one: 3}}]\n"),
              HasSubstr("not one: 3"));
  EXPECT_THAT(refusal(kHead + axes + "colour: red\n"), HasSubstr("colour"));
  EXPECT_THAT(refusal("kind: other\n"), HasSubstr("must be sweep"));
  EXPECT_THAT(axis("{keys: [world.acceleration_noise], uniform: [-6, 12]}"),
              HasSubstr("world.acceleration_noise = -6: must be a number 0..50"));
  EXPECT_THAT(axis("{keys: [seed], values: [1]}"), HasSubstr("seed must not be varied"));
  for (const char* name : {"nees", "Status", "point"})
    EXPECT_THAT(refusal(kHead + "axes:\n  " + name + ": {keys: [tracker.process_noise], uniform: [1, 2]}\n"),
                HasSubstr("must not have the name of a measure"));
  EXPECT_THAT(refusal(kHead + "axes:\n  one: {keys: [tracker.process_noise], values: [0, 1]}\n"
                              "  two: {settings: {a: {tracker.process_noise: 0}}}\n"),
              HasSubstr("must not vary tracker.process_noise twice: one and two do"));
  std::string head = kHead;
  head.replace(head.find("name: small"), 11, "name: ..");
  EXPECT_THAT(refusal(head + axes), HasSubstr("not begin with a dot"));
  head = kHead;
  head.replace(head.find("replications: 2"), 15, "replications: 10000000");
  EXPECT_THAT(refusal(head + "axes:\n  one: {keys: [tracker.process_noise], from: 1, to: 9, count: 9}\n"),
              HasSubstr("must make at most 100000000 drives, not 180000000"));
}

const std::string kTwoAxes =
    "axes:\n  one: {keys: [tracker.process_noise], values: [1, 2, 3]}\n  only: {keys: [world.own_speed], values: "
    "[15]}\n"
    "  load: {keys: [world.acceleration_noise], uniform: [1, 3]}\n  two: {settings: {dry: {}, wet: {duration: 4 s}}}\n";

TEST(SweepFile, ComparesTheValuesOfAnAxis) {
  const SweepFile sweep = file(kTwoAxes + "compare: {axis: one, baseline: 2}\n");
  ASSERT_TRUE(sweep.compared_axis.has_value());
  EXPECT_EQ(sweep.compared_axis->axis, 0u);
  EXPECT_EQ(sweep.compared_axis->baseline, 1u);
  EXPECT_EQ(sweep.label_of(5), "one 3, only 15, two wet");
  EXPECT_EQ(sweep.moved(5, 0, 0), 1u);
  EXPECT_EQ(sweep.moved(1, 0, 2), 5u);
  EXPECT_EQ(sweep.moved(4, 2, 1), 5u);
  EXPECT_EQ(sweep.label_without(5, 0), "two wet");
  ASSERT_TRUE(sweep.reference_of(5, 1).has_value());
  EXPECT_EQ(sweep.reference_of(5, 1)->point, 3u);
  EXPECT_EQ(sweep.reference_of(5, 1)->paradigm, 1u);
  EXPECT_FALSE(sweep.reference_of(3, 0).has_value());

  const auto compare = [](const std::string& text) { return refusal(kHead + kTwoAxes + "compare: " + text + "\n"); };
  const std::string line = TTF_SOURCE_DIR "/experiments/small.yaml:13: compare.";
  EXPECT_EQ(compare("{axis: three, baseline: 1}"),
            line + "axis = three: must be an axis of the grid with two values or more: one, two");
  EXPECT_EQ(compare("{axis: only, baseline: 15}"),
            line + "axis = only: must be an axis of the grid with two values or more: one, two");
  EXPECT_THAT(compare("{axis: load, baseline: 1}"), HasSubstr("axis = load: must be an axis of the grid"));
  EXPECT_EQ(compare("{axis: two, baseline: a}"), line + "baseline = a: must be one of the values of two: dry, wet");
  EXPECT_EQ(compare("{axis: two}"), line + "baseline: is missing: must be a text");
  EXPECT_THAT(refusal(kHead + kTwoAxes + "compare: {axis: two, baseline: dry}\nstop: {half_width: 1, batch: 2}\n"),
              HasSubstr("stop.half_width = 1: must be absent with `compare.axis`"));
  EXPECT_THAT(refusal(kHead + "axes: {one: {keys: [duration], values: [3 s]}}\ncompare: {axis: one, baseline: 3 s}\n"),
              HasSubstr("must be an axis of the grid with two values or more, but there is none"));
}

TEST(SweepFile, AsksForInteractions) {
  const SweepFile sweep = file(kTwoAxes +
                               "measures: [face_mse_truth, nees]\n"
                               "interactions:\n  - {axis: one, lowers: t, more_than: a}\n"
                               "  - {measure: nees, axis: two, from: wet, to: dry, lowers: a, more_than: t}\n"
                               "  - {measure: nees, axis: two, lowers: a, more_than: t, by: ratio}\n");
  ASSERT_EQ(sweep.interactions.size(), 3u);
  const Interaction &first = sweep.interactions[0], &second = sweep.interactions[1];
  EXPECT_EQ(first.measure, 0u);
  EXPECT_EQ(first.scale, Scale::kRatio) << "an error has a unit";
  EXPECT_EQ(first.before, 0u);
  EXPECT_EQ(first.after, 2u);
  EXPECT_EQ(first.first, 1u);
  EXPECT_EQ(first.second, 0u);
  EXPECT_EQ(second.measure, 1u);
  EXPECT_EQ(second.scale, Scale::kDifference);
  EXPECT_EQ(second.axis, 2u);
  EXPECT_EQ(second.before, 1u);
  EXPECT_EQ(second.after, 0u);
  EXPECT_EQ(sweep.interactions[2].scale, Scale::kRatio);

  const auto asked = [](const std::string& text) {
    return refusal(kHead + kTwoAxes + "measures: [face_mse_truth]\ninteractions: [{" + text + "}]\n");
  };
  const std::string line = TTF_SOURCE_DIR "/experiments/small.yaml:14: interactions[0].";
  EXPECT_EQ(asked("axis: one, lowers: t, more_than: a"), "taken");
  EXPECT_EQ(asked("axis: one, lowers: buff, more_than: a"), line + "lowers = buff: must be one of the paradigms: a, t");
  EXPECT_EQ(asked("axis: one, lowers: a, more_than: a"), line + "more_than = a: must differ from `lowers`");
  EXPECT_EQ(asked("axis: only, lowers: t, more_than: a"),
            line + "axis = only: must be an axis of the grid with two values or more: one, two");
  EXPECT_EQ(asked("axis: one, to: 4, lowers: t, more_than: a"),
            line + "to = 4: must be one of the values of one: 1, 2, 3");
  EXPECT_EQ(asked("axis: one, from: 3, lowers: t, more_than: a"),
            line + "from = 3: must not change one from 3 to itself");
  EXPECT_EQ(asked("measure: nees, axis: one, lowers: t, more_than: a"),
            line + "measure = nees: must be one of `measures`");
  EXPECT_THAT(asked("axis: one, lowers: t, more_than: a, by: sum"),
              HasSubstr("by = sum: must be one of ratio, difference"));
  EXPECT_THAT(asked("axis: one, lowers: t"), HasSubstr("more_than: is missing"));

  const auto of_events = [](const std::string& text) {
    return refusal(kHead + kTwoAxes + "measures: [collision, nees]\ninteractions: [{" + text + "}]\n");
  };
  const std::string why = "must not be about collision, an event: an interaction of shares has no interval";
  EXPECT_EQ(of_events("measure: nees, axis: one, lowers: t, more_than: a"), "taken");
  EXPECT_EQ(of_events("measure: collision, axis: one, lowers: t, more_than: a"), line + "measure = collision: " + why);
  EXPECT_THAT(of_events("axis: one, lowers: t, more_than: a"), HasSubstr(why)) << "the first measure";
}

TEST(SweepFile, AFileThatIsNotThereIsTheEntrysMistake) {
  const std::string axes = "axes: {one: {keys: [tracker.process_noise], values: [1, 2]}}\n";
  std::string head = kHead;
  head.replace(head.find("dynamics.yaml"), 13, "absent.yaml");
  EXPECT_THAT(refusal(head + axes),
              AllOf(HasSubstr("experiments/small.yaml:4: scenario = "),
                    HasSubstr("scenarios/absent.yaml: must be a scenario file, but it cannot be read: ")));
  head = kHead;
  head.replace(head.find("strategy: tt"), 12, "strategy: tt, cluster: absent.yaml");
  EXPECT_THAT(refusal(head + axes),
              AllOf(HasSubstr("experiments/small.yaml:7: paradigms.t.cluster = "),
                    HasSubstr("experiments/absent.yaml: must be a cluster file, but it cannot be read: ")));
  EXPECT_THAT(refusal(kHead + "axes:\n  one: {settings: {a: {}, b: {faults: absent.yaml}}}\n"),
              AllOf(HasSubstr("experiments/small.yaml:9: faults = "), HasSubstr("must be a file of faults, but it ")));
}

TEST(SweepFile, AKeyMayBeOneParadigmsOnly) {
  const SweepFile sweep = file(
      "axes:\n"
      "  period:\n"
      "    settings:\n"
      "      \"42\": {a/cluster.sensors.camera.period: 42 ms, t/cluster.sensors.camera.repetition: 8}\n"
      "      \"84\": {a/cluster.sensors.camera.period: 84 ms, t/cluster.sensors.camera.repetition: 16}\n"
      "  noise: {keys: [a/tracker.process_noise], values: [7, 8]}\n"
      "  other: {keys: [t/tracker.process_noise], values: [9]}\n");
  const SweepDrives drives(sweep);
  const PreparedDrive free = drives.prepare({3, 0, 0}), scheduled = drives.prepare({3, 0, 1});
  EXPECT_EQ(free.cluster.sensors[1].period, Duration::milliseconds(84));
  EXPECT_EQ(scheduled.cluster.sensors[1].at.repetition, 16);
  EXPECT_EQ(free.scenario.tracker.process_noise, 8.0);
  EXPECT_EQ(scheduled.scenario.tracker.process_noise, 9.0);

  const auto axes = [](const std::string& text) { return refusal(kHead + "axes:\n" + text); };
  EXPECT_THAT(axes("  one: {keys: [b/duration], values: [3 s]}\n"),
              HasSubstr("small.yaml:9: b/duration = b: must be one of the paradigms, before the slash"));
  EXPECT_THAT(axes("  one: {keys: [a/duration], values: [3 s]}\n  two: {keys: [duration], values: [4 s]}\n"),
              HasSubstr("small.yaml:10: axes: must not vary duration twice: one and two do"));
  EXPECT_THAT(axes("  one: {settings: {x: {duration: 3 s, t/duration: 4 s}}}\n"),
              HasSubstr("must not set duration twice in x of one"));
  EXPECT_EQ(axes("  one: {keys: [a/duration], values: [3 s]}\n  two: {keys: [t/duration], values: [4 s]}\n"), "taken");
  EXPECT_THAT(axes("  one: {keys: [t/cluster.sensors.camera.period], values: [42 ms]}\n"),
              AllOf(HasSubstr("small.yaml:9: cluster.sensors.camera.period: must be in the file"),
                    HasSubstr("synchronised.yaml: only its written keys can be varied (with t, one 42 ms)")));
}

// Both keys of an instant that the cluster leaves out.
TEST(SweepFile, AnAbsentInstantMayBeVaried) {
  const SweepFile sweep = file(
      "axes:\n"
      "  use:\n"
      "    settings:\n"
      "      earliest: {t/cluster: ../schedules/paper_earliest.yaml}\n"
      "      later:\n"
      "        t/cluster: ../schedules/paper_earliest.yaml\n"
      "        t/cluster.nodes.feature.tasks.use.activation.base_cycle: 3\n"
      "        t/cluster.nodes.feature.tasks.use.activation.offset: 2000\n");
  const SweepDrives drives(sweep);
  const auto use = [&](std::uint32_t point) {
    const PreparedDrive drive = drives.prepare({point, 0, 1});
    return drive.cluster.node(*drive.cluster.find_node("feature")).tasks[0].activation.at;
  };
  EXPECT_EQ(use(0).base_cycle, 2);
  EXPECT_EQ(use(1).base_cycle, 3);
  EXPECT_EQ(use(1).offset.value, 2000);
}

TEST(SweepFile, FilesAreValues) {
  const SweepFile sweep = file(
      "axes:\n"
      "  road: {keys: [scenario], values: [../scenarios/paper_scenario1.yaml, ../scenarios/dynamics.yaml]}\n"
      "  way: {settings: {flexray: {}, can: {a/cluster: ../schedules/paper_event_triggered.yaml}}}\n"
      "  fault: {settings: {none: {}, lists: {faults: faults/lists_5.yaml}}}\n");
  const SweepDrives drives(sweep);
  const PreparedDrive plain = drives.prepare({0, 0, 0}), all = drives.prepare({7, 0, 0});
  const PreparedDrive other = drives.prepare({7, 0, 1});
  EXPECT_EQ(plain.scenario.name, "paper_scenario1");
  EXPECT_EQ(plain.cluster.name, "paper_unsynchronised");
  EXPECT_TRUE(plain.scenario.faults.empty());
  EXPECT_EQ(all.scenario.name, "dynamics");
  EXPECT_EQ(all.cluster.name, "paper_event_triggered");
  EXPECT_EQ(other.cluster.name, "paper_synchronised");
  EXPECT_EQ(all.scenario.faults.faults.size(), 1u);
  EXPECT_THAT(all.scenario.text, HasSubstr("node: gateway, probability: 0.05")) << "what is logged is what was driven";

  const auto axis = [](const std::string& text) { return refusal(kHead + "axes:\n  one: " + text + "\n"); };
  EXPECT_THAT(axis("{keys: [faults], values: [faults/none.yaml]}"), HasSubstr("faults/none.yaml"));
  EXPECT_THAT(axis("{keys: [faults], uniform: [0, 1]}"), HasSubstr("must not name files if a number is drawn"));
  EXPECT_THAT(axis("{keys: [faults], values: [../scenarios/dynamics.yaml]}"),
              HasSubstr("dynamics.yaml: this is a scenario, not a fault list"));
  EXPECT_THAT(axis("{settings: {x: {faults: faults/lists_5.yaml, scenario: ../scenarios/faulty_bus.yaml}}}"),
              HasSubstr("faulty_bus.yaml: faults: must be absent, since"));
}

TEST(SweepFile, AKeyReachesASensorByItsName) {
  const SweepFile sweep = parse_sweep(
      "kind: sweep\nname: small\nquestion: q\nscenario: ../scenarios/two_lasers.yaml\nseed: 1\nreplications: 1\n"
      "paradigms: {t: {strategy: tt}}\n"
      "axes:\n  noise: {keys: [sensors.right_laser.range_sigma], values: [0.1, 0.3]}\n"
      "  place: {keys: [sensors.left_laser.mounting.y], values: [1.2]}\n",
      TTF_SOURCE_DIR "/experiments/small.yaml");
  const auto lasers = SweepDrives(sweep).prepare({1, 0, 0}).scenario.sensors.of<sensors::laser::Kind>();
  EXPECT_EQ(lasers.of("right_laser").model.range_sigma_m, 0.3);
  EXPECT_EQ(lasers.of("left_laser").model.range_sigma_m, 0.06);
  EXPECT_EQ(lasers.of("left_laser").model.device.placement.y, 1.2);
  const std::string nowhere = "axes: {noise: {keys: [sensors.laser2.range_sigma], values: [0.1]}}\n";
  EXPECT_THAT(refusal(kHead + nowhere), HasSubstr("sensors.laser2.range_sigma: must be in the file"));
  EXPECT_THAT(refusal(kHead + "axes: {noise: {keys: [cluster.sensors.laser2.period], values: [80 ms]}}\n"),
              HasSubstr("cluster.sensors.laser2.period: must be in the file"));
}

// The grid's size is checked before it is made.
TEST(SweepFile, TooManyPointsAreRefused) {
  std::string axes = "axes:\n";
  for (int a = 0; a < 9; ++a) axes += fmt::format("  a{}: {{keys: [key{}], from: 0, to: 9, count: 10}}\n", a, a);
  EXPECT_THAT(refusal(kHead + axes), HasSubstr("must make at most 10000 points"));
}

}  // namespace
}  // namespace ttf::experiments::sweep
