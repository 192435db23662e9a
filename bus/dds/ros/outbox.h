// The outbox holds copies of records that wait to be published. The recording thread copies them into slots
// that were allocated at construction.
//
// Laws: nothing here waits, locks or allocates. A record without room is dropped and counted, and its parts never
// join another record. One thread records, one thread (the same or another) adds healths, one thread takes.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "bus/dds/ros/health.h"
#include "bus/dds/ros/options.h"
#include "bus/dds/ros/ring.h"
#include "recording/records/records.h"

namespace ttf::bus::dds::ros {

// A real-time image. Instants are the drive's true time.
struct WaitingImage {
  explicit WaitingImage(std::size_t most_objects) { objects.reserve(most_objects); }
  TrueTime valid_at{}, written{};
  std::optional<TrueTime> newest_measurement;  // empty before the first
  std::uint32_t sequence = 0;
  std::vector<recording::records::ImageObject> objects;
};

// A step of the fusion, and the tracks after it.
struct WaitingTrack {
  TrackId id{};
  TrueTime valid_at{};
  std::array<double, 6> state{};
  std::array<double, 36> covariance{};
};
struct WaitingStep {
  explicit WaitingStep(std::size_t most_tracks) { tracks.reserve(most_tracks); }
  TrueTime at{};
  std::uint32_t step = 0;
  std::uint16_t confirmed = 0, tentative = 0;
  std::vector<WaitingTrack> tracks;
};

struct WaitingTruth {
  recording::records::TruthState state;
};

inline constexpr std::size_t kHealthText = 4096;
// All texts in a row: name, message, then keys and values in turn, each ended by a zero.
struct WaitingHealth {
  TrueTime at{};
  HealthLevel level = HealthLevel::kOk;
  std::size_t values = 0;
  std::array<char, kHealthText> text{};
};

class Outbox {
 public:
  explicit Outbox(const RosOptions& options);

  // Each returns whether the publishing thread has a new item to take.
  bool put(const recording::records::ImageWritten& image);
  bool put(const recording::records::TrackState& track);  // waits for its FusionStep
  bool put(const recording::records::FusionStep& step);
  bool put(const recording::records::TruthState& truth);  // several nodes may record one instant: it is taken once
  bool put(const Health& health);

  // Items dropped for want of room, and items that were too long.
  struct Dropped {
    std::uint64_t images = 0, steps = 0, truths = 0, healths = 0;
    std::uint64_t cut = 0;  // images and steps with more objects or tracks than there is room for
  };
  Dropped dropped() const;  // from any thread

  Ring<WaitingImage> images;
  Ring<WaitingStep> steps;
  Ring<WaitingTruth> truths;
  Ring<WaitingHealth> healths;

 private:
  void begin(std::uint32_t step);

  std::size_t most_objects_, most_tracks_;
  std::optional<std::uint32_t> step_;  // the step whose tracks come
  WaitingStep* waiting_ = nullptr;     // the slot for its tracks; nullptr: no room
  bool step_cut_ = false;
  std::vector<std::optional<TrueTime>> last_truth_;  // by object
  std::atomic<std::uint64_t> dropped_images_{0}, dropped_steps_{0}, dropped_truths_{0}, dropped_healths_{0}, cut_{0};
};

}  // namespace ttf::bus::dds::ros
