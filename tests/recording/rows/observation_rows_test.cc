// Recorded observations in CSV: correct lines are read exactly, each wrong one gives one sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/rows/observation_rows.h"

namespace ttf::recording::rows {
namespace {

using testing::ElementsAre;

struct Read {
  std::vector<ObservationRow> rows;
  std::vector<std::string> sentences;
};

Read read(const std::string& text) {
  Read result;
  Findings findings;
  try {
    result.rows = parse_observation_rows(text, "o.csv", findings);
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings()) result.sentences.push_back(finding.sentence());
  }
  for (const Finding& finding : findings.list()) result.sentences.push_back(finding.sentence());
  return result;
}

TEST(ObservationRows, ReadsEveryColumnInAnyOrder) {
  const Read all = read(
      "score,class,height,z,sigma_width,width,sigma_length,length,sigma_heading,heading,cov_22,cov_12,cov_11,y,x,"
      "sensor,"
      "arrival,time,gt_x\n"
      "0.75,\"van, white\",2.5,1.1,0.2,1.9,0.3,5.1,0.05,-1.5,0.04,0.01,0.09,-2.5,10.25,roof "
      "lidar,1.350000001,1.3,10.3\n");
  ASSERT_THAT(all.sentences, ElementsAre());
  ASSERT_EQ(all.rows.size(), 1u);
  const ObservationRow& row = all.rows[0];
  EXPECT_EQ(row.line, 2);
  EXPECT_EQ(row.time_ns, 1'300'000'000);
  EXPECT_EQ(row.arrival_ns, 1'350'000'001);
  EXPECT_EQ(row.sensor, "roof lidar");
  EXPECT_EQ(row.kind, ObservationRow::Kind::kPosition);
  EXPECT_THAT(row.z, ElementsAre(10.25, -2.5, 0.0));
  ASSERT_TRUE(row.covariance);
  EXPECT_THAT(*row.covariance, ElementsAre(0.09, 0.01, 0.04, 0.0, 0.0, 0.0));
  EXPECT_EQ(row.heading, -1.5);
  EXPECT_EQ(row.sigma_heading, 0.05);
  EXPECT_EQ(row.length, 5.1);
  EXPECT_EQ(row.sigma_length, 0.3);
  EXPECT_EQ(row.width, 1.9);
  EXPECT_EQ(row.sigma_width, 0.2);
  EXPECT_EQ(row.elevation, 1.1);
  EXPECT_EQ(row.height, 2.5);
  EXPECT_EQ(row.class_name, "van, white");
  EXPECT_EQ(row.score, 0.75);
}

TEST(ObservationRows, RangeAndBearingWithAndWithoutRate) {
  const Read two = read(
      "time,sensor,x,y,range,bearing,range_rate,cov_11,cov_12,cov_22,cov_13,cov_23,cov_33\n"
      "0,radar,,,30,0.5,-4,0.09,0.001,0.0009,0.01,0.002,0.04\n"
      "0,sonar,,,3,-0.5,,,,,,,\n");
  ASSERT_THAT(two.sentences, ElementsAre());
  ASSERT_EQ(two.rows.size(), 2u);
  EXPECT_EQ(two.rows[0].kind, ObservationRow::Kind::kRangeBearingRate);
  EXPECT_THAT(two.rows[0].z, ElementsAre(30.0, 0.5, -4.0));
  EXPECT_THAT(*two.rows[0].covariance, ElementsAre(0.09, 0.001, 0.0009, 0.01, 0.002, 0.04));
  EXPECT_EQ(two.rows[1].kind, ObservationRow::Kind::kRangeBearing);
  EXPECT_THAT(two.rows[1].z, ElementsAre(3.0, -0.5, 0.0));
  EXPECT_FALSE(two.rows[1].covariance);
  EXPECT_EQ(two.rows[1].class_name, "");
}

TEST(ObservationRows, TimesAreExactOrTheNearestNanosecond) {
  const Read times = read(
      "time,sensor,x,y\n-0.5,a,0,0\n0.123456789,a,0,0\n0.15000000000000002,a,0,0\n2e-1,a,0,0\n1477010443.000000001,a,0,"
      "0\n");
  ASSERT_EQ(times.rows.size(), 5u);
  EXPECT_EQ(times.rows[0].time_ns, -500'000'000);
  EXPECT_EQ(times.rows[1].time_ns, 123'456'789);
  EXPECT_EQ(times.rows[2].time_ns, 150'000'000);
  EXPECT_EQ(times.rows[3].time_ns, 200'000'000);
  EXPECT_EQ(times.rows[4].time_ns, 1'477'010'443'000'000'001);
  EXPECT_EQ(times.rows[4].arrival_ns, times.rows[4].time_ns) << "without a column, a list arrives as it is measured";
}

TEST(ObservationRows, ByteOrderMarkAndWindowsLineEnds) {
  const Read windows = read("\xef\xbb\xbf\"time\",\"sensor\",\"x\",\"y\"\r\n1,a,2,3\r\n");
  EXPECT_THAT(windows.sentences, ElementsAre());
  ASSERT_EQ(windows.rows.size(), 1u);
  EXPECT_EQ(windows.rows[0].z[1], 3.0);
}

TEST(ObservationRows, EachBrokenLineIsOneSentenceAndLeftOut) {
  const Read broken = read(
      "time,arrival,sensor,x,y,range,bearing,cov_11,cov_12,cov_22,cov_33,class,score\n"
      "1,,a,1,1,,,,,,,,\n"
      "1,,a,1\n"                      // 3
      "1,,a,nan,1,,,,,,,,\n"          // 4
      "1,,a,1e9,1,,,,,,,,\n"          // 5
      "1,,a,1,,,,,,,,,\n"             // 6
      "1,,a,,,,,,,,,,\n"              // 7
      "1,,a,1,1,5,,,,,,,\n"           // 8
      "1,,a,,,5,,,,,,,\n"             // 9
      "1,,a,,,0,1,,,,,,\n"            // 10
      "1,,a,1,1,,,0.1,,,,,\n"         // 11
      "1,,a,1,1,,,-0.1,,0.1,,,\n"     // 12
      "1,,a,1,1,,,0.1,,0.1,0.1,,\n"   // 13
      "1,,a,,,5,1,0.1,0.01,0.1,,,\n"  // 14
      "1,,,1,1,,,,,,,,\n"             // 15
      "0.999,,a,1,1,,,,,,,,\n"        // 16: sound, though out of order
      "soon,,a,1,1,,,,,,,,\n"         // 17
      "2,1.5,a,1,1,,,,,,,,\n"         // 18
      "2,3602.5,a,1,1,,,,,,,,\n"      // 19
      "1,,a,1,1,,,,,,,,0.5\n"         // 20
      "1,,a,1,1,,,,,,,\"car,\n"       // 21
      "1,,a,1,1,inf,,,,,,,\n"         // 22
      "1,,b\x01,1,1,,,,,,,,\n"        // 23
      "1,,a,2,2,,,,,,,car,\n");
  EXPECT_THAT(
      broken.sentences,
      ElementsAre("o.csv:3: columns = 4: must be 13, as in the heading",
                  "o.csv:4: x = nan: must be a number in -1e+07..1e+07 m",
                  "o.csv:5: x = 1e9: must be a number in -1e+07..1e+07 m", "o.csv:6: y: must be given where x is",
                  "o.csv:7: x: must be given with y, or range with bearing",
                  "o.csv:8: range = 5: must be empty where x and y are given",
                  "o.csv:9: bearing: must be given where range is",
                  "o.csv:10: range = 0: must be a number in 0.001..1e+07 m",
                  "o.csv:11: cov_22: must be given where another part of the covariance is",
                  "o.csv:12: cov_11 = -0.1: must be a number in 1e-08..1e+08",
                  "o.csv:13: cov_33 = 0.1: must be empty where two numbers were measured",
                  "o.csv:14: cov_12 = 0.01: must be empty where only range and bearing were measured: their errors "
                  "are taken as "
                  "independent",
                  "o.csv:15: sensor: must be a name of 1..40 printable ASCII characters",
                  "o.csv:17: time = soon: must be a number in -4e+09..4e+09 s",
                  "o.csv:18: arrival = 1.5: must be a number in 2..3602 s, from the measurement to an hour after it",
                  "o.csv:19: arrival = 3602.5: must be a number in 2..3602 s, from the measurement to an hour after it",
                  "o.csv:20: score = 0.5: must be empty where no class is given",
                  "o.csv:21: line = car,: must end its quoted field on the same line",
                  "o.csv:22: range = inf: must be a number in 0.001..1e+07 m",
                  "o.csv:23: sensor = b\\x01: must be a name of 1..40 printable ASCII characters"));
  ASSERT_EQ(broken.rows.size(), 3u);
  EXPECT_EQ(broken.rows[0].line, 2);
  EXPECT_EQ(broken.rows[1].line, 16);
  EXPECT_EQ(broken.rows[2].line, 24);
  EXPECT_EQ(broken.rows[2].score, 1.0);
}

TEST(ObservationRows, TheTruthIsReadWhereItHasAPosition) {
  const Read all = read(
      "time,sensor,x,y,gt_object,gt_y,gt_x,gt_vx,gt_vy,gt_colour\n"
      "0,lidar,1,2,van,2.5,1.5,3,4,red\n"
      "0,lidar,1,2,,2.5,1.5,,,\n"
      "0,lidar,9,9,,,,,,\n");
  ASSERT_THAT(all.sentences, ElementsAre());
  ASSERT_EQ(all.rows.size(), 3u);
  ASSERT_TRUE(all.rows[0].truth);
  EXPECT_EQ(all.rows[0].truth->object, "van");
  EXPECT_EQ(all.rows[0].truth->x, 1.5);
  EXPECT_EQ(all.rows[0].truth->y, 2.5);
  EXPECT_EQ(all.rows[0].truth->velocity, (std::array{3.0, 4.0}));
  ASSERT_TRUE(all.rows[1].truth);
  EXPECT_EQ(all.rows[1].truth->object, "");
  EXPECT_FALSE(all.rows[1].truth->velocity);
  EXPECT_FALSE(all.rows[2].truth);
  // Without both columns of the position, nothing is read: such files were always fine.
  const Read half = read("time,sensor,x,y,gt_x,gt_vx,gt_object\n0,lidar,1,2,?,?,\n");
  ASSERT_THAT(half.sentences, ElementsAre());
  EXPECT_FALSE(half.rows.at(0).truth);
  EXPECT_THAT(read("time,sensor,x,y,gt_x,gt_y\n0,lidar,1,2,3,\n1,lidar,1,2,3,1e9\n").sentences,
              ElementsAre("o.csv:2: gt_y: must be given where gt_x is",
                          "o.csv:3: gt_y = 1e9: must be a number in -1e+07..1e+07 m"));
  EXPECT_THAT(read("time,sensor,x,y,gt_x,gt_y,gt_vx,gt_vy\n0,lidar,1,2,,,3,4\n").sentences,
              ElementsAre("o.csv:2: gt_vx = 3: must be empty where gt_x and gt_y are not given"));
}

TEST(ObservationRows, AHeadingThatIsWrongIsRefused) {
  EXPECT_THAT(read("").sentences, ElementsAre("o.csv: holds no heading; expected one with time, sensor, x, y"));
  EXPECT_THAT(read("# nothing\n\n").sentences,
              ElementsAre("o.csv: holds no heading; expected one with time, sensor, x, y"));
  EXPECT_THAT(read("time,sensor,x,y\n").sentences, ElementsAre("o.csv: holds no row below its heading"));
  EXPECT_THAT(read("time,x,range\n0,1,1\n").sentences,
              ElementsAre("o.csv:1: sensor: is missing: must be a column of the heading",
                          "o.csv:1: x: is missing: columns x and y, or range and bearing, must be there"));
  EXPECT_THAT(read("time,sensor,x,y,colour,time,gt_vx\n").sentences,
              ElementsAre("o.csv:1: column = colour: is not known (docs/use/track.md lists the columns)",
                          "o.csv:1: column = time: occurs twice"));
  EXPECT_THAT(read("\"time\n").sentences, ElementsAre("o.csv:1: heading: must end its quoted field on the same line"));
}

TEST(ObservationRows, RowsMayStandInAnyOrder) {
  EXPECT_THAT(read("time,sensor,x,y\n2,a,0,0\n1,b,0,0\n2,a,1,1\n1,b,1,1\n").sentences, ElementsAre());
  const Read back = read("time,sensor,x,y\n2,a,0,0\n1,b,0,0\n1.5,a,0,0\n");
  EXPECT_THAT(back.sentences, ElementsAre());
  EXPECT_EQ(back.rows.size(), 3u);
}

// 10 Hz from 100 s on, with a sensor of its own beside it, and one stamp that leaps ahead.
std::string ten_hertz(const std::string& leaping) {
  std::string text = "time,arrival,sensor,x,y\n";
  for (int i = 0; i < 40; ++i) {
    text += (i == 20 ? leaping : std::to_string(100 + i / 10) + "." + std::to_string(i % 10) + ",") + ",a,1,2\n";
    if (i % 4 == 0) text += std::to_string(100 + i / 10) + ".05,,b,1,2\n";
  }
  return text;
}

TEST(ObservationRows, OneStampThatLeapsCostsItsOwnRowOnly) {
  const Read leap = read(ten_hertz("9102,"));
  EXPECT_THAT(leap.sentences, ElementsAre("o.csv:27: time = 9102: must be near the stamps of a above and below it, "
                                          "101.9 s and 102.1 s: a single stamp that leaps is damaged"));
  EXPECT_EQ(leap.rows.size(), 49u);
  EXPECT_EQ(read(ten_hertz("12,")).rows.size(), 49u) << "back";
  EXPECT_EQ(read(ten_hertz("101.2,")).rows.size(), 50u) << "within a second: late in the file, but sound";
  EXPECT_THAT(read(ten_hertz("12,102")).sentences, ElementsAre()) << "a list that was long under way";
  EXPECT_EQ(read(ten_hertz("12,102")).rows.size(), 50u);
}

TEST(ObservationRows, LaserAndRadarRecordingsAreSuchRows) {
  RecordedInput input;
  input.first_time_us = 1'477'010'443'000'000;
  input.observations.resize(2);
  input.observations[0].sensor = "laser";
  input.observations[0].x = 3.0;
  input.observations[0].y = -1.0;
  input.observations[1].sensor = "radar";
  input.observations[1].kind = RecordedObservation::Kind::kRangeBearingRate;
  input.observations[1].time_us_from_start = 50'000;
  input.observations[1].range = 5.0;
  input.observations[1].bearing = 0.1;
  input.observations[1].range_rate = -2.0;
  const std::vector<ObservationRow> rows = observation_rows_of(input, "m.txt");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].time_ns, 1'477'010'443'000'000'000);
  EXPECT_EQ(rows[1].arrival_ns, 1'477'010'443'050'000'000);
  EXPECT_EQ(rows[0].kind, ObservationRow::Kind::kPosition);
  EXPECT_THAT(rows[0].z, ElementsAre(3.0, -1.0, 0.0));
  EXPECT_EQ(rows[1].kind, ObservationRow::Kind::kRangeBearingRate);
  EXPECT_THAT(rows[1].z, ElementsAre(5.0, 0.1, -2.0));
  input.observations[1].range = 0.0;
  EXPECT_THROW(observation_rows_of(input, "m.txt"), InputError);
  input.observations[1].range = 5.0;
  input.first_time_us = 4'000'000'000'000'000;
  EXPECT_THROW(observation_rows_of(input, "m.txt"), InputError) << "beyond what nanoseconds are kept for";
}

}  // namespace
}  // namespace ttf::recording::rows
