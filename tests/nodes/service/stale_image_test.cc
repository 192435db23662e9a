// Absent images: the feature service keeps the last one as long as the rule allows, then goes on without.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/errors.h"
#include "nodes/service/feature_service.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::service {
namespace {

constexpr GlobalTime at_us(std::int64_t us) { return GlobalTime{us * 1000}; }
constexpr GlobalTime at_ms(std::int64_t ms) { return at_us(1000 * ms); }

struct Use {
  std::uint32_t sequence;
  GlobalTime valid_at;
  bool fresh, stale;
  std::size_t objects;
  bool operator==(const Use&) const = default;
};

// The paper's feature service with images by hand, each with one car 22 m ahead.
struct Service final : recording::records::Sink {
  schedules::model::Cluster cluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  const schedules::model::Task& task = cluster.node(*cluster.find_node("feature")).tasks[0];
  PduId pdu = *cluster.find_pdu("image");
  FeatureService step;
  host::Output image{"image", pdu, cluster.pdu(pdu)};
  std::optional<bus::cni::ListView> newest;
  bool fresh = false;
  std::optional<Use> used;

  explicit Service(const FeatureConfig& config = {}) : step(cluster, task, config) {}

  using recording::records::Sink::on;
  void on(const recording::records::FeatureUsed& use) override {
    used = {use.image_sequence, use.image_valid_at, use.fresh, use.stale, use.objects.size()};
  }
  void receive(std::uint32_t sequence, GlobalTime valid_at) {
    const fusion::ImageSignals signals = fusion::bind_image(cluster, cluster.pdu(pdu));
    ttf::fusion::tracks::TrackView car;
    car.state(0) = 22.0;
    car.covariance.setIdentity();
    image.begin(sequence, 1, valid_at);
    fusion::encode_image_object(car, image, 0, signals);
    newest = image.view();
    fresh = true;
  }
  std::optional<Use> use(GlobalTime now) {
    std::vector<host::Input> inputs{{"image", pdu, &cluster.pdu(pdu), newest, fresh}};
    host::StepContext context;
    context.stamp.global = now;
    context.inputs = inputs;
    context.sink = this;
    used.reset();
    step.run(context);
    fresh = false;
    return used;
  }
};

TEST(StaleImage, NothingIsMadeUpBeforeTheFirst) { EXPECT_FALSE(Service().use(at_ms(40))); }

TEST(StaleImage, IsRefusedBeyondTheLargestAgeToTheNanosecond) {
  Service service;
  const Duration most = FeatureConfig{}.max_image_age;
  service.receive(7, at_ms(40));
  EXPECT_EQ(service.use(at_ms(40)), (Use{7, at_ms(40), true, false, 1}));
  EXPECT_EQ(service.use(at_ms(80)), (Use{7, at_ms(40), false, false, 1})) << "one was missed";
  EXPECT_EQ(service.use(at_ms(120)), (Use{7, at_ms(40), false, false, 1})) << "two in a row";
  EXPECT_EQ(service.use(at_ms(40) + most), (Use{7, at_ms(40), false, false, 1}));
  EXPECT_EQ(service.use(at_ms(40) + most + Duration{1}), (Use{7, at_ms(40), false, true, 0}));
  EXPECT_EQ(service.use(at_ms(40'000)), (Use{7, at_ms(40), false, true, 0})) << "its age grows on";
  service.receive(8, at_ms(40'040));
  EXPECT_EQ(service.use(at_ms(40'040)), (Use{8, at_ms(40'040), true, false, 1}));
}

// The stamp on the bus has 32 bits of microseconds: after a full round it means the present again.
TEST(StaleImage, DoesNotBecomeNewWhenItsStampWraps) {
  Service service;
  service.receive(7, at_ms(40));
  service.use(at_ms(40));
  const GlobalTime wrapped = at_ms(40) + Duration::microseconds(std::int64_t{1} << 32);
  EXPECT_EQ(service.use(wrapped), (Use{7, at_ms(40), false, true, 0}));
}

// A stamp means the nearest of the instants that are a whole round of the cycle counter (320 ms) apart.
TEST(StaleImage, AStampFromTheFutureIsNoImageOfNow) {
  Service service;
  service.receive(7, at_ms(190));
  EXPECT_EQ(service.use(at_ms(40)), (Use{7, at_ms(190), true, true, 0}));
}

TEST(StaleImage, TheLargestAgeIsTheScenarios) {
  Findings findings;
  YamlMap yaml = StrictYaml::parse("max_image_age: 30 ms\n", "feature.yaml").root(findings);
  const FeatureConfig config = load_feature(yaml);
  yaml.finish();
  ASSERT_TRUE(findings.empty());
  Service service(config);
  service.receive(7, at_ms(40));
  EXPECT_EQ(service.use(at_ms(70)), (Use{7, at_ms(40), true, false, 1}));
  EXPECT_EQ(service.use(at_ms(71)), (Use{7, at_ms(40), false, true, 0}));
}

}  // namespace
}  // namespace ttf::nodes::service
