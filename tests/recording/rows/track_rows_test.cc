// Tracks in CSV: as many cells as columns, exact times, and empty cells for unknown values.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/csv.h"
#include "recording/rows/track_rows.h"

namespace ttf::recording::rows {
namespace {

TEST(TrackRows, OneCellForEachColumn) {
  TrackRow row;
  row.time_ns = 1'477'010'443'050'000'000;
  row.known_ns = -20'000'001;
  row.track = 3;
  row.x = 1.25;
  row.y = -1e-9;
  row.vx = -2.0;
  for (std::size_t i = 0; i < row.covariance.size(); ++i) row.covariance[i] = 1.0 / static_cast<double>(3 * i + 3);
  row.sigma_heading = 0.5;
  row.width = 1.8;
  row.height = 2.5;
  row.class_name = "van, white";
  row.class_share = 0.75;
  row.coasting = true;
  const std::string text = std::string(track_heading()) + track_line(row);
  CsvLines lines(text);
  ASSERT_TRUE(lines.next());
  const std::vector<std::string> heading = lines.fields();
  ASSERT_TRUE(lines.next());
  const std::vector<std::string> cells = lines.fields();
  ASSERT_EQ(cells.size(), heading.size());
  EXPECT_FALSE(lines.next());
  const auto cell = [&](const std::string& column) {
    return cells.at(static_cast<std::size_t>(std::find(heading.begin(), heading.end(), column) - heading.begin()));
  };
  EXPECT_EQ(cell("time"), "1477010443.05");
  EXPECT_EQ(cell("known"), "-0.020000001");
  EXPECT_EQ(cell("track"), "3");
  EXPECT_EQ(cell("x"), "1.250000");
  EXPECT_EQ(cell("y"), "0.000000") << "what rounds to zero has no sign";
  EXPECT_EQ(cell("vx"), "-2.000000");
  EXPECT_EQ(cell("p_x_x"), "0.333333333");
  EXPECT_EQ(cell("p_vy_vy"), "0.0333333333");
  EXPECT_EQ(cell("length"), "");
  EXPECT_EQ(cell("width"), "1.800000");
  EXPECT_EQ(cell("z"), "");
  EXPECT_EQ(cell("height"), "2.500000");
  EXPECT_EQ(cell("class"), "van, white");
  EXPECT_EQ(cell("class_share"), "0.750000");
  EXPECT_EQ(cell("coasting"), "1");
}

}  // namespace
}  // namespace ttf::recording::rows
