// The outbox holds copies of records that wait to be published. The recording thread copies them into slots
// that were allocated at construction.
//
// Laws: nothing here waits, locks or allocates. A record without room is dropped and counted, and its parts never
// join another record. One thread records, one thread (the same or another) adds healths, one thread takes.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "bus/dds/ros/health.h"
#include "bus/dds/ros/options.h"
#include "recording/records/records.h"

namespace ttf::bus::dds::ros {

// A ring is a queue of preallocated slots from one thread to another. Neither waits, and nothing is allocated.
template <class Slot> class Ring {
 public:
  // Makes each slot from `of`.
  template <class... Of> explicit Ring(std::size_t slots, const Of&... of) {
    slots_.reserve(slots);
    for (std::size_t i = 0; i < slots; ++i) slots_.emplace_back(of...);
  }

  // For the filling thread: returns the next slot to fill, nullptr without room; push() hands it over.
  Slot* room() {
    const std::size_t filled = filled_.load(std::memory_order_relaxed);
    if (filled - emptied_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[filled % slots_.size()];
  }
  void push() { filled_.store(filled_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // For the emptying thread: returns the slot that waits longest, nullptr if none does; pop() gives it back.
  const Slot* first() const {
    const std::size_t emptied = emptied_.load(std::memory_order_relaxed);
    if (emptied == filled_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[emptied % slots_.size()];
  }
  void pop() { emptied_.store(emptied_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<Slot> slots_;
  std::atomic<std::size_t> filled_{0};   // ever; written by the filling thread
  std::atomic<std::size_t> emptied_{0};  // ever; written by the emptying thread
};

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
