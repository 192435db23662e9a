// A drive as tables for Python, R, spreadsheets and databases: comma-separated text (RFC 4180) with a line of names, which
// have the units. Each table is in the order of time; rows of one instant are in the order of the records.
//
//   truth    a row for each object and instant of the truth
//   tracks   a row for each confirmed track after each step of the fusion, and for each prediction for an image
//   images   a row for each object of an image, as decoded from the bus
//   ages     a row for each sensor in a used image: the age of its newest measurement
//   errors   a row for each object of a used image that matches a true one: estimate minus truth
//   tasks    a row for each execution of a task
//   frames   a row for each frame of any bus, and for each symbol (captures.h)
//
// Positions are in the sensor vehicle's axes (ISO 8855), and velocities are relative to it. Times are exact seconds of true
// time since the start of the drive. Numbers read back equal. An empty field is an absent value, such as a number that is not
// finite. In a damaged log it may be a global time, too, that is far away from its record.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/exports/columns.h"
#include "recording/exports/frames.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {

enum class Table : std::uint8_t { kTruth, kTracks, kImages, kAges, kErrors, kTasks, kFrames };
inline constexpr std::size_t kTables = 7;
inline constexpr std::array<std::string_view, kTables> kTableNames{"truth",  "tracks", "images", "ages",
                                                                   "errors", "tasks",  "frames"};

// Returns the columns in the order of a row's fields. Any field may be empty.
std::vector<Column> columns(Table table);

// A matched object of a used image. Unknown values are not a number.
struct TableError {
  TrueTime used{};
  ObjectId object{};
  std::array<double, 4> error{}, sigma{};  // x, y [m], vx, vy [m/s]
  double heading_rad = 0.0, length_m = 0.0, width_m = 0.0, nees = 0.0;
};

// Takes records in the order of MergedLogs::read().
class TableExport final : public records::Sink {
 public:
  // Receives the text of a table, line by line, with the line's end; the first is the line of names.
  using Write = std::function<void(ttf::recording::exports::Table, std::string_view)>;
  TableExport(LogNames names, Write write);

  // An evaluation of the same records reports ages and errors.
  void age(TrueTime used, std::uint32_t image, SensorId sensor, Duration age);
  void error(const TableError& error);
  // Writes all frames. Call it once, after the last record.
  void frames(const FrameCollector& collector);

  const std::array<std::uint64_t, kTables>& rows() const { return rows_; }

  using records::Sink::on;
  void on(const records::TruthState&) override;
  void on(const records::TrackState&) override;
  void on(const records::ImageWritten&) override;
  void on(const records::TaskRun&) override;

 private:
  void row(Table table, std::string fields);

  LogNames names_;
  Write write_;
  std::array<std::uint64_t, kTables> rows_{};
  std::optional<std::pair<TrueTime, NodeId>> truth_;  // the last instant, and the node whose truth of it is kept
};

}  // namespace ttf::recording::exports
