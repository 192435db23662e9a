// The logged inputs of the fusion node, through the steps of a fresh one, give every image again, bit for
// bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "recording/log/reader.h"
#include "recording/log/writer.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/sim/drives/image_copy.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

// A fusion node's records of its images: the image and the predictions behind it.
struct FusionRecords final : recording::records::Sink {
  using recording::records::Sink::on;
  struct Prediction {
    recording::records::Stamp stamp;
    std::uint32_t step = 0;
    TrackId track{};
    GlobalTime valid_at{};
    std::vector<double> numbers;
  };
  std::vector<ImageCopy> images;
  std::vector<Prediction> predictions;  // since the last image

  void on(const recording::records::TrackState& track) override {
    if (!track.predicted_for_image) return;
    Prediction& prediction = predictions.emplace_back();
    prediction = {track.stamp, track.step, track.track, track.valid_at, {track.state.begin(), track.state.end()}};
    prediction.numbers.insert(prediction.numbers.end(), track.covariance.begin(), track.covariance.end());
  }
  void on(const recording::records::ImageWritten& image) override { images.emplace_back(image); }
};

bool same_predictions(const FusionRecords& a, const FusionRecords& b) {
  return std::equal(a.predictions.begin(), a.predictions.end(), b.predictions.begin(), b.predictions.end(),
                    [](const auto& p, const auto& q) {
                      return same(p.stamp, q.stamp) && p.step == q.step && p.track == q.track &&
                             p.valid_at == q.valid_at &&
                             std::equal(p.numbers.begin(), p.numbers.end(), q.numbers.begin(), q.numbers.end(),
                                        [](double x, double y) {
                                          return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
                                        });
                    });
}

// A task of the fusion node with its ports, driven by hand.
struct HandDrivenTask {
  std::shared_ptr<nodes::host::Step> step;
  std::vector<nodes::host::Input> inputs;
  std::vector<nodes::host::Output> outputs;
  std::map<PduId, std::vector<std::byte>> held;  // the bytes behind the inputs

  void run(const recording::records::Stamp& stamp, recording::records::Sink& sink) {
    nodes::host::StepContext context;
    context.stamp = stamp;
    context.inputs = inputs;
    context.outputs = outputs;
    context.sink = &sink;
    step->run(context);
    for (nodes::host::Input& input : inputs) input.fresh = false;
  }
};

class FusionReplay final : public recording::records::Sink {
 public:
  using recording::records::Sink::on;
  std::size_t images = 0, differences = 0, objects = 0;

  explicit FusionReplay(const Drive& drive) : cluster_(drive.cluster) {
    const NodeId node = *cluster_.find_node("fusion");
    const auto steps = make_steps({&drive.scenario, &drive.cluster, drive.strategy, 0, 0, nullptr, nullptr}, node);
    for (std::size_t t = 0; t < steps.size(); ++t) {
      const schedules::model::Task& task = cluster_.node(node).tasks[t];
      HandDrivenTask& mine = task.step == "fusion" ? fusion_ : image_output_;
      EXPECT_FALSE(mine.step) << "one task of each kind";
      mine.step = steps[t];
      for (const schedules::model::PortBinding& binding : task.reads)
        mine.inputs.push_back({binding.port, binding.pdu, &cluster_.pdu(binding.pdu), std::nullopt, false});
      for (const schedules::model::PortBinding& binding : task.writes)
        mine.outputs.emplace_back(binding.port, binding.pdu, cluster_.pdu(binding.pdu));
    }
  }
  void on(const recording::records::FusionInput& input) override {
    for (nodes::host::Input& port : fusion_.inputs) {
      if (port.pdu != input.pdu) continue;
      EXPECT_FALSE(port.fresh) << "two lists of one port in one step";
      std::vector<std::byte>& bytes = fusion_.held[input.pdu];
      bytes.assign(input.fragments.begin(), input.fragments.end());
      port.list = {input.sequence, static_cast<int>(bytes.size()) / port.layout->fragment_bytes, bytes};
      port.fresh = true;
    }
  }
  void on(const recording::records::FusionStep& step) override { fusion_.run(step.stamp, replayed_); }
  void on(const recording::records::TrackState& track) override { logged_.on(track); }
  void on(const recording::records::ImageWritten& image) override {
    logged_.on(image);
    image_output_.run(image.stamp, replayed_);
    ++images;
    objects += image.objects.size();
    if (!same(logged_.images.back(), replayed_.images.back()) || !same_predictions(logged_, replayed_)) ++differences;
    for (FusionRecords* list : {&logged_, &replayed_}) list->predictions.clear();
  }

 private:
  const schedules::model::Cluster& cluster_;
  HandDrivenTask fusion_, image_output_;
  FusionRecords logged_, replayed_;
};

std::string log_of(const Drive& drive, const std::string& name) {
  const std::string path = testing::TempDir() + "/" + name + ".mcap";
  recording::log::LogWriter log(path, {});
  drive.run(log, 3);
  log.close();
  return path;
}

TEST(Log, ReplayingTheFusionNodesInputsGivesEveryImageBitForBit) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive("scenarios/paper_scenario2.yaml", strategy);
    const std::string path = log_of(drive, "replay");
    FusionReplay replay(drive);
    recording::log::read_log(path, replay);
    EXPECT_GT(replay.images, 70u);
    EXPECT_GT(replay.objects, 60u);
    EXPECT_EQ(replay.differences, 0u) << name_of(strategy);
    std::filesystem::remove(path);
  }
}

// The comparison can fail: one bit of one input changes, and images differ.
struct OneBitFlipped final : recording::records::Sink {
  using recording::records::Sink::on;
  FusionReplay& next;
  int inputs = 0;
  explicit OneBitFlipped(FusionReplay& replay) : next(replay) {}
  void on(const recording::records::FusionInput& input) override {
    std::vector<std::byte> bytes(input.fragments.begin(), input.fragments.end());
    recording::records::FusionInput changed = input;
    changed.fragments = bytes;
    // The first of the elements' signals is a position.
    if (++inputs == 40) bytes[12] ^= std::byte{1};
    next.on(changed);
  }
  void on(const recording::records::FusionStep& step) override { next.on(step); }
  void on(const recording::records::TrackState& track) override { next.on(track); }
  void on(const recording::records::ImageWritten& image) override { next.on(image); }
};

TEST(Log, ReplayingOtherInputsGivesOtherImages) {
  const Drive drive("scenarios/paper_scenario2.yaml", StrategyKind::kAdva);
  const std::string path = log_of(drive, "replay_flipped");
  FusionReplay replay(drive);
  OneBitFlipped flipped(replay);
  recording::log::read_log(path, flipped);
  EXPECT_GT(replay.differences, 0u);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace ttf::sim::drives
