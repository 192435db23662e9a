#include "bus/dds/ros/outbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

#include "tests/bus/dds/ros/drawn.h"
#include "tests/support/allocation_counter.h"

namespace ttf::bus::dds::ros {
namespace {

RosOptions small() {
  RosOptions options;
  options.queue = 3;
  options.most_objects = 4;
  options.most_tracks = 2;
  options.truth_objects = 2;
  return options;
}

TEST(Outbox, GivesWhatWasPut) {
  Outbox outbox(small());
  const DrawnImage image(1'000'000'000, 17, 3);
  EXPECT_TRUE(outbox.put(image.record));
  const WaitingImage* waiting = outbox.images.first();
  ASSERT_NE(waiting, nullptr);
  EXPECT_EQ(waiting->written, TrueTime{1'000'000'000});
  EXPECT_EQ(waiting->valid_at, TrueTime{1'020'000'000});  // true time, though the record says it in the node's
  EXPECT_EQ(waiting->newest_measurement, TrueTime{995'000'000});
  EXPECT_EQ(waiting->sequence, 17u);
  ASSERT_EQ(waiting->objects.size(), 3u);
  EXPECT_EQ(waiting->objects[2].track, TrackId{102});
  outbox.images.pop();
  EXPECT_EQ(outbox.images.first(), nullptr);
}

TEST(Outbox, AnImageBeforeTheFirstMeasurementHasNoNewest) {
  Outbox outbox(small());
  DrawnImage image(1'000'000'000, 17, 0);
  image.record.newest = {};
  outbox.put(image.record);
  EXPECT_EQ(outbox.images.first()->newest_measurement, std::nullopt);
}

TEST(Outbox, RecordsWithoutRoomAreDroppedAndCountedTheNewestFirst) {
  Outbox outbox(small());
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(outbox.put(DrawnImage(i, i, 1).record), i < 3);
  EXPECT_EQ(outbox.dropped().images, 2u);
  for (std::uint32_t i = 0; i < 3; ++i, outbox.images.pop()) EXPECT_EQ(outbox.images.first()->sequence, i);
  EXPECT_EQ(outbox.images.first(), nullptr);
  EXPECT_TRUE(outbox.put(DrawnImage(9, 9, 1).record));  // room again
  EXPECT_EQ(outbox.dropped().images, 2u);
  EXPECT_EQ(outbox.dropped().steps + outbox.dropped().truths + outbox.dropped().healths + outbox.dropped().cut, 0u);
}

TEST(Outbox, TooManyObjectsAreCutAndCounted) {
  Outbox outbox(small());
  outbox.put(DrawnImage(0, 0, 4).record);
  EXPECT_EQ(outbox.dropped().cut, 0u);
  outbox.put(DrawnImage(1, 1, 5).record);
  EXPECT_EQ(outbox.dropped().cut, 1u);
  outbox.images.pop();
  EXPECT_EQ(outbox.images.first()->objects.size(), 4u);
}

TEST(Outbox, TracksWaitForTheirStep) {
  Outbox outbox(small());
  EXPECT_FALSE(outbox.put(DrawnTrack(1'000'000'000, 5, 31).record));
  EXPECT_FALSE(outbox.put(DrawnTrack(1'000'000'000, 5, 99, true).record));  // an image's prediction, no state
  EXPECT_FALSE(outbox.put(DrawnTrack(1'000'000'000, 5, 32).record));
  EXPECT_EQ(outbox.steps.first(), nullptr);
  EXPECT_TRUE(outbox.put(recording::records::FusionStep{stamp_at(1'000'000'000), 5, 2, 7}));
  const WaitingStep* step = outbox.steps.first();
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->at, TrueTime{1'000'000'000});
  EXPECT_EQ(step->step, 5u);
  EXPECT_EQ(step->confirmed, 2u);
  EXPECT_EQ(step->tentative, 7u);
  ASSERT_EQ(step->tracks.size(), 2u);
  EXPECT_EQ(step->tracks[1].id, TrackId{32});
  EXPECT_EQ(step->tracks[1].valid_at, TrueTime{998'000'000});
  EXPECT_EQ(step->tracks[1].state, DrawnTrack(0, 0, 32).state);
  EXPECT_EQ(step->tracks[1].covariance, DrawnTrack(0, 0, 32).covariance);
}

TEST(Outbox, AStepHasItsOwnTracksOnly) {
  Outbox outbox(small());
  outbox.put(DrawnTrack(0, 5, 31).record);  // for a step that never ended: its node lost its supply
  outbox.put(DrawnTrack(1, 6, 41).record);
  outbox.put(recording::records::FusionStep{stamp_at(1), 6, 1, 0});
  outbox.put(recording::records::FusionStep{stamp_at(2), 7, 0, 0});
  ASSERT_EQ(outbox.steps.first()->tracks.size(), 1u);
  EXPECT_EQ(outbox.steps.first()->tracks[0].id, TrackId{41});
  outbox.steps.pop();
  EXPECT_TRUE(outbox.steps.first()->tracks.empty());
}

// A step without room for one part is dropped whole, even when room returns before its end.
TEST(Outbox, AStepIsDroppedWhole) {
  Outbox outbox(small());
  for (std::uint32_t step = 0; step < 3; ++step) outbox.put(recording::records::FusionStep{stamp_at(step), step, 0, 0});
  outbox.put(DrawnTrack(3, 3, 31).record);
  outbox.steps.pop();
  outbox.put(DrawnTrack(3, 3, 32).record);
  EXPECT_FALSE(outbox.put(recording::records::FusionStep{stamp_at(3), 3, 2, 0}));
  EXPECT_EQ(outbox.dropped().steps, 1u);
  outbox.put(DrawnTrack(4, 4, 33).record);
  EXPECT_TRUE(outbox.put(recording::records::FusionStep{stamp_at(4), 4, 1, 0}));
  outbox.steps.pop();
  outbox.steps.pop();
  EXPECT_EQ(outbox.steps.first()->step, 4u);
  EXPECT_EQ(outbox.steps.first()->tracks.size(), 1u);
}

TEST(Outbox, TooManyTracksAreCutAndCountedOnce) {
  Outbox outbox(small());
  for (int track = 0; track < 4; ++track) outbox.put(DrawnTrack(0, 1, track).record);
  outbox.put(recording::records::FusionStep{stamp_at(0), 1, 4, 0});
  EXPECT_EQ(outbox.steps.first()->tracks.size(), 2u);
  EXPECT_EQ(outbox.steps.first()->confirmed, 4u);
  EXPECT_EQ(outbox.dropped().cut, 1u);
}

TEST(Outbox, TheTruthOfAnInstantIsTakenOnceFromAnySender) {
  Outbox outbox(small());
  EXPECT_TRUE(outbox.put(truth_at(100, 0, 1)));
  EXPECT_TRUE(outbox.put(truth_at(100, 1, 1)));
  EXPECT_FALSE(outbox.put(truth_at(100, 0, 2)));  // another node, the same instant
  EXPECT_FALSE(outbox.put(truth_at(90, 0, 2)));   // already past
  EXPECT_FALSE(outbox.put(truth_at(200, 2, 1)));  // object 2 was not requested
  EXPECT_TRUE(outbox.put(truth_at(200, 0, 2)));
  EXPECT_EQ(outbox.dropped().truths, 0u);
  EXPECT_EQ(outbox.truths.first()->state.object, ObjectId{0});
}

// Else it would be missing, though there was room when another node reported it.
TEST(Outbox, ATruthThatHadNoRoomMayComeAgain) {
  Outbox outbox(small());  // room for 3 instants of 2 objects
  for (std::int64_t at = 0; at < 6; ++at) EXPECT_TRUE(outbox.put(truth_at(at, 0)));
  EXPECT_FALSE(outbox.put(truth_at(6, 0, 1)));
  EXPECT_EQ(outbox.dropped().truths, 1u);
  outbox.truths.pop();
  EXPECT_TRUE(outbox.put(truth_at(6, 0, 2)));
}

TEST(Outbox, AHealthIsKeptAsText) {
  Outbox outbox(small());
  const HealthValue values[] = {{"late wake-ups", "3"}, {"state", ""}};
  EXPECT_TRUE(outbox.put(Health{TrueTime{5}, HealthLevel::kWarn, "fusion: schedule", "normal active", values}));
  const WaitingHealth* health = outbox.healths.first();
  EXPECT_EQ(health->values, 2u);
  EXPECT_EQ(health->level, HealthLevel::kWarn);
  using namespace std::string_literals;
  const std::string expected =
      "fusion: schedule\0normal active\0late wake-ups\0"
      "3\0state\0\0"s;
  EXPECT_EQ(std::string(health->text.data(), expected.size()), expected);
}

TEST(Outbox, AHealthThatIsTooLongIsDropped) {
  Outbox outbox(small());
  const std::string most(kHealthText - 2, 'x');  // with its zero, and that of the empty message
  EXPECT_TRUE(outbox.put(Health{{}, HealthLevel::kOk, most, "", {}}));
  EXPECT_EQ(outbox.dropped().healths, 0u);
  const std::string more = most + 'x';
  EXPECT_FALSE(outbox.put(Health{{}, HealthLevel::kOk, more, "", {}}));
  EXPECT_EQ(outbox.dropped().healths, 1u);
}

TEST(Outbox, AllocatesNothingOnceItIsThere) {
  Outbox outbox(small());
  const DrawnImage image(1, 1, 9);
  const DrawnTrack track(1, 1, 3);
  const HealthValue values[] = {{"late wake-ups", "3"}};
  const std::int64_t before = support::allocations();
  for (std::uint32_t round = 0; round < 20; ++round) {
    outbox.put(image.record);
    for (int i = 0; i < 5; ++i) outbox.put(track.record);
    outbox.put(recording::records::FusionStep{stamp_at(1), 1, 5, 0});
    outbox.put(truth_at(round, 0));
    outbox.put(Health{TrueTime{1}, HealthLevel::kOk, "fusion", "fine", values});
    if (round % 3 == 0) {
      outbox.images.pop();
      outbox.steps.pop();
    }
  }
  EXPECT_EQ(support::allocations(), before);
}

// One thread puts as fast as it can, one takes. Every image comes out whole and in order, or is counted.
TEST(Outbox, LosesNothingUncountedBetweenThreads) {
  RosOptions options = small();
  options.queue = 4;
  Outbox outbox(options);
  constexpr std::uint32_t kImages = 100'000;
  std::atomic<bool> done{false};
  std::uint64_t taken = 0, disorder = 0, broken = 0;
  std::thread taker([&] {
    std::int64_t last = -1;
    while (true) {
      const bool last_look = done.load();
      for (const WaitingImage* image; (image = outbox.images.first()) != nullptr; outbox.images.pop()) {
        if (image->sequence <= last) ++disorder;
        last = image->sequence;
        if (image->written != TrueTime{image->sequence} || image->objects.size() != image->sequence % 5) ++broken;
        ++taken;
      }
      if (last_look) return;
    }
  });
  std::vector<recording::records::ImageObject> objects;
  for (int i = 0; i < 4; ++i) objects.push_back(image_object(i));
  recording::records::ImageWritten image;
  for (std::uint32_t i = 0; i < kImages; ++i) {
    image.stamp = stamp_at(i);
    image.sequence = i;
    image.objects = std::span<const recording::records::ImageObject>(objects).first(i % 5);
    outbox.put(image);
  }
  done.store(true);
  taker.join();
  EXPECT_EQ(taken + outbox.dropped().images, kImages);
  EXPECT_GT(taken, 0u);
  EXPECT_EQ(disorder, 0u);
  EXPECT_EQ(broken, 0u);
}

}  // namespace
}  // namespace ttf::bus::dds::ros
