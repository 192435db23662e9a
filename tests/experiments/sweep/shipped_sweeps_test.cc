// The shipped experiments can be driven: the ends of each grid, with every paradigm. Where a speed has a memory,
// no car stands still or drives out of sight. A whole linear cluster's sampled error matches the covariances.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "experiments/results/equivalence.h"
#include "experiments/sweep/drives.h"
#include "experiments/sweep/driving.h"

namespace ttf::experiments::sweep {
namespace {

const std::string kFolder = TTF_SOURCE_DIR "/experiments/";

std::set<std::string> shipped() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    if (entry.path().extension() == ".yaml" &&
        ("\n" + read_file(entry.path().string())).find("\nkind: sweep\n") != std::string::npos)
      names.insert(entry.path().stem().string());
  return names;
}

// A page of docs/results has tables of this experiment, its first one. `tools/results.py check` drives all of their points.
bool has_a_page(const std::string& name) {
  const std::string command = "\n    build/release/ttfusion experiment ";
  for (const auto& entry : std::filesystem::directory_iterator(TTF_SOURCE_DIR "/docs/results")) {
    const std::string page = read_file(entry.path().string());
    const std::size_t first = page.find(command);
    if (first != std::string::npos && page.find("<!-- table") != std::string::npos &&
        page.compare(first + command.size(), name.size() + 17, "experiments/" + name + ".yaml") == 0)
      return true;
  }
  return false;
}

TEST(ShippedSweeps, CanBeDriven) {
  std::size_t without_page = 0;
  for (const std::string& name : shipped()) {
    const SweepFile sweep = load_sweep(kFolder + name + ".yaml");
    EXPECT_EQ(sweep.name, name);
    EXPECT_EQ(sweep.question.back(), '?') << name;
    if (has_a_page(name)) continue;
    ++without_page;
    const SweepDrives drives(sweep);
    const auto last = static_cast<std::uint32_t>(sweep.points() - 1);
    for (const std::uint32_t point : {std::uint32_t{0}, last})
      for (std::uint32_t paradigm = 0; paradigm < sweep.paradigms.size(); ++paradigm) {
        const results::Row row = drives.run({point, sweep.replications - 1, paradigm});
        EXPECT_EQ(row.status, results::kDone) << name << " " << sweep.label_of(point);
        EXPECT_TRUE(std::isfinite(row.values.front())) << name << " " << sweep.label_of(point);
      }
  }
  EXPECT_GE(without_page, 3u);
}

// Whether a sensor sees there. The whole car must be ahead of it.
bool is_in_sight(const sim::drives::Scenario& scenario, const schedules::model::Sensor& sensor,
                 const sim::world::ObjectState& object) {
  return sensors::kinds::Sensors::of_kind(scenario.sensors, sensor.kind, [&](const auto& kind) {
    const auto& model = kind.of(sensor.name).model;
    if constexpr (requires { model.half_field_rad; }) {
      std::vector<sim::world::ObjectState> seen{object};
      sensors::see_from(model.device.placement, seen);
      const double range = std::hypot(seen[0].x, seen[0].y), bearing = std::atan2(seen[0].y, seen[0].x);
      return range > object.length && range < model.max_range_m && std::abs(bearing) < model.half_field_rad;
    } else {
      return true;  // odometry sees nothing
    }
  });
}

// All experiments with one car whose speed has a memory. All points, all replications.
TEST(ShippedSweeps, NoCarStandsStillOrLeavesTheSensorsRange) {
  std::size_t experiments = 0;
  for (const std::string& name : shipped()) {
    const SweepFile sweep = load_sweep(kFolder + name + ".yaml");
    const SweepDrives drives(sweep);
    const auto scenario = drives.prepare({0, 0, 0}).scenario;
    // Commands decide where a driven vehicle will be.
    if (scenario.world.objects.size() != 1 || scenario.world.speed_memory == Duration{} || is_driven(scenario))
      continue;
    ++experiments;
    for (std::uint32_t point = 0; point < sweep.points(); ++point) {
      const PreparedDrive drive = drives.prepare({point, 0, 0});
      // Fog and darkness hide cars, which is what such a point asks for.
      const bool short_sighted = drive.scenario.weather.laser_range < 1.0 || drive.scenario.weather.camera_range < 1.0;
      std::size_t standing = 0, gone = 0;
      for (std::uint32_t replication = 0; replication < sweep.replications; ++replication) {
        const sim::world::World world(drive.scenario.world, sweep.seed, replication);
        // Seen from the vehicle, a car moves by about a metre between two looks.
        for (Duration at{}; at <= drive.scenario.duration; at = at + Duration::milliseconds(100)) {
          const sim::world::ObjectState car = world.state_of(ObjectId{0}, TrueTime{} + at);
          standing += car.speed + drive.scenario.world.own_speed <= 0.0;
          if (short_sighted) continue;
          for (const auto& sensor : drive.cluster.sensors) gone += !is_in_sight(drive.scenario, sensor, car);
        }
      }
      EXPECT_EQ(standing, 0u) << name << " " << sweep.label_of(point);
      EXPECT_EQ(gone, 0u) << name << " " << sweep.label_of(point);
    }
  }
  EXPECT_GE(experiments, 9u);
}

// A calm car is seen from behind. Its rear is known to a few centimetres. Its centre errs by half of the length's deviation
// from the prior's mean, and by hardly more.
TEST(ShippedSweeps, ACalmCarsCentreIsUncertainByItsLengthAlone) {
  const SweepFile sweep = load_sweep(kFolder + "distance_and_size.yaml");
  const SweepDrives drives(sweep);
  const auto column = [&](const char* name) {
    const auto found = std::find(sweep.measures.begin(), sweep.measures.end(), name);
    return static_cast<std::size_t>(found - sweep.measures.begin());
  };
  const auto means = [&](const char* size) {
    struct {
      double face = 0.0, centre = 0.0, half_length = 0.0;
    } mean;
    constexpr std::uint32_t kDrives = 150;
    for (std::uint32_t point = 0; point < sweep.points(); ++point) {
      const std::vector<const Setting*> at = sweep.settings_of(point);
      if (at[0]->label != "0.01" || at[1]->label != "45" || at[2]->label != size) continue;
      const PreparedDrive drive = drives.prepare({point, 0, 0});
      for (std::uint32_t replication = 0; replication < kDrives; ++replication) {
        const results::Row row = drives.run({point, replication, 0}, drive);
        EXPECT_EQ(row.status, results::kDone);
        mean.face += row.values[column("face_mse_truth")] / kDrives;
        mean.centre += row.values[column("position_mse_truth")] / kDrives;
        const auto& car = drive.scenario.world.objects.front();
        const double length =
            sim::world::drawn_size(car.size, {car.length, car.width}, {sweep.seed, replication, ObjectId{0}}).length;
        const double half = 0.5 * (length - drive.scenario.tracker.sizes.length);
        mean.half_length += half * half / kDrives;
      }
    }
    return mean;
  };
  const auto uniform = means("uniform"), known = means("known");
  EXPECT_GT(uniform.face, 0.0);
  EXPECT_LT(uniform.face, 0.001);
  EXPECT_NEAR(uniform.half_length, 0.031, 0.006);  // (5.01 m - 3.79 m)^2 / 12 / 4
  EXPECT_LT(uniform.centre, 1.15 * (uniform.face + uniform.half_length));
  EXPECT_GT(known.face, 0.0);
  EXPECT_LT(known.face, 0.0005);
}

// 80 drives of two cameras that see positions, all the way over CAN and FlexRay to the feature service.
TEST(ShippedSweeps, TheErrorOfAWholeClusterIsTheExpectedOne) {
  SweepFile sweep = load_sweep(kFolder + "schedule_phases.yaml");
  const SweepDrives drives(sweep);
  const auto column = [&](const char* name) {
    const auto found = std::find(sweep.measures.begin(), sweep.measures.end(), name);
    return static_cast<std::size_t>(found - sweep.measures.begin());
  };
  const std::size_t sampled = column("position_mse_truth"), expected = column("position_mse_expected");
  for (const std::uint32_t point : {1u, 2u}) {
    results::EquivalenceTest test({0.15, true});
    for (std::uint32_t replication = 0; replication < 80; ++replication) {
      const results::Row row = drives.run({point, replication, 2});
      ASSERT_EQ(row.status, results::kDone);
      test.add(row.values[sampled], row.values[expected]);
    }
    EXPECT_EQ(test.agreement(0.99), results::Agreement::kWithin) << sweep.label_of(point);
  }
}

// The same cameras behind a car ahead, of the size that `size` draws. Errors of 1 % of the range keep the cluster linear.
sim::drives::Scenario behind_a_car(const std::string& size, const std::string& sizes) {
  const std::string file = TTF_SOURCE_DIR "/scenarios/twin_cameras.yaml";
  std::string text = read_file(file);
  const auto line = [&](const std::string& begin, const std::string& with) {
    const std::size_t at = text.find(begin);
    ASSERT_NE(at, std::string::npos) << begin;
    text.replace(at, text.find('\n', at) - at, with);
  };
  line("- {name: car,", "- {name: car, x: 12.0, y: 0.0, speed: 8.0, reference: true}");
  line("yaw_rate_noise:", "yaw_rate_noise: 0.0\n  size: {draw: " + size + "}");
  line("camera: {bearing_sigma",
       "camera: {bearing_sigma: 0.004, disparity_sigma: 0.22, half_field: 1.0, "
       "miss_probability: 0.0, clutter_per_frame: 0.0}");
  line("camera: {bearing_sigma: 0.01", "camera: {bearing_sigma: 0.004, disparity_sigma: 0.22}");
  line("sizes:", "sizes: " + sizes + "\n  turn_noise: 0.000001\n  initial_turn_rate_sigma: 0.001");
  return sim::drives::parse_scenario(std::move(text), file);
}

// Both are within 10 % of the sampled ones. Widths correct lengths, or they do not. The centre's error is mostly one draw a
// drive. So many drives are needed.
TEST(ShippedSweeps, TheErrorsOfFaceAndCentreOfDrawnCarsAreTheExpectedOnes) {
  SweepFile sweep = load_sweep(kFolder + "schedule_phases.yaml");
  sweep.measures = {"face_mse_truth", "face_mse_expected", "position_mse_truth", "position_mse_expected"};
  const SweepDrives drives(sweep);
  const std::string cars = "{length: 4.65, length_sigma: 0.37, width: 1.76, width_sigma: 0.1, correlation: ";
  for (const char* correlation : {"0.82}", "0}"}) {
    PreparedDrive drive = drives.prepare({0, 0, 2});
    drive.scenario = behind_a_car("normal", cars + correlation);
    results::EquivalenceTest face({0.10, true}), centre({0.10, true});
    for (std::uint32_t replication = 0; replication < 1000; ++replication) {
      const results::Row row = drives.run({0, replication, 2}, drive);
      ASSERT_EQ(row.status, results::kDone);
      face.add(row.values[0], row.values[1]);
      centre.add(row.values[2], row.values[3]);
    }
    EXPECT_EQ(face.agreement(0.95), results::Agreement::kWithin) << correlation;
    EXPECT_EQ(centre.agreement(0.95), results::Agreement::kWithin) << correlation;
  }
}

// A returning fusion node has forgotten everything, and may count its time anew: so has the expectation. The node is away
// until 1 s. Then the filter settles within 0.8 s (scenarios/twin_cameras.yaml), from the error of one look: the mean is
// at most halfway between that error and the settled one.
TEST(ShippedSweeps, TheExpectedErrorSurvivesACrashOfTheFusionNode) {
  SweepFile sweep = load_sweep(kFolder + "schedule_phases.yaml");
  const SweepDrives drives(sweep);
  const auto found = std::find(sweep.measures.begin(), sweep.measures.end(), "position_mse_expected");
  const auto expected = static_cast<std::size_t>(found - sweep.measures.begin());
  const results::Row settled = drives.run({0, 0, 2});
  PreparedDrive drive = drives.prepare({0, 0, 2});
  std::string text = drive.scenario.text + "faults:\n  - {kind: crash, node: fusion, from: 700 ms, duration: 300 ms}\n";
  drive.scenario = sim::drives::parse_scenario(std::move(text), sweep.scenario_file);
  const results::Row crashed = drives.run({0, 0, 2}, drive);
  ASSERT_EQ(settled.status, results::kDone);
  ASSERT_EQ(crashed.status, results::kDone);
  constexpr double kOneLook = 2.0 * 0.2 * 0.2;  // [m^2]
  EXPECT_GT(crashed.values[expected], 1.2 * settled.values[expected]) << "it has forgotten something";
  EXPECT_LT(crashed.values[expected], 0.5 * (settled.values[expected] + kOneLook));
}

}  // namespace
}  // namespace ttf::experiments::sweep
