// Observation lists as the fusion node understands them.
#include "sensors/observation_codec.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "fusion/config/classes.h"
#include "nodes/host/step.h"
#include "schedules/file/loader.h"
#include "sim/world/traffic/classes.h"

namespace ttf::sensors {
namespace {

struct List {
  schedules::model::Cluster cluster;
  PduId pdu;
  const schedules::model::PduLayout& layout;
  ObservationCodec codec;
  nodes::host::Output out;

  List(const std::string& file, std::string_view name)
      : cluster(schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/" + file)), pdu(*cluster.find_pdu(name)),
        layout(cluster.pdu(pdu)), codec(cluster, pdu), out("objects", pdu, layout) {}
  void set(int index, std::string_view signal, double value) {
    out.set(index, *schedules::model::find_signal(layout.element, signal), value);
  }
  std::vector<ttf::fusion::sensors::Observation> decoded() const {
    std::vector<ttf::fusion::sensors::Observation> observations;
    codec.decode(out.view(), observations);
    return observations;
  }
};

TEST(ObservationCodec, ACamerasSilhouetteIsASpanNotAWidth) {
  List list("paper_synchronised.yaml", "camera_objects");
  list.out.begin(0, 2, GlobalTime{});
  list.set(1, "x", 20.0);
  list.set(1, "span", 0.22);
  list.set(1, "sigma_span", 0.002);
  const auto observations = list.decoded();
  ASSERT_EQ(observations.size(), 2u);
  const ttf::fusion::sensors::Observation& z = observations[1];
  EXPECT_EQ(z.z(0), 20.0);
  EXPECT_TRUE(z.has_span);
  EXPECT_NEAR(z.span, 0.22, 0.00025 + 1e-12);
  EXPECT_NEAR(z.sigma_span, 0.002, 0.0001 + 1e-12);
  EXPECT_EQ(z.seen, ttf::fusion::sensors::SeenPoint::kSilhouette);
  EXPECT_FALSE(z.has_width || z.has_length || z.has_heading);
}

TEST(ObservationCodec, AReportedClassCountsOnceAndACodeOfNoClassIsNone) {
  List list("surround_synchronised.yaml", "mono_objects");
  constexpr int kCodes = 16;  // four bits
  list.out.begin(0, kCodes, GlobalTime{});
  for (int code = 0; code < kCodes; ++code) {
    list.set(code, "span", 0.22);
    list.set(code, "class", code);
  }
  const auto observations = list.decoded();
  ASSERT_EQ(observations.size(), 16u);
  for (std::size_t code = 0; code < observations.size(); ++code) {
    const ttf::fusion::sensors::Observation& z = observations[code];
    EXPECT_TRUE(z.has_span);
    EXPECT_NEAR(z.span, 0.22, 0.00025 + 1e-12);
    if (code < ttf::fusion::config::kClassCount) {
      EXPECT_EQ(z.class_id, ttf::fusion::sensors::ClassId{static_cast<std::uint8_t>(code)});
      EXPECT_EQ(z.score, 1.0);
    } else {
      EXPECT_EQ(z.class_id, ttf::fusion::sensors::kNoClass) << code;
      EXPECT_EQ(z.score, 0.0);
    }
  }
}

TEST(ObservationCodec, ClassesHaveTheCodesOfTheWorld) {
  ASSERT_EQ(sim::world::traffic::kClasses.size(), ttf::fusion::config::kClassCount);
  for (std::size_t code = 0; code < ttf::fusion::config::kClassCount; ++code)
    EXPECT_EQ(ttf::fusion::config::kClassPriors[code].name, sim::world::traffic::kClasses[code].name);
}

TEST(ObservationCodec, AListWithoutClassesReportsNone) {
  List list("surround_synchronised.yaml", "stereo_objects");
  list.out.begin(0, 1, GlobalTime{});
  list.set(0, "span", 0.22);
  const auto observations = list.decoded();
  ASSERT_EQ(observations.size(), 1u);
  EXPECT_TRUE(observations[0].has_span);
  EXPECT_EQ(observations[0].class_id, ttf::fusion::sensors::kNoClass);
}

TEST(ObservationCodec, ARadarsReturnsAreOfTheOutline) {
  using ttf::fusion::sensors::SeenPoint;
  List list("laser_and_radar_synchronised.yaml", "radar_objects");
  list.out.begin(0, 2, GlobalTime{});
  list.set(1, "range", 80.0);
  list.set(1, "range_rate", -12.5);
  list.set(1, "sigma_range", 0.2);
  list.set(1, "returns", 3.0);
  const auto observations = list.decoded();
  ASSERT_EQ(observations.size(), 2u);
  EXPECT_EQ(observations[0].seen, SeenPoint::kCentre);
  const ttf::fusion::sensors::Observation& z = observations[1];
  EXPECT_EQ(z.kind, ttf::fusion::sensors::ObservationKind::kRangeBearingRate);
  EXPECT_EQ(z.seen, SeenPoint::kSilhouette);
  EXPECT_EQ(z.z(0), 80.0);
  EXPECT_EQ(z.z(2), -12.5);
  EXPECT_EQ(z.returns, 3);
  EXPECT_NEAR(z.r(0, 0), 0.04, 1e-6);
}

TEST(ObservationCodec, ALasersValidBitsSayWhatWasSeen) {
  using ttf::fusion::sensors::SeenPoint;
  List list("paper_synchronised.yaml", "laser_objects");
  list.out.begin(0, 16, GlobalTime{});
  for (int bits = 0; bits < 16; ++bits) list.set(bits, "valid", bits);
  const auto observations = list.decoded();
  ASSERT_EQ(observations.size(), 16u);
  for (const auto& [bits, seen] : {std::pair{0, SeenPoint::kSilhouette},
                                   {1, SeenPoint::kSilhouette},
                                   {2, SeenPoint::kRightmost},
                                   {4, SeenPoint::kLeftmost},
                                   {3, SeenPoint::kSide},
                                   {5, SeenPoint::kEnd},
                                   {7, SeenPoint::kCentre},
                                   {8, SeenPoint::kCentre},
                                   {9, SeenPoint::kCorner},
                                   {11, SeenPoint::kCorner},
                                   {13, SeenPoint::kCorner},
                                   {15, SeenPoint::kCorner},
                                   {6, SeenPoint::kSilhouette},
                                   {14, SeenPoint::kSilhouette}})
    EXPECT_EQ(observations[static_cast<std::size_t>(bits)].seen, seen) << bits;
  for (int bits = 0; bits < 16; ++bits) {
    const ttf::fusion::sensors::Observation& z = observations[static_cast<std::size_t>(bits)];
    EXPECT_EQ(z.has_heading, (bits & 1) != 0);
    const bool cut = bits == 2 || bits == 4;
    EXPECT_EQ(z.has_length, (bits & 2) != 0 && !cut);
    EXPECT_EQ(z.has_width, (bits & 4) != 0 && !cut);
    EXPECT_FALSE(z.has_span);
  }
}

// Any bytes give positive definite covariances, sigmas above zero, and finite values.
TEST(ObservationCodec, AnyBytesMakeUsableObservations) {
  RandomStream draw({.seed = 12});
  for (const auto& [file, name] : {std::pair{"paper_synchronised.yaml", "laser_objects"},
                                   {"paper_synchronised.yaml", "camera_objects"},
                                   {"surround_synchronised.yaml", "mono_objects"},
                                   {"laser_radar.yaml", "radar_objects"}}) {
    List list(file, name);
    for (int round = 0; round < 200; ++round) {
      list.out.begin(0, list.layout.max_elements, GlobalTime{});
      for (int i = 0; i < list.layout.max_elements; ++i)
        for (std::size_t s = 0; s < list.layout.element.size(); ++s) {
          const schedules::model::Signal& signal = list.layout.element[s];
          const double extreme[] = {signal.low, signal.high, draw.uniform(signal.low, signal.high)};
          list.out.set(i, s, extreme[draw.integer(0, 2)]);
        }
      for (const ttf::fusion::sensors::Observation& z : list.decoded()) {
        const int n = ttf::fusion::sensors::dimension_of(z.kind);
        ASSERT_TRUE(z.z.allFinite() && z.r.allFinite());
        ASSERT_EQ(Eigen::LLT<Eigen::MatrixXd>(z.r.topLeftCorner(n, n)).info(), Eigen::Success) << name;
        ASSERT_TRUE(!z.has_heading || z.sigma_heading > 0.0);
        ASSERT_TRUE(!z.has_length || z.sigma_length > 0.0);
        ASSERT_TRUE(!z.has_width || z.sigma_width > 0.0);
        ASSERT_TRUE(!z.has_span || z.sigma_span > 0.0);
        ASSERT_TRUE(z.class_id == ttf::fusion::sensors::kNoClass ||
                    static_cast<std::size_t>(z.class_id) < ttf::fusion::sensors::kMostClasses);
      }
    }
  }
}

}  // namespace
}  // namespace ttf::sensors
