// A drive as a scene and plots for Foxglove and Lichtblick: an MCAP file with Foxglove's own schemas (foxglove.proto) and a
// few messages with numbers (plots.proto).
//
//   /transforms          FrameTransforms   frames of the sensors in the frame `vehicle`
//   /fields              SceneUpdate       each sensor's field, in its own frame
//   /truth               SceneUpdate       true objects: boxes and ids
//   /reference           SceneUpdate       the reference's fixes
//   /observations/NAME   SceneUpdate       a sensor's observations, at the instant of measuring
//   /tracks              SceneUpdate       the image's objects, at the instant to which they are predicted: boxes, ids,
//                                          velocities, ellipses of two sigma
//   /warnings            SceneUpdate       outlines of the objects of which the feature service warns
//   /image_use, /ages/NAME, /errors        numbers at each use of an image
//
// Every message has all entities of its topic, because a viewer that jumps in time reads each topic's last message alone.
// Entities that end are deleted; entities that are not renewed vanish after their lifetime. Stamps are true times since the
// start of the drive. The same records in the same order give the same bytes. Memory holds the last seconds of the drive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/exports/viewer/message_file.h"
#include "recording/records/records.h"
#include "recording/scene/moments.h"
#include "recording/scene/viewed.h"

namespace foxglove {
class SceneUpdate;
}  // namespace foxglove

namespace ttf::recording::exports::viewer {

// The entities that a topic of a scene shows.
class Shown {
 public:
  // Deletes the topic's entities that `update` no longer has.
  void replace_by(::foxglove::SceneUpdate& update, TrueTime at);

 private:
  std::set<std::string> ids_;
};

struct SceneCounts {
  std::uint64_t fields = 0;        // sensors with a known field
  std::uint64_t truths = 0;        // instants
  std::uint64_t references = 0;    // fixes
  std::uint64_t observations = 0;  // lists
  std::uint64_t images = 0, uses = 0, ages = 0, errors = 0;
  std::uint64_t unnamed = 0;  // observations and ages left out: the log has no name of their sensor
};

// An object of a used image that matches a true one: estimate minus truth.
struct ObjectErrors {
  ObjectId object{};
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;  // [m], [m/s]
  double nees = 0.0;                            // not a number if unknown
};

// Takes records in the order of MergedLogs::read(); call finish() at the end.
class FoxgloveExport final : public scene::Moments {
 public:
  // Messages wait so long for earlier ones.
  static constexpr Duration kHeldBack = scene::kNear;

  // `sensors`: by SensorId. Throws std::runtime_error if the file cannot be created.
  FoxgloveExport(const std::string& path, std::vector<scene::ViewedSensor> sensors);

  // Reports of who judges the records, each at most kHeldBack after its instant.
  void age(TrueTime used, SensorId sensor, Duration age);
  void errors(TrueTime used, std::span<const ObjectErrors> objects, std::size_t missed, std::size_t spurious);

  SceneCounts finish();  // throws std::runtime_error if a write failed

 private:
  void truth(TrueTime at, std::span<const records::TruthState> states) override;
  void list(const scene::SeenList& list) override;
  void fix(TrueTime at, const records::ReferenceFix& fix) override;
  void image(TrueTime valid_at, const records::ImageWritten& image) override;
  void use(TrueTime at, const records::FeatureUsed& use) override;
  void reached(TrueTime at) override;
  void write_sensors();

  std::vector<scene::ViewedSensor> sensors_;
  MessageFile file_;
  std::uint16_t transforms_ = 0, fields_ = 0, truth_topic_ = 0, reference_ = 0, tracks_ = 0, warnings_ = 0,
                image_use_ = 0, errors_ = 0;
  std::vector<std::uint16_t> observations_, ages_;  // by SensorId
  SceneCounts counts_;
  Shown shown_truth_, shown_tracks_, shown_warnings_;
};

}  // namespace ttf::recording::exports::viewer
