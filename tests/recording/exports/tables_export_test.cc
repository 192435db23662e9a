// Tables from records with an exactly known result, and from records that no drive can have.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/csv.h"
#include "recording/exports/captures.h"
#include "recording/exports/tables.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/record_text.h"

namespace ttf::recording::exports {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing::StartsWith;

struct Tables {
  std::map<Table, std::string> text;
  TableExport out{LogNames(manifest()), [this](Table table, std::string_view more) { text[table] += more; }};

  static log::LogManifest manifest() {
    log::LogManifest names;
    names.node_names = {"laser", "fusion, front"};
    names.task_names = {{"measure"}, {"fuse"}};
    names.sensor_names = {"laser"};
    return names;
  }
  // The rows behind the line of names.
  std::vector<std::string> rows(Table table) const {
    std::vector<std::string> lines;
    const std::string& all = text.at(table);
    for (std::size_t at = all.find('\n') + 1; at < all.size(); at = all.find('\n', at) + 1)
      lines.push_back(all.substr(at, all.find('\n', at) - at));
    return lines;
  }
};

TEST(TableExport, RowsHaveExactTimesAndNumbersThatReadBackEqual) {
  Tables tables;
  records::TruthState truth;
  truth.at = {1'500'000'007};
  truth.object = ObjectId{2};
  truth.x = 0.1;
  truth.y = -2.0;
  truth.yaw_rate = std::numeric_limits<double>::infinity();
  truth.length = 4.4;
  tables.out.on(truth);
  const records::Stamp stamp{{10'000'000}, {}, {4'000'000}, NodeId{1}};
  records::ImageObject object;
  object.track = TrackId{7};
  object.x = 30.5;
  object.status = records::ImageStatus::kConfirmed | records::ImageStatus::kCoasting;
  const MeasurementId newest[] = {{SensorId{0}, 3}};
  tables.out.on(records::ImageWritten{stamp, 9, {6'000'000}, {1'000'000}, std::span(&object, 1), newest});
  tables.out.on(records::TaskRun{stamp, 0, stamp, {{12'000'000}, {}, {}, NodeId{1}}, false});
  tables.out.age({12'000'000}, 9, SensorId{0}, Duration::microseconds(12'500));
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  tables.out.error({{12'000'000}, ObjectId{2}, {0.5, 0.25, 0, 1}, {1, 1, 1, kUnknown}, 0.1, -1, 0, kUnknown});
  EXPECT_THAT(tables.rows(Table::kTruth), ElementsAre("1.500000007,2,0.1,-2,0,0,0,,4.4,0"));
  EXPECT_THAT(tables.rows(Table::kImages),
              ElementsAre("0.010000000,9,0.012000000,0.007000000,7,1,1,0,0,30.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0"));
  EXPECT_THAT(tables.rows(Table::kTasks), ElementsAre("0.010000000,\"fusion, front\",fuse,0.010000000,0.012000000,0"));
  EXPECT_THAT(tables.rows(Table::kAges), ElementsAre("0.012000000,9,laser,12.5"));
  EXPECT_THAT(tables.rows(Table::kErrors), ElementsAre("0.012000000,2,0.5,0.25,0,1,1,1,1,,0.1,-1,0,"));
}

TEST(TableExport, ATrackHasItsSigmas) {
  Tables tables;
  const std::array<double, 6> state{1, 2, 3, 4, 5, 6};
  std::array<double, 36> covariance{};
  for (std::size_t k = 0; k < 6; ++k) covariance[7 * k] = static_cast<double>((k + 1) * (k + 1));
  tables.out.on(records::TrackState{
      {{10'000'000}, {}, {4'000'000}, NodeId{1}}, 3, TrackId{7}, {2'000'000}, state, covariance, true, {}});
  EXPECT_THAT(tables.rows(Table::kTracks), ElementsAre("0.010000000,3,7,0.008000000,1,1,2,3,4,5,6,1,2,3,4,5,6"));
}

// Nodes that look at one instant record its truth each.
TEST(TableExport, AnObjectHasOneRowAnInstant) {
  Tables tables;
  for (const auto& [at_ns, node, object] :
       {std::array{10, 0, 1}, std::array{10, 0, 2}, std::array{10, 1, 1}, std::array{10, 1, 2}, std::array{20, 1, 1}}) {
    records::TruthState truth;
    truth.at = {at_ns};
    truth.node = static_cast<NodeId>(node);
    truth.object = static_cast<ObjectId>(object);
    tables.out.on(truth);
  }
  EXPECT_THAT(tables.rows(Table::kTruth),
              ElementsAre(StartsWith("0.000000010,1,"), StartsWith("0.000000010,2,"), StartsWith("0.000000020,1,")));
}

TEST(TableExport, FramesAreThoseOfCapturesByTime) {
  Tables tables;
  FrameCollector collector;
  for (std::uint32_t i = 0; i < 200; ++i)
    emit(collector, log::kind_of(i), Values::kDrawn, i, 1'000'000'000 - i * 1'000'000);
  tables.out.frames(collector);
  const std::string& text = tables.text[Table::kFrames];
  const std::string names = csv_header().substr(csv_header().find(','));
  EXPECT_EQ(text.substr(text.find(','), names.size()), names);
  const std::vector<LoggedFrame> frames = collector.in_order();
  const std::vector<std::string> rows = tables.rows(Table::kFrames);
  ASSERT_THAT(rows, SizeIs(frames.size()));
  ASSERT_FALSE(rows.empty());
  for (std::size_t f = 0; f < frames.size(); ++f)
    EXPECT_EQ(rows[f].substr(rows[f].find(',') + 1), frame_fields(collector, frames[f], LogNames(Tables::manifest())));
}

// Every row has as many fields as the line of names, whatever a damaged log holds.
TEST(TableExport, AnyRecordsGiveTablesThatReadBack) {
  Tables tables;
  for (const Values values : {Values::kSmallest, Values::kZero, Values::kDrawn, Values::kLargest})
    for (std::uint32_t i = 0; i < 4 * records::kKindCount; ++i)
      emit(tables.out, log::kind_of(i), values, i, i * 10'000'000);
  for (const auto& [table, text] : tables.text) {
    CsvLines lines(text);
    ASSERT_TRUE(lines.next());
    const std::size_t columns = lines.fields().size();
    std::uint64_t count = 0;
    for (; lines.next(); ++count) {
      EXPECT_EQ(lines.broken(), "") << text;
      EXPECT_THAT(lines.fields(), SizeIs(columns)) << kTableNames[static_cast<std::size_t>(table)];
    }
    EXPECT_EQ(count, tables.out.rows()[static_cast<std::size_t>(table)]);
  }
}

}  // namespace
}  // namespace ttf::recording::exports
