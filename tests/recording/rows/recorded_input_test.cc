// Recorded measurements: the formats are read, and every broken line is one clear sentence.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/errors.h"
#include "core/random.h"
#include "recording/rows/laser_radar_file.h"
#include "tests/recording/log/log_fixture.h"

namespace ttf::recording::rows {
namespace {

const std::string kLaserRow = "L\t3.1e-01\t-5.8\t1000\t0.6\t0.7\t5.2\t-0.1\t0.01\t6.9e-03\n";
const std::string kRadarRow = "R\t1.5\t0.55\t-4.9\t51000\t0.8\t0.9\t5.1\t0\t0\t0\n";

TEST(LaserRadar, ReadsBothKindsOfRow) {
  const RecordedInput input = parse_laser_radar(kLaserRow + "\n" + kRadarRow, "m.txt");
  ASSERT_EQ(input.observations.size(), 2u);
  ASSERT_EQ(input.truth.size(), 2u);
  EXPECT_EQ(input.first_time_us, 1000);
  const RecordedObservation& laser = input.observations[0];
  EXPECT_EQ(laser.sensor, "laser");
  EXPECT_EQ(laser.kind, RecordedObservation::Kind::kPosition);
  EXPECT_EQ(laser.time_us_from_start, 0);
  EXPECT_EQ(laser.x, 0.31);
  EXPECT_EQ(laser.y, -5.8);
  const RecordedObservation& radar = input.observations[1];
  EXPECT_EQ(radar.sensor, "radar");
  EXPECT_EQ(radar.kind, RecordedObservation::Kind::kRangeBearingRate);
  EXPECT_EQ(radar.time_us_from_start, 50'000);
  EXPECT_EQ(radar.range, 1.5);
  EXPECT_EQ(radar.bearing, 0.55);
  EXPECT_EQ(radar.range_rate, -4.9);
  EXPECT_EQ(input.truth[0].yaw_rate, 6.9e-3);
  EXPECT_EQ(input.truth[1].x, 0.8);
  EXPECT_EQ(input.truth[1].vx, 5.1);
}

TEST(LaserRadar, WindowsLineEndsAndNoLastLineEndAreFine) {
  std::string text = kLaserRow + kRadarRow;
  text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  EXPECT_EQ(parse_laser_radar(text, "m.txt").observations.size(), 2u);
}

std::vector<std::string> sentences(const std::string& text) {
  std::vector<std::string> out;
  try {
    parse_laser_radar(text, "m.txt");
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings()) out.push_back(finding.sentence());
  }
  return out;
}

TEST(LaserRadar, EachBrokenLineIsOneSentence) {
  const std::string text = kLaserRow +
                           "X\t1\t2\t3\n"
                           "L\t1\t2\t3\n"
                           "L\tabc\tdef\t2000\t0\t0\t0\t0\t0\t0\n"
                           "L\t1\tnan\t2000\t0\t0\t0\t0\t0\t0\n"
                           "R\t-1.5\t0\t0\t51000\t0\t0\t0\t0\t0\t0\n"
                           "L\t1\t2\t1.5e3\t0\t0\t0\t0\t0\t0\n"
                           "L\t1\t2\t999\t0\t0\t0\t0\t0\t0\n"
                           "L\t1\t2\t2000\t0\t0\t0\t0\t0\t1e400\n" +
                           kRadarRow;
  const std::vector<std::string> expected{"m.txt:2: sensor = X: must be L (laser) or R (radar)",
                                          "m.txt:3: columns = 4: must be 10 columns, separated by tabs, in a row of L",
                                          "m.txt:4: px = abc: must be a number in -10000..10000 m",
                                          "m.txt:5: py = nan: must be a number in -10000..10000 m",
                                          "m.txt:6: range = -1.5: must be a number in 0..10000 m",
                                          "m.txt:7: t_us = 1.5e3: must be a whole number of at least 0 us",
                                          "m.txt:9: gt_yawrate = 1e400: must be a number in -100..100 rad/s"};
  EXPECT_EQ(sentences(text), expected);
  EXPECT_EQ(sentences(""), std::vector<std::string>{"m.txt: holds no rows; expected rows that begin with L or R"});
}

TEST(LaserRadar, RowsInAnyOrderAreSorted) {
  const std::string earlier = "L\t7\t0\t51000\t1\t0\t1\t0\t0\t0\n";
  const RecordedInput input = parse_laser_radar(kRadarRow + earlier + kLaserRow, "m.txt");
  ASSERT_EQ(input.observations.size(), 3u);
  EXPECT_EQ(input.first_time_us, 1000);
  EXPECT_EQ(input.observations[0].sensor, "laser");
  EXPECT_EQ(input.observations[0].line, 3);
  EXPECT_EQ(input.observations[1].line, 1) << "of equal stamps in the order of the file";
  EXPECT_EQ(input.observations[2].line, 2);
  EXPECT_EQ(input.truth[0].x, 0.6);
  EXPECT_EQ(input.truth[2].x, 1.0);
}

TEST(LaserRadar, OneStampThatLeapsIsTheDamagedOne) {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "L\t7\t0\t" + std::to_string(i == 9 ? 99'000'000 : 50'000 * i) + "\t1\t0\t1\t0\t0\t0\n";
  EXPECT_EQ(sentences(text),
            std::vector<std::string>{"m.txt:10: t_us = 99000000: must be near the stamps above and below it, 400000 us "
                                     "and 500000 us: a single stamp that leaps is damaged"});
  Findings findings;
  EXPECT_EQ(parse_laser_radar(text, "m.txt", findings).observations.size(), 19u);
  EXPECT_EQ(findings.size(), 1u);
}

TEST(LaserRadar, RandomBytesNeverCrash) {
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 3});
    std::string text = kLaserRow + kRadarRow + kLaserRow;
    for (int i = 0; i < 5; ++i)
      text[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(text.size()) - 1))] =
          static_cast<char>(stream.integer(0, 255));
    try {
      for (const auto& seen : parse_laser_radar(text, "m").observations)
        ASSERT_TRUE(std::isfinite(seen.x) && std::isfinite(seen.range));
      (void)parse_lidar_scans(text, "m");
    } catch (const InputError& error) {
      ASSERT_FALSE(error.findings().empty());
    }
  }
}

