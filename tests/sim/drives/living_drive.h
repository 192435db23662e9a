// A drive in which nodes lose their supply, with the results of the fusion and the feature service.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/engine/cluster_simulation.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {

struct FusedList {
  MeasurementId id;
  GlobalTime measured{}, fused{};
  TrueTime at{};
  recording::records::Disposition disposition{};
};
struct SeenImage {
  TrueTime at{};
  std::uint32_t sequence = 0;
  GlobalTime valid_at{}, newest_measurement{};
  std::vector<MeasurementId> newest;
  std::vector<recording::records::ImageObject> objects;
  std::vector<double> traces;  // the objects' covariances, in their order
  bool shows(SensorId sensor, std::uint32_t sequence_number) const {
    return std::find(newest.begin(), newest.end(), MeasurementId{sensor, sequence_number}) != newest.end();
  }
};
struct SeenUse {
  TrueTime at{};
  GlobalTime global{}, valid_at{};
  std::uint32_t sequence = 0;
  bool fresh = false, stale = false;
  std::size_t objects = 0;
};

struct LivingRecords final : recording::records::Sink {
  using recording::records::Sink::on;
  std::vector<std::pair<MeasurementId, TrueTime>> measured;
  std::vector<FusedList> fused;
  std::vector<SeenImage> images;
  std::vector<SeenUse> uses;

  void on(const recording::records::Measured& record) override {
    measured.emplace_back(record.id, record.stamp.true_time);
  }
  void on(const recording::records::ListFused& record) override {
    if (record.disposition != recording::records::Disposition::kHeld)
      fused.push_back({record.id, record.measured, record.stamp.global, record.stamp.true_time, record.disposition});
  }
  void on(const recording::records::TrackState& track) override {
    if (!track.predicted_for_image) return;
    double& trace = traces_.emplace_back(0.0);
    for (std::size_t k = 0; k < 6; ++k) trace += track.covariance[7 * k];
  }
  void on(const recording::records::ImageWritten& image) override {
    images.push_back({image.stamp.true_time,
                      image.sequence,
                      image.valid_at,
                      image.newest_measurement,
                      {image.newest.begin(), image.newest.end()},
                      {image.objects.begin(), image.objects.end()},
                      std::move(traces_)});
    traces_.clear();
  }
  void on(const recording::records::FeatureUsed& use) override {
    uses.push_back({use.stamp.true_time, use.stamp.global, use.image_valid_at, use.image_sequence, use.fresh, use.stale,
                    use.objects.size()});
  }

 private:
  std::vector<double> traces_;
};

constexpr TrueTime at_s(double s) { return TrueTime{static_cast<std::int64_t>(s * 1e9)}; }

// The paper's first drive: one car ahead that both sensors see throughout.
struct LivingDrive {
  Drive drive;
  LivingRecords seen;
  std::shared_ptr<sensors::WorldScene> scene;
  NodeSetConfig nodes;
  std::unique_ptr<sim::engine::ClusterSimulation> simulation;

  explicit LivingDrive(fusion::strategies::StrategyKind strategy, recording::records::Sink* also = nullptr,
                       std::uint64_t seed = 1)
      : drive("scenarios/paper_scenario1.yaml", strategy),
        tee_(also ? std::vector<recording::records::Sink*>{&seen, also}
                  : std::vector<recording::records::Sink*>{&seen}) {
    scene = std::make_shared<sensors::WorldScene>(drive.scenario.world, seed, 0, sim::engine::kFirstCycle);
    nodes = {&drive.scenario, &drive.cluster, strategy, seed, 0, scene, nullptr};
    sim::engine::SimulationConfig config;
    config.cluster = &drive.cluster;
    config.seed = seed;
    config.make_steps = [this](NodeId node) { return make_steps(nodes, node); };
    simulation = std::make_unique<sim::engine::ClusterSimulation>(config, tee_);
  }
  SensorId sensor(const std::string& name) const { return *drive.cluster.find_sensor(name); }
  void off(const std::string& node, double at) {
    simulation->run_until(at_s(at));
    simulation->power_off(*drive.cluster.find_node(node));
  }
  void on(const std::string& node, double at) { simulation->power_on(*drive.cluster.find_node(node), at_s(at)); }
  void run_to(double at) { simulation->run_until(at_s(at)); }

 private:
  recording::records::Tee tee_;
};

}  // namespace ttf::sim::drives
