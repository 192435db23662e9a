// Every axis of docs/use/experiments.md has its proper effect on a drive, each driven alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_bytes.h"
#include "experiments/results/statistics.h"
#include "experiments/sweep/drives.h"
#include "tests/experiments/sweep/small_sweep.h"

namespace ttf::experiments::sweep {
namespace {

// By name, as in the list.
std::map<std::string, std::string> documented_axes() {
  const std::string text = read_file(TTF_SOURCE_DIR "/docs/use/experiments.md"), begin = "\n```yaml\naxes:\n";
  const std::size_t from = text.find(begin) + begin.size();
  std::map<std::string, std::string> axes;
  std::string name;
  for (std::size_t at = from, end; text.compare(at, 3, "```") != 0; at = end + 1) {
    end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    if (line.compare(0, 2, "  ") == 0 && line[2] != ' ') name = line.substr(2, line.find(':') - 2);
    axes[name] += line + "\n";
  }
  return axes;
}

constexpr int kReplications = 4;

// One axis, driven as often as asked for.
class Varied {
 public:
  explicit Varied(const std::string& name)
      : sweep_(parse_sweep(
            fmt::format("kind: sweep\n"
                        "name: axes\n"
                        "question: What does it do?\n"
                        "scenario: ../scenarios/axes.yaml\n"
                        "seed: 3\n"
                        "replications: {}\n"
                        "paradigms:\n"
                        "  adva: {{strategy: adva}}\n"
                        "  tt: {{strategy: tt}}\n"
                        "  free: {{strategy: adva, cluster: ../schedules/paper_free_running.yaml}}\n"
                        "  unsynchronised: {{strategy: adva, cluster: ../schedules/paper_free_running.yaml, "
                        "set: {{cluster.synchronisation: false}}}}\n"
                        "axes:\n{}"
                        "measures: [face_mse_truth, position_mse_truth, nees, age_fused, age_used_newest, "
                        "age_used_newest_p99, lists_fused, precision, flexray_load]\n",
                        kReplications, documented_axes().at(name)),
            TTF_SOURCE_DIR "/experiments/axes.yaml")),
        drives_(sweep_) {}

  std::size_t points() const { return sweep_.points(); }
  // Over some replications, the same for all points.
  double mean(const std::string& measure, std::uint32_t point, const std::string& paradigm,
              int replications = kReplications) {
    results::Moments moments;
    for (int r = 0; r < replications; ++r) moments.add(value(measure, point, paradigm, r));
    return moments.mean();
  }
  double once(const std::string& measure, std::uint32_t point, const std::string& paradigm) {
    return mean(measure, point, paradigm, 1);
  }

 private:
  template <class List> static std::uint32_t place(const List& list, const std::string& name) {
    std::uint32_t at = 0;
    while (name_of(list.at(at)) != name) ++at;
    return at;
  }
  static const std::string& name_of(const Paradigm& paradigm) { return paradigm.name; }
  static const std::string& name_of(const std::string& measure) { return measure; }

  double value(const std::string& measure, std::uint32_t point, const std::string& paradigm, int replication) {
    const results::RowKey key{point, static_cast<std::uint32_t>(replication), place(sweep_.paradigms, paradigm)};
    auto& row = rows_[{key.point, key.replication, key.paradigm}];
    if (!row) row = std::make_unique<results::Row>(drives_.run(key));
    EXPECT_EQ(row->status, results::kDone);
    return row->values.at(place(sweep_.measures, measure));
  }

