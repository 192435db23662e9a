// The records made beside a drive.
#include "sim/drives/observer.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

namespace ttf::sim::drives {
namespace {

struct TwoObjects final : sensors::Scene {
  void states_at(TrueTime at, std::vector<sim::world::ObjectState>& out) const override {
    out = {{ObjectId{0}, static_cast<double>(at.ns)}, {ObjectId{1}, 7.0}};
  }
  std::size_t objects() const override { return 2; }
};

struct Truths final : recording::records::Sink {
  std::vector<std::tuple<std::int64_t, NodeId, ObjectId, std::int64_t>> seen;  // true time, node, object, local time
  using recording::records::Sink::on;
  void on(const recording::records::TruthState& r) override {
    seen.emplace_back(r.at.ns, r.node, r.object, r.local.ns);
  }
};

recording::records::Stamp stamp(std::int64_t ns, NodeId node) {
  return {TrueTime{ns}, LocalTime{ns + static_cast<std::int64_t>(index_of(node))}, GlobalTime{}, node};
}

// Nodes measure, or use images, at one instant in any order: each records the truth once.
TEST(Observer, EveryNodeRecordsTheTruthOfItsInstantOnce) {
  constexpr NodeId kLaser{1}, kFeature{2};
  const TwoObjects scene;
  Truths truths;
  Observer observer(scene, 3, truths);
  recording::records::Measured measured;
  recording::records::FeatureUsed used;
  for (const std::int64_t ns : {100, 200}) {
    measured.stamp = stamp(ns, kLaser);
    used.stamp = stamp(ns, kFeature);
    observer.on(measured);
    observer.on(used);
    observer.on(measured);
    observer.on(used);
  }
  decltype(truths.seen) expected;
  for (const std::int64_t ns : {100, 200})
    for (const NodeId node : {kLaser, kFeature})
      for (const ObjectId object : {ObjectId{0}, ObjectId{1}})
        expected.emplace_back(ns, node, object, ns + static_cast<std::int64_t>(index_of(node)));
  EXPECT_EQ(truths.seen, expected);
}

// The second object is behind the sensors at -100 ns. At 100 ns it hides the first one.
struct OneBehindAnother final : sensors::Scene {
  void states_at(TrueTime at, std::vector<sim::world::ObjectState>& out) const override {
    out.assign(2, {});
    for (std::size_t i = 0; i < 2; ++i) {
      out[i].id = static_cast<ObjectId>(i);
      out[i].length = 4.0;
      out[i].width = 2.0;
    }
    out[0].x = 40.0;
    out[1].x = 0.2 * static_cast<double>(at.ns);
  }
  std::size_t objects() const override { return 2; }
};
struct InView final : recording::records::Sink {
  std::vector<bool> seen;
  using recording::records::Sink::on;
  void on(const recording::records::TruthState& r) override { seen.push_back(!r.out_of_view); }
};

TEST(Observer, RecordsWhichObjectsAreOutOfView) {
  const OneBehindAnother scene;
  for (const bool watches : {false, true}) {
    InView in_view;
    Observer observer(scene, 1, in_view);
    if (watches) observer.watch({{{}, {.half_angle = 0.5, .max_range = 80.0}}});
    recording::records::Measured measured;
    for (const std::int64_t ns : {-100, 100}) {
      measured.stamp = stamp(ns, NodeId{0});
      observer.on(measured);
    }
    EXPECT_EQ(in_view.seen, watches ? (std::vector{true, false, false, true}) : std::vector(4, true));
  }
}

}  // namespace
}  // namespace ttf::sim::drives
