// The image's bytes: within half a resolution, sizes' sigmas rounded up, saturated at the ends, with every status.
#include "nodes/fusion/image_codec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "fusion/tracks/track.h"
#include "fusion/tracks/view.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::fusion {
namespace {

struct Image {
  schedules::model::Cluster cluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  PduId pdu = *cluster.find_pdu("image");
  const schedules::model::PduLayout& layout = cluster.pdu(pdu);
  ImageSignals signals = bind_image(cluster, layout);
  host::Output out{"image", pdu, layout};

  recording::records::ImageObject carried(const ttf::fusion::tracks::TrackView& view, int index = 0) {
    out.begin(1, layout.max_elements, GlobalTime{});
    encode_image_object(view, out, index, signals);
    return decode_image_object(layout, out.view(), index, signals);
  }
  double resolution(std::string_view name) const {
    return layout.element[*schedules::model::find_signal(layout.element, name)].resolution;
  }
};

ttf::fusion::tracks::TrackView drawn_view(RandomStream& draw) {
  ttf::fusion::tracks::TrackView view;
  view.id = static_cast<TrackId>(draw.integer(0, 0xffff));
  view.state(0) = draw.uniform(-160, 160);
  view.state(1) = draw.uniform(-160, 160);
  const double sx = draw.uniform(0.05, 10), sy = draw.uniform(0.05, 10);
  view.covariance(0, 0) = sx * sx;
  view.covariance(1, 1) = sy * sy;
  view.covariance(0, 1) = view.covariance(1, 0) = draw.uniform(-0.9, 0.9) * sx * sy;
  view.heading = draw.uniform(-3.1, 3.1);
  view.speed = draw.uniform(0, 80);
  view.acceleration = draw.uniform(-20, 20);
  view.length = draw.uniform(0, 20);
  view.width = draw.uniform(0, 5);
  view.sigma_heading = draw.uniform(0, 3);
  view.sigma_speed = draw.uniform(0, 20);
  view.sigma_acceleration = draw.uniform(0, 20);
  view.sigma_length = draw.uniform(0, 5);
  view.sigma_width = draw.uniform(0, 5);
  return view;
}

TEST(ImageCodec, CarriesEveryValueWithinHalfItsResolution) {
  Image image;
  RandomStream draw({.seed = 3});
  for (int k = 0; k < 500; ++k) {
    const ttf::fusion::tracks::TrackView v = drawn_view(draw);
    const recording::records::ImageObject o = image.carried(v, k % image.layout.max_elements);
    EXPECT_EQ(o.track, v.id);
    const auto near = [&](double value, double expected, std::string_view name) {
      EXPECT_LE(std::abs(value - expected), 0.5 * image.resolution(name) + 1e-9) << name;
    };
    near(o.x, v.state(0), "x");
    near(o.y, v.state(1), "y");
    near(o.heading, v.heading, "heading");
    near(o.speed, v.speed, "speed");
    near(o.acceleration, v.acceleration, "acceleration");
    near(o.length, v.length, "length");
    near(o.width, v.width, "width");
    near(o.sigma_x, std::sqrt(v.covariance(0, 0)), "sigma_x");
    near(o.sigma_y, std::sqrt(v.covariance(1, 1)), "sigma_y");
    near(o.correlation_xy, v.covariance(0, 1) / std::sqrt(v.covariance(0, 0) * v.covariance(1, 1)), "correlation");
    near(o.sigma_heading, v.sigma_heading, "sigma_heading");
    near(o.sigma_speed, v.sigma_speed, "sigma_speed");
    near(o.sigma_acceleration, v.sigma_acceleration, "sigma_acceleration");
    const auto at_least = [&](double value, double expected, std::string_view name) {
      EXPECT_GE(value, expected - 1e-9) << name;
      EXPECT_LE(value, expected + image.resolution(name)) << name;
    };
    at_least(o.sigma_length, v.sigma_length, "sigma_length");
    at_least(o.sigma_width, v.sigma_width, "sigma_width");
  }
  EXPECT_EQ(image.out.take_saturated(), 0);
}

TEST(ImageCodec, CarriesEveryStatus) {
  Image image;
  RandomStream draw({.seed = 4});
  for (int bits = 0; bits < 16; ++bits) {
    ttf::fusion::tracks::TrackView view = drawn_view(draw);
    view.confirmed = bits & 1;
    view.coasting = bits & 2;
    view.has_length = bits & 4;
    view.has_width = bits & 8;
    EXPECT_EQ(static_cast<int>(image.carried(view).status), bits);
  }
}

TEST(ImageCodec, SaturatesWhatIsOutOfRangeAndCountsIt) {
  Image image;
  RandomStream draw({.seed = 5});
  ttf::fusion::tracks::TrackView view = drawn_view(draw);
  view.state(0) = 1000.0;
  view.state(1) = -1000.0;
  view.sigma_length = 1e6;
  const recording::records::ImageObject o = image.carried(view);
  EXPECT_NEAR(o.x, 163.84, 0.01);
  EXPECT_EQ(o.y, -163.84);
  EXPECT_NEAR(o.sigma_length, 5.1, 1e-9);
  EXPECT_EQ(image.out.take_saturated(), 3);
}

// A layout that lacks a signal, or has an unknown one, is refused at start-up.
TEST(ImageCodec, BindsAllSignalsOrNone) {
  Image image;
  schedules::model::PduLayout layout = image.layout;
  std::swap(layout.element.front(), layout.element.back());
  EXPECT_EQ(bind_image(image.cluster, layout).back(), 0u) << "by name, in any order";
  layout.element.front().name = "mood";
  EXPECT_THROW(bind_image(image.cluster, layout), InputError);
}

// A view's status of a track.
TEST(ImageStatus, CoastsAfterListsWithoutAnObservation) {
  const ttf::fusion::config::TrackerConfig config;
  const auto estimator = ttf::fusion::estimators::make_estimator(config);
  ttf::fusion::tracks::Track track;
  track.confirmed = true;
  for (int misses = 0; misses < 8; ++misses) {
    track.misses = misses;
    const ttf::fusion::tracks::TrackView view = view_of(track, GlobalTime{}, GlobalTime{}, config, *estimator);
    EXPECT_EQ(view.coasting, misses >= config.coast_misses);
    EXPECT_FALSE(view.has_length || view.has_width) << "nothing was measured";
    EXPECT_EQ(view.sigma_length, config.sizes.length_sigma) << "and the uncertainty says so too";
    EXPECT_EQ(view.sigma_width, config.sizes.width_sigma);
  }
}

}  // namespace
}  // namespace ttf::nodes::fusion