  SweepFile sweep_;
  SweepDrives drives_;
  std::map<std::vector<std::uint32_t>, std::unique_ptr<results::Row>> rows_;
};

TEST(Axes, AllThatAreDocumentedAreTriedHere) {
  const std::set<std::string> tried{"process_noise",
                                    "scenario",
                                    "objects",
                                    "distance",
                                    "sizes",
                                    "sensor_noise",
                                    "bias",
                                    "drawn_bias",
                                    "sensor_cycle",
                                    "bus_cycle",
                                    "sensor_phase",
                                    "slot_phase",
                                    "bus_load",
                                    "loss",
                                    "drift",
                                    "microtick",
                                    "fault_plan",
                                    "late_method",
                                    "synchronisation",
                                    "shortest_processing",
                                    "longest_processing"};
  std::set<std::string> documented;
  for (const auto& [name, text] : documented_axes()) documented.insert(name);
  EXPECT_EQ(documented, tried);
}

// The scenario's explicit values equal the defaults.
TEST(Axes, TheScenarioIsTheOneItSaysItIs) {
  const std::string text = sweep_text(1);
  const auto with = [&](const std::string& scenario) {
    std::string changed = text;
    changed.replace(changed.find("dynamics"), 8, scenario);
    const SweepFile sweep = parse_sweep(changed, TTF_SOURCE_DIR "/experiments/small.yaml");
    return SweepDrives(sweep).run({0, 0, 0}).values;
  };
  EXPECT_EQ(with("axes"), with("dynamics"));
}

// The car's deviation grows with the square root of the density, reduced by the filters. Between 0.1 and 4
// the squared error grows, but less.
TEST(Axes, ProcessNoise) {
  Varied varied("process_noise");
  for (const char* paradigm : {"adva", "tt"}) {
    const double calm = varied.mean("face_mse_truth", 0, paradigm);
    const double wild = varied.mean("face_mse_truth", 1, paradigm);
    EXPECT_GT(wild, 2 * calm);
    EXPECT_LT(wild, 40 * calm);
  }
}

// In the other drive the car turns, and shows its side.
TEST(Axes, Scenario) {
  Varied varied("scenario");
  EXPECT_GT(varied.mean("face_mse_truth", 1, "adva"), 2.0 * varied.mean("face_mse_truth", 0, "adva"));
}

// A list of 25 objects takes some milliseconds more on its CAN than a list of one.
TEST(Axes, Objects) {
  Varied varied("objects");
  for (const char* paradigm : {"adva", "tt", "free"}) {
    const double more = varied.once("age_fused", 1, paradigm) - varied.once("age_fused", 0, paradigm);
    EXPECT_GT(more, 1.0) << paradigm;
    EXPECT_LT(more, 15.7) << paradigm;
  }
  EXPECT_LT(varied.once("lists_fused", 1, "free"), 0.95 * varied.once("lists_fused", 0, "free"));
}

// A car further away is hit by fewer beams: its list is shorter, and sooner there.
TEST(Axes, Distance) {
  Varied varied("distance");
  EXPECT_LT(varied.once("age_fused", 1, "free"), varied.once("age_fused", 0, "free"));
}

// The centre lies elsewhere in another car, for all paradigms alike. Its rear does not.
TEST(Axes, Sizes) {
  Varied varied("sizes");
  for (const std::uint32_t drawn : {1u, 2u}) {
    const double added = varied.mean("position_mse_truth", drawn, "tt") - varied.mean("position_mse_truth", 0, "tt");
    EXPECT_GT(std::abs(added), 0.002);
    EXPECT_NEAR(varied.mean("position_mse_truth", drawn, "adva") - varied.mean("position_mse_truth", 0, "adva"), added,
                0.5 * std::abs(added));
    for (const char* paradigm : {"adva", "tt"}) {
      const double face = varied.mean("face_mse_truth", 0, paradigm);
      EXPECT_NEAR(varied.mean("face_mse_truth", drawn, paradigm), face, 0.2 * std::abs(added)) << paradigm;
    }
  }
}

TEST(Axes, SensorNoise) {
  Varied varied("sensor_noise");
  EXPECT_GT(varied.mean("face_mse_truth", 1, "adva"), 5 * varied.mean("face_mse_truth", 0, "adva"));
  EXPECT_NEAR(varied.once("age_fused", 1, "adva"), varied.once("age_fused", 0, "adva"), 1e-9);
}

// The camera's noise at 40 m is far above the laser's: the laser dominates, and its 0.5 m are the error.
TEST(Axes, Bias) {
  Varied varied("bias");
  for (const char* paradigm : {"adva", "tt"}) {
    const double sound = varied.mean("face_mse_truth", 0, paradigm);
    const double added = varied.mean("face_mse_truth", 1, paradigm) - sound;
    EXPECT_NEAR(added, 0.25, 0.05) << paradigm;
  }
}

// One drive's is that of another paradigm's, and not that of the next drive.
TEST(Axes, DrawnBias) {
  Varied varied("drawn_bias");
  const double added = varied.mean("face_mse_truth", 1, "adva") - varied.mean("face_mse_truth", 0, "adva");
  EXPECT_GT(added, 0.25 / 8);
  EXPECT_LT(added, 0.25 * 4);
  EXPECT_NEAR(varied.mean("face_mse_truth", 1, "tt") / varied.mean("face_mse_truth", 1, "adva"), 1.0, 0.1);
}

TEST(Axes, SensorCycle) {
  Varied varied("sensor_cycle");
  for (const char* paradigm : {"adva", "tt"}) {
    SCOPED_TRACE(paradigm);
    EXPECT_NEAR(varied.once("lists_fused", 1, paradigm) / varied.once("lists_fused", 0, paradigm), 0.5, 0.02);
    EXPECT_GT(varied.once("age_used_newest", 1, paradigm), varied.once("age_used_newest", 0, paradigm) + 10);
  }
}

// All of a cycle's slots except the image's come half as often.
TEST(Axes, BusCycle) {
  Varied varied("bus_cycle");
  EXPECT_EQ(varied.once("lists_fused", 1, "adva"), varied.once("lists_fused", 0, "adva"));
  const double load = varied.once("flexray_load", 0, "adva"), half = varied.once("flexray_load", 1, "adva");
  EXPECT_GT(half, 0.5 * load);
  EXPECT_LT(half, 0.6 * load);
  EXPECT_GT(varied.once("age_used_newest_p99", 1, "adva"), varied.once("age_used_newest_p99", 0, "adva"));
}

TEST(Axes, SensorPhase) {
  Varied varied("sensor_phase");
  EXPECT_NEAR(varied.once("age_used_newest", 1, "tt") - varied.once("age_used_newest", 0, "tt"), 5.0, 0.1);
}

TEST(Axes, SlotPhase) {
  Varied varied("slot_phase");
  ASSERT_EQ(varied.points(), 3u);
  const double first = varied.once("age_used_newest", 0, "tt");
  for (const std::uint32_t later : {1u, 2u})
    EXPECT_NEAR(varied.once("age_used_newest", later, "tt") - first, 5.0 * later, 0.1);
}

// From 26 ms on the average to 34, in every second to third list.
TEST(Axes, ShortestProcessing) {
  Varied varied("shortest_processing");
  const double more = varied.mean("age_fused", 1, "adva") - varied.mean("age_fused", 0, "adva");
  EXPECT_GT(more, 8.0 * 0.25);
  EXPECT_LT(more, 8.0 * 0.6);
}

// A sensor that waits for preprocessing measures more often when that ends sooner.
TEST(Axes, LongestProcessing) {
  Varied varied("longest_processing");
  EXPECT_GT(varied.once("lists_fused", 0, "free"), 1.05 * varied.once("lists_fused", 1, "free"));
  EXPECT_LT(varied.mean("age_fused", 0, "free"), varied.mean("age_fused", 1, "free") - 1.0);
  EXPECT_EQ(varied.once("lists_fused", 0, "adva"), varied.once("lists_fused", 1, "adva"));
}

// A list of one frame may have to wait for one that is being sent, 0.15 ms of it.
TEST(Axes, BusLoad) {
  Varied varied("bus_load");
  const double idle = varied.mean("age_fused", 0, "free"), some = varied.mean("age_fused", 1, "free"),
               much = varied.mean("age_fused", 2, "free");
  EXPECT_GT(some, idle + 0.005);
  EXPECT_GT(much, some + 0.005);
  EXPECT_LT(much, idle + 0.3);
}

// A list lost in a static slot is there again in the next cycle.
TEST(Axes, Loss) {
  Varied varied("loss");
  for (const char* paradigm : {"adva", "tt"}) {
    const double later = varied.mean("age_fused", 1, paradigm) - varied.mean("age_fused", 0, paradigm);
    EXPECT_GT(later, 2.0) << paradigm;
    EXPECT_LT(later, 10.0) << paradigm;
  }
  EXPECT_NEAR(varied.mean("age_fused", 1, "free"), varied.mean("age_fused", 0, "free"), 0.2)
      << "its lists go another way";
}

TEST(Axes, Synchronisation) {
  Varied varied("synchronisation");
  EXPECT_LT(varied.once("precision", 0, "free"), 2.0);
  EXPECT_GT(varied.once("precision", 1, "free"), 500.0);
  EXPECT_TRUE(std::isnan(varied.once("position_mse_truth", 1, "free"))) << "nothing is heard from far off";
}

// Uncorrected clocks are apart by their drifts and their initial distance.
TEST(Axes, Drift) {
  Varied varied("drift");
  const double little = varied.mean("precision", 0, "unsynchronised");
  const double much = varied.mean("precision", 1, "unsynchronised");
  EXPECT_GT(little, 10.0);
  EXPECT_LT(little, 2 * 15e-6 * 3e6 + 20) << "two clocks, 3 s";
  EXPECT_GT(much, 50 * little);
  EXPECT_LT(much, 2 * 1500e-6 * 3e6 + 20);
}

TEST(Axes, Microtick) {
  Varied varied("microtick");
  EXPECT_LT(varied.mean("precision", 1, "tt"), 0.95 * varied.mean("precision", 0, "tt"));
}

// The camera's host is away for 400 ms of 3 s: some 10 of its lists are missing.
TEST(Axes, FaultPlan) {
  Varied varied("fault_plan");
  for (const char* paradigm : {"adva", "tt"}) {
    const double missing = varied.once("lists_fused", 0, paradigm) - varied.once("lists_fused", 1, paradigm);
    EXPECT_GE(missing, 8) << paradigm;
    EXPECT_LE(missing, 16) << paradigm;
  }
}

// One list in six is late. The augmented method is exact, and c ignores the car's possible motion in between.
TEST(Axes, LateMethod) {
  Varied varied("late_method");
  const double rewinding = varied.mean("nees", 0, "free");
  EXPECT_NEAR(varied.mean("nees", 1, "free"), rewinding, 0.005 * rewinding);
  const double ignoring = varied.mean("nees", static_cast<std::uint32_t>(varied.points() - 1), "free");
  EXPECT_NE(ignoring, rewinding);
  EXPECT_NEAR(ignoring, rewinding, 0.1 * rewinding);
}

}  // namespace
}  // namespace ttf::experiments::sweep