TEST(LidarScans, ReadsFramesWithAndWithoutHeader) {
  for (const std::string header :
       {"", "# frame,azimuth_rad,range_m,intensity\n", "frame, azimuth_rad, range_m, intensity\n"}) {
    const auto scans = parse_lidar_scans(header + "0,-1.4,7.0,0.45\n0,-1.3,8,0\n2, 0.5, 3.25, 1\n", "s.csv");
    ASSERT_EQ(scans.size(), 2u);
    EXPECT_EQ(scans[0].frame, 0);
    ASSERT_EQ(scans[0].returns.size(), 2u);
    EXPECT_EQ(scans[0].returns[0].azimuth_rad, -1.4);
    EXPECT_EQ(scans[0].returns[0].intensity, 0.45);
    EXPECT_EQ(scans[1].frame, 2);
    EXPECT_EQ(scans[1].returns[0].range_m, 3.25);
  }
}

TEST(LidarScans, BrokenLinesAreNamed) {
  try {
    parse_lidar_scans("1,0,5,0\n1,0,5\n0,0,5,0\n1,x,5,0\n-1,0,5,0\nframe,0,5,0\n", "s.csv");
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::vector<std::string> expected{
        "s.csv:2: columns = 3: must be 4 columns, separated by commas: frame, azimuth_rad, range_m, "
        "intensity",
        "s.csv:4: azimuth_rad = x: must be a number in -6.283..6.283 rad",
        "s.csv:5: frame = -1: must be a whole number of at least 0",
        "s.csv:6: frame = frame: must be a whole number of at least 0"};
    std::vector<std::string> found;
    for (const Finding& finding : error.findings()) found.push_back(finding.sentence());
    EXPECT_EQ(found, expected);
  }
}

std::vector<RecordedScan> scans_of(const std::string& text, std::vector<std::string>* sentences = nullptr) {
  Findings findings;
  std::vector<RecordedScan> scans = parse_lidar_scans(text, "s.csv", findings);
  if (sentences == nullptr) {
    EXPECT_TRUE(findings.empty()) << findings.list().front().sentence();
    return scans;
  }
  for (const Finding& finding : findings.list()) sentences->push_back(finding.sentence());
  return scans;
}

TEST(LidarScans, RowsOfAnyOrderAreSortedAndThoseOfAScanKeepTheirs) {
  const auto frames = scans_of("2,0.1,5,0\n0,0.2,5,0\n2,0.3,5,0\n1,0.4,5,0\n0,0.5,5,0\n");
  ASSERT_EQ(frames.size(), 3u);
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(frames[static_cast<std::size_t>(frame)].frame, frame);
  ASSERT_EQ(frames[2].returns.size(), 2u);
  EXPECT_EQ(frames[2].returns[0].azimuth_rad, 0.1);
  EXPECT_EQ(frames[2].returns[1].azimuth_rad, 0.3);
  const auto times = scans_of("time,x,y\n0.1,1,0\n-0.1,2,0\n0.1,3,0\n0,4,0\n");
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].time_ns, -100'000'000);
  EXPECT_EQ(times[0].frame, 0);
  EXPECT_EQ(times[2].frame, 2);
  ASSERT_EQ(times[2].returns.size(), 2u);
  EXPECT_EQ(times[2].returns[1].range_m, 3);
}

