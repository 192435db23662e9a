// Makes the pictures for looking at when TTF_PICTURES names a folder.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "core/random.h"
#include "report/drawing/render.h"
#include "report/plots/boxes_picture.h"
#include "report/plots/lateness_picture.h"
#include "report/plots/position_plot.h"
#include "report/plots/schedule_picture.h"
#include "report/timing/diagram.h"
#include "schedules/file/loader.h"
#include "tests/report/synthetic_cluster.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::plots {
namespace {

// Neither 8.54 nor 8.535000000000001.
TEST(Pictures, AScheduleHasItsExactCycleInTheTitle) {
  const std::string svg = schedule_svg(schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_planned.yaml"));
  EXPECT_NE(svg.find("paper_planned: cycle 8.535 ms, 88 static slots"), std::string::npos);
}

TEST(Pictures, ForLookingAt) {
  const char* dir = std::getenv("TTF_PICTURES");
  if (dir == nullptr) GTEST_SKIP() << "TTF_PICTURES names no folder";
  const std::string to(dir);
  timing::TimingDiagram timing(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(timing, 1'500'000);
  drawing::write_picture(timing.svg(), to + "/timing.png");
  drawing::write_picture(timing.svg(), to + "/timing.pdf");
  timing::TimingDiagram close(synthetic_names(), Duration::milliseconds(5), at_us(230'000), at_us(260'000));
  SyntheticDrive{}.drive(close, 1'500'000);
  drawing::write_picture(close.svg(), to + "/timing_close.png");
  PositionPlots position(synthetic_names(), {.title = "Scenario 1, ADVA"});
  SyntheticDrive{}.drive(position, 1'500'000);
  drawing::write_picture(position.over_time_svg(), to + "/over_time.png");
  drawing::write_picture(position.plane_svg(), to + "/plane.png");
  const std::array<const PositionPlots*, 2> two{&position, &position};
  const std::vector<std::string> titles{"BUFF", "ADVA"};
  drawing::write_picture(comparison_svg(two, titles, PositionView::kPlane, "Scenario 2"), to + "/comparison.png");
  drawing::write_picture(comparison_svg(two, titles, PositionView::kXOverTime, "Scenario 1"), to + "/comparison_x.png");
  drawing::write_picture(schedule_svg(synthetic_cluster()), to + "/schedule.png");
  for (const std::string name : {"paper_unsynchronised", "laser_radar"})
    drawing::write_picture(schedule_svg(schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/" + name + ".yaml")),
                           to + "/" + name + ".png");
  std::map<NodeId, recording::exports::NodeLateness> lateness;
  RandomStream stream({.seed = 1, .purpose = Purpose::kTest});
  const auto late = [&stream](double median_us, double spread) {
    return Duration{static_cast<std::int64_t>(1000.0 * median_us * std::exp(spread * stream.normal()))};
  };
  for (std::uint8_t n = 0; n < 8; ++n)
    for (int i = 0; i < 20'000; ++i) {
      lateness[NodeId{n}].wake_ups.add(late(70 + 4.0 * n, 0.3 + 0.5 * stream.uniform()));
      lateness[NodeId{n}].floor.add(late(55, 0.2));
    }
  drawing::write_picture(lateness_svg(lateness, synthetic_names()), to + "/lateness.png");
  std::vector<drawing::Point> points;
  for (int i = 0; i < 60; ++i)
    points.push_back({10 + 0.03 * i, 2 + (i % 7) * 0.01}), points.push_back({20 + (i % 5) * 0.01, -4 + 0.03 * i});
  const std::vector<Box> boxes{{10.9, 2.9, 0, 1.9, 1.8, "1"}, {22.2, -3.1, 0.1, 4.4, 1.8, "2"}};
  drawing::write_picture(boxes_svg(points, boxes, "Boxes"), to + "/boxes.png");
}

}  // namespace
}  // namespace ttf::report::plots
