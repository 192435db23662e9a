// FlexRay loses lists, whole or in part. Fused lists equal the sent ones. The images are those of a fusion
// node whose senders never sent the others.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <set>

#include "core/random.h"
#include "nodes/fusion/fusion_host.h"
#include "sensors/observation_codec.h"
#include "sim/medium/disturbance.h"
#include "tests/sim/drives/living_drive.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

// Keeps frames of observation lists from the bus: a share of whole lists, and of the others a share of the
// frames.
class Losses final : public sim::medium::Disturbance {
 public:
  Losses(const schedules::model::Cluster& cluster, std::uint64_t seed) : cluster_(cluster), seed_(seed) {}

  bool leaving(sim::medium::Leaving& signal) override {
    if (signal.signal != bus::ports::Signal::kFrame || signal.bytes.size() < 10) return true;
    // Header: 5 bits, then 11 of the frame id; payload: 16 bits of the sequence number first.
    const auto byte = [&](std::size_t i) { return std::to_integer<int>(signal.bytes[i]); };
    const int slot = (byte(0) & 7) << 8 | byte(1);
    for (const schedules::model::FrameSlot& frame : cluster_.frames) {
      if (frame.slot != slot || frame.pdu == kNoPdu || cluster_.pdu(frame.pdu).sensor == kNoSensor) continue;
      const auto sequence = static_cast<std::uint32_t>(byte(5) << 8 | byte(6));
      RandomStream list({seed_, 0, Purpose::kTest, static_cast<std::uint16_t>(frame.pdu), sequence});
      RandomStream one({seed_, 1, Purpose::kTest, 0, frames_++});
      const bool lost = list.integer(1, 4) == 1 || one.integer(1, 4) == 1;
      lost_ += lost;
      return !lost;
    }
    return true;
  }
  int lost() const { return lost_; }

 private:
  const schedules::model::Cluster& cluster_;
  std::uint64_t seed_;
  std::uint32_t frames_ = 0;
  int lost_ = 0;
};

struct List {
  GlobalTime measured{};
  std::vector<std::byte> bytes;
};
using Lists = std::map<MeasurementId, List>;

// The inputs of a fusion node that receives all lists.
struct Everything final : recording::records::Sink {
  using recording::records::Sink::on;
  Lists lists;
  void on(const recording::records::FusionInput& input) override {
    lists[{input.sensor, input.sequence}] = {input.measured, {input.fragments.begin(), input.fragments.end()}};
  }
};

// A strategy beside the drive. It gets the arrived lists with the faultless drive's content.
class Beside final : public recording::records::Sink {
 public:
  Beside(const schedules::model::Cluster& cluster, const fusion::config::TrackerConfig& tracker, StrategyKind kind,
         const Lists& sent)
      : cluster_(cluster),
        strategy_(fusion::strategies::make_strategy(kind, tracker, nodes::fusion::sensor_timings(cluster))),
        sent_(sent) {}

  std::set<MeasurementId> arrived;
  std::size_t compared = 0;

  using recording::records::Sink::on;
  void on(const recording::records::FusionInput& input) override {
    const MeasurementId id{input.sensor, input.sequence};
    ASSERT_TRUE(arrived.insert(id).second) << "twice";
    const auto list = sent_.find(id);
    ASSERT_NE(list, sent_.end()) << "never sent";
    ASSERT_EQ(list->second.measured, input.measured);
    ASSERT_TRUE(std::equal(input.fragments.begin(), input.fragments.end(), list->second.bytes.begin(),
                           list->second.bytes.end()))
        << "mixed from more than one list";
    const int fragments = static_cast<int>(list->second.bytes.size()) / cluster_.pdu(input.pdu).fragment_bytes;
    sensors::ObservationCodec(cluster_, input.pdu).decode({id.sequence, fragments, list->second.bytes}, observations_);
    strategy_->accept({id, list->second.measured, observations_});
  }
  void on(const recording::records::FusionStep& step) override { strategy_->fuse(step.stamp.global); }
  void on(const recording::records::TrackState& track) override {
    if (track.predicted_for_image) shown_[track.track].assign(track.state.begin(), track.state.end());
  }
  void on(const recording::records::ImageWritten& image) override {
    strategy_->image(image.valid_at, views_);
    ASSERT_EQ(shown_.size(), views_.size());
    for (const fusion::tracks::TrackView& view : views_)
      for (std::size_t k = 0; k < 6; ++k)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(shown_[view.id].at(k)),
                  std::bit_cast<std::uint64_t>(view.state(static_cast<Eigen::Index>(k))));
    compared += views_.size();
    shown_.clear();
  }

 private:
  const schedules::model::Cluster& cluster_;
  std::unique_ptr<fusion::strategies::Strategy> strategy_;
  const Lists& sent_;
  std::vector<fusion::sensors::Observation> observations_;
  std::vector<fusion::tracks::TrackView> views_;
  std::map<TrackId, std::vector<double>> shown_;
};

TEST(LostFrames, ImagesAreThoseOfAFusionNodeThatWasNeverSentWhatGotLost) {
  for (const StrategyKind kind : fusion::strategies::kAllStrategies)
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Everything everything;
      LivingDrive whole(kind, &everything, seed);
      whole.run_to(4.0);
      ASSERT_GT(everything.lists.size(), 100u);

      Beside beside(whole.drive.cluster, whole.drive.scenario.tracker, kind, everything.lists);
      LivingDrive lossy(kind, &beside, seed);
      Losses losses(lossy.drive.cluster, seed);
      lossy.simulation->set_disturbance(&losses);
      lossy.run_to(4.0);
      EXPECT_GT(losses.lost(), 100);
      EXPECT_LT(beside.arrived.size(), everything.lists.size() - 15);
      EXPECT_GT(beside.arrived.size(), everything.lists.size() / 2);
      EXPECT_GT(beside.compared, 60u);
      EXPECT_EQ(lossy.seen.images.back().objects.size(), 1u) << "the car is still known";
    }
}

}  // namespace
}  // namespace ttf::sim::drives