// One row within its scan, and a whole scan of two rows: the rows after them stay.
TEST(LidarScans, AStampThatLeapsAloneIsDamagedAndTheRowsAfterItAreSound) {
  std::string times = "time,x,y\n", frames;
  for (int scan = 0; scan < 20; ++scan) {
    for (int row = 0; row < 3; ++row)
      times += (scan == 5 && row == 1 ? "900" : "0." + std::to_string(100 + scan)) + ",9,1\n";
    for (int row = 0; row < 2; ++row) frames += std::to_string(scan == 5 ? 7000 : scan) + ",0.1,9,1\n";
  }
  std::vector<std::string> sentences;
  const auto timed = scans_of(times, &sentences);
  ASSERT_EQ(timed.size(), 20u);
  EXPECT_EQ(timed[5].returns.size(), 2u);
  EXPECT_EQ(timed[6].returns.size(), 3u);
  EXPECT_EQ(sentences,
            std::vector<std::string>{"s.csv:18: time = 900: must be near the stamps above and below it, 0.105 s "
                                     "and 0.105 s: a single stamp that leaps is damaged"});
  sentences.clear();
  EXPECT_EQ(scans_of(frames, &sentences).size(), 19u);
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_EQ(sentences[1],
            "s.csv:12: frame = 7000: must be near the frames above and below it, 4 and 6: a single frame that "
            "leaps is damaged");
}

TEST(Sniff, RecognisesTheFormatByTheBeginning) {
  const auto sniff = [](const std::string& text) {
    const std::string path = log::scratch("sniff");
    std::ofstream(path, std::ios::binary) << text;
    return sniff_recording(path);
  };
  EXPECT_EQ(sniff(kLaserRow), RecordingFormat::kLaserRadar);
  EXPECT_EQ(sniff("# a drive\n" + kRadarRow), RecordingFormat::kLaserRadar);
  EXPECT_EQ(sniff("# frame,azimuth_rad,range_m,intensity\n0,1,2,3\n"), RecordingFormat::kLidarScans);
  EXPECT_EQ(sniff("0,1,2,3\n"), RecordingFormat::kLidarScans);
  EXPECT_EQ(sniff(log::log_of([](records::Sink&) {})), RecordingFormat::kLog);
  // The head decides, at any length of the recording; an endless heading is no recording.
  const std::string comment = "#" + std::string(1022, ' ') + "\n";
  std::string head;
  while (head.size() + comment.size() < kRecordingHead) head += comment;
  EXPECT_EQ(sniff(head + kLaserRow + std::string(1 << 20, 'x')), RecordingFormat::kLaserRadar);
  EXPECT_THROW(sniff(head + comment + kLaserRow), InputError);
  EXPECT_THROW(sniff("slots: 3\n"), InputError);
  EXPECT_THROW(sniff(""), InputError);
  EXPECT_THROW(sniff_recording("no/such/file"), InputError);
  EXPECT_THROW(sniff_recording(std::filesystem::temp_directory_path().string()), InputError);
}

const std::filesystem::path kData = std::filesystem::path(TTF_SOURCE_DIR) / ".." / "shared" / "data";

TEST(LaserRadar, ReadsTheRecordingNobodyHereWrote) {
  const auto path = kData / "laser_radar" / "measurements.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the laser and radar recording is not beside the repository";
  ASSERT_EQ(sniff_recording(path.string()), RecordingFormat::kLaserRadar);
  const RecordedInput input = read_laser_radar(path.string());
  ASSERT_EQ(input.observations.size(), 500u);
  // The stated noise, against the truth in the same row, checks that no columns are confused.
  double position = 0, range = 0, bearing = 0, rate = 0;
  int lasers = 0, radars = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    const auto& seen = input.observations[i];
    const auto& truth = input.truth[i];
    ASSERT_EQ(seen.time_us_from_start, static_cast<std::int64_t>(i) * 50'000);
    const double r = std::hypot(truth.x, truth.y);
    if (seen.kind == RecordedObservation::Kind::kPosition) {
      position += std::pow(seen.x - truth.x, 2) + std::pow(seen.y - truth.y, 2);
      ++lasers;
    } else {
      range += std::pow(seen.range - r, 2);
      bearing += std::pow(std::remainder(seen.bearing - std::atan2(truth.y, truth.x), 2 * std::numbers::pi), 2);
      rate += std::pow(seen.range_rate - (truth.x * truth.vx + truth.y * truth.vy) / r, 2);
      ++radars;
    }
  }
  EXPECT_NEAR(std::sqrt(position / (2 * lasers)), 0.15, 0.02);
  EXPECT_NEAR(std::sqrt(range / radars), 0.3, 0.04);
  EXPECT_NEAR(std::sqrt(bearing / radars), 0.03, 0.004);
  EXPECT_NEAR(std::sqrt(rate / radars), 0.3, 0.04);
}

TEST(LidarScans, ReadsTheStreetNobodyHereDrew) {
  const auto path = kData / "lidar_scans" / "scans.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the scanner recording is not beside the repository";
  ASSERT_EQ(sniff_recording(path.string()), RecordingFormat::kLidarScans);
  const auto scans = read_lidar_scans(path.string());
  ASSERT_EQ(scans.size(), 22u);
  std::size_t returns = 0;
  for (const auto& scan : scans) {
    returns += scan.returns.size();
    for (const auto& hit : scan.returns) ASSERT_LE(std::abs(hit.azimuth_rad), 80.1 * std::numbers::pi / 180);
  }
  EXPECT_EQ(returns, 13'510u);
}

}  // namespace
}  // namespace ttf::recording::rows
