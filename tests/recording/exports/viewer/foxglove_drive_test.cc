// A whole drive as a scene: everything of the log is there, once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "recording/exports/viewer/foxglove_export.h"
#include "recording/merge/merge.h"
#include "tests/recording/exports/viewer/scene_file.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::recording::exports::viewer {
namespace {

// Counts the parts of a log.
struct InTheLog final : records::Sink {
  using records::Sink::on;
  std::map<std::pair<std::int64_t, ObjectId>, records::TruthState> truth;
  std::set<std::int64_t> instants;
  std::size_t images = 0, objects = 0, uses = 0;
  std::set<std::pair<std::int64_t, MeasurementId>> lists;
  void on(const records::TruthState& r) override {
    truth[{r.at.ns, r.object}] = r;
    instants.insert(r.at.ns);
  }
  void on(const records::ImageWritten& r) override {
    ++images;
    objects += r.objects.size();
  }
  void on(const records::FeatureUsed&) override { ++uses; }
  void on(const records::ObservationSeen& r) override { lists.insert({r.stamp.true_time.ns, r.id}); }
};

TEST(FoxgloveDrive, AllObjectsImagesAndListsOfALogAreInTheScene) {
  const sim::drives::Drive drive("scenarios/two_lasers.yaml", fusion::strategies::StrategyKind::kTt);
  const std::string log_path = log::scratch("drive.mcap"), path = log::scratch("scene.mcap");
  {
    log::LogWriter writer(log_path, {});
    drive.run(writer);
    writer.close();
  }
  std::vector<scene::ViewedSensor> sensors;
  for (const auto& sensor : drive.cluster.sensors) sensors.push_back({sensor.name, {}, std::nullopt, std::nullopt});
  const merge::MergedLogs log(std::vector<std::string>{log_path});
  FoxgloveExport out(path, sensors);
  log.read(out);
  const SceneCounts counts = out.finish();
  InTheLog in;
  log.read(in);
  EXPECT_EQ(counts.truths, in.instants.size());
  EXPECT_EQ(counts.images, in.images);
  EXPECT_EQ(counts.uses, in.uses);
  EXPECT_EQ(counts.observations, in.lists.size());

  std::ifstream bytes(path, std::ios::binary);
  const SceneFile file(std::string{std::istreambuf_iterator<char>(bytes), {}});
  EXPECT_THAT(file.problems, testing::IsEmpty());
  std::size_t boxes = 0, tracks = 0;
  for (const auto& [at, update] : file.of("/truth"))
    for (const auto& entity : update.entities()) {
      const auto object = static_cast<ObjectId>(std::stoi(entity.id().substr(std::string("object ").size())));
      const records::TruthState& is = in.truth.at({static_cast<std::int64_t>(at), object});
      EXPECT_EQ(entity.cubes(0).pose().position().x(), is.x);
      EXPECT_EQ(entity.cubes(0).pose().position().y(), is.y);
      EXPECT_EQ(entity.cubes(0).size().x(), is.length);
      ++boxes;
    }
  EXPECT_EQ(boxes, in.truth.size());
  for (const auto& [at, update] : file.of("/tracks")) tracks += static_cast<std::size_t>(update.entities_size());
  EXPECT_EQ(tracks, in.objects);
}

}  // namespace
}  // namespace ttf::recording::exports::viewer
