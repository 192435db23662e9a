// The laws of the table of measures, and the values of a drive that was not judged.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "evaluation/measures/figures.h"

namespace ttf::evaluation::measures {
namespace {

TEST(MeasureTable, NamesAndPathsAreUnique) {
  std::set<std::string_view> names, paths;
  for (const Measure& row : measures()) {
    EXPECT_TRUE(row.name.empty() || names.insert(row.name).second) << row.name;
    EXPECT_TRUE(row.path.empty() || paths.insert(row.path).second) << row.path;
    if (!row.name.empty()) {
      EXPECT_EQ(find_measure(row.name), &row);
    }
    if (!row.path.empty()) {
      EXPECT_EQ(&measure_at(row.path), &row);
    }
  }
  EXPECT_EQ(find_measure(""), nullptr);
  EXPECT_EQ(find_measure("speed"), nullptr);
}

TEST(MeasureTable, EveryRowIsComplete) {
  for (const Measure& row : measures()) {
    const std::string what = std::string(row.name) + std::string(row.path) + std::string(row.shown.label);
    EXPECT_FALSE(row.meaning.empty() || row.meaning.ends_with('.')) << what;
    EXPECT_EQ(row.name.empty(), row.if_missed.empty()) << what;
    EXPECT_TRUE(!row.name.empty() || !row.path.empty() || !row.shown.label.empty()) << "a row that nobody reads";
    // The page and the account of troubles read values from summary.json.
    if (row.shown.place != ShownIn::kTable && !row.shown.label.empty()) {
      EXPECT_FALSE(row.path.empty()) << what;
    }
    if (row.shown.has_interval || !row.shown.trouble.empty()) {
      EXPECT_FALSE(row.path.empty()) << what;
    }
    if (!row.shown.trouble.empty()) {
      EXPECT_TRUE(row.of.is_count()) << what;
    }
  }
}

TEST(MeasureTable, LabelsOfThePageAreUniqueBelowTheirHeading) {
  std::map<std::string, std::set<std::string>> below;
  std::string heading;
  for (const Measure& row : measures()) {
    if (row.shown.label.empty() || row.shown.place == ShownIn::kTable) continue;
    const std::string label = label_of(row);
    if (!label.starts_with(' ')) heading = label;
    EXPECT_TRUE(below[heading].insert(label).second) << heading << ": " << label;
  }
}

TEST(MeasureTable, ADriveWithoutComparisonHasNoValueInsteadOfAPerfectZero) {
  const accuracy::DriveSummary summary;
  const sim::drives::DriveOutcome outcome;
  const DriveFigures figures{summary, outcome};
  for (const char* const name : {"position_rmse_truth", "gospa", "switches", "missed", "age_fused", "precision", "nis",
                                 "smallest_gap", "collision", "warnings_wrong"})
    EXPECT_TRUE(std::isnan(value_of(*find_measure(name), figures))) << name;
  nlohmann::ordered_json json;
  add_to(json, measures(), figures);
  EXPECT_EQ(json["rmse_truth"]["position_m"], nullptr);
  EXPECT_EQ(json["nees"]["band_95"], nlohmann::ordered_json::array({nullptr, nullptr}));
  EXPECT_EQ(json["clear_mot"]["switches"], nullptr);
  EXPECT_EQ(json["objects"]["missed"], nullptr);
  EXPECT_FALSE(json.contains("driving"));
  EXPECT_FALSE(json.contains("odometry"));
}

TEST(MeasureTable, SharesOfObjectsInViewAndOfAll) {
  accuracy::DriveSummary summary;
  summary.missed = 2;
  summary.matched = 6;
  summary.out_of_view = 24;
  const sim::drives::DriveOutcome outcome;
  const DriveFigures figures{summary, outcome};
  EXPECT_EQ(value_of(*find_measure("missed"), figures), 2.0 / 8.0);
  EXPECT_EQ(value_of(*find_measure("out_of_view"), figures), 24.0 / 32.0);
}

TEST(MeasureTable, APartThatADrivenVehicleHasNotIsNullOrAbsent) {
  const accuracy::DriveSummary summary;
  const sim::drives::DriveOutcome outcome;
  driving::DrivingFindings driving;
  const DriveFigures figures{summary, outcome, &driving};
  nlohmann::ordered_json json;
  add_to(json, measures(), figures);
  for (const char* const part : {"collision", "detections", "reaction_s", "stopping_distance_m", "smallest_gap_m"})
    EXPECT_EQ(json["driving"].at(part), nullptr) << part;
  EXPECT_EQ(value_of(*find_measure("collision"), figures), 0.0);
  EXPECT_TRUE(std::isnan(value_of(*find_measure("warnings_missed"), figures))) << "no service warns";
  for (const char* const part : {"lane", "collision_warnings", "blind_spot_warnings"})
    EXPECT_FALSE(json["driving"].contains(part)) << part;

  driving.warns_ahead = true;
  driving.warnings[index_of(recording::records::WarningKind::kForwardCollision)].missed = 2;
  driving.collision = driving::DrivingFindings::Collision{TrueTime{}, 3.5};
  nlohmann::ordered_json more;
  add_to(more, measures(), figures);
  EXPECT_EQ(more["driving"]["collision"]["closing_mps"], 3.5);
  EXPECT_EQ(more["driving"]["collision_warnings"]["missed"], 2u);
  EXPECT_EQ(more["driving"]["collision_warnings"]["late_mean_ms"], nullptr);
  EXPECT_EQ(value_of(*find_measure("collision"), figures), 1.0);
  EXPECT_EQ(value_of(*find_measure("warnings_missed"), figures), 2.0);
}

}  // namespace
}  // namespace ttf::evaluation::measures
