#include "recording/exports/tables.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "recording/exports/captures.h"
#include "recording/scene/instants.h"

namespace ttf::recording::exports {
namespace {

// A damaged log may have any global times.
constexpr Duration kFarthest = Duration::milliseconds(3'600'000);

// A global time as the true time, unless it is far away from its record.
std::optional<TrueTime> true_time(const records::Stamp& stamp, GlobalTime at) {
  using scene::within_reach;
  if (!within_reach(stamp.true_time.ns) || !within_reach(stamp.global.ns) || !within_reach(at.ns)) return std::nullopt;
  const Duration ahead = at - stamp.global;
  if (ahead >= kFarthest || ahead <= -kFarthest) return std::nullopt;
  return records::true_time_of(stamp, at);
}

constexpr ColumnOf<records::TruthState> kTruth[] = {
    {"time_s", [](auto& r) { return r.at; }},
    {"object", [](auto& r) { return index_of(r.object); }},
    {"x_m", [](auto& r) { return r.x; }},
    {"y_m", [](auto& r) { return r.y; }},
    {"heading_rad", [](auto& r) { return r.heading; }},
    {"speed_mps", [](auto& r) { return r.speed; }},
    {"acceleration_mps2", [](auto& r) { return r.acceleration; }},
    {"yaw_rate_radps", [](auto& r) { return r.yaw_rate; }},
    {"length_m", [](auto& r) { return r.length; }},
    {"width_m", [](auto& r) { return r.width; }},
};

double sigma(const records::TrackState& track, std::size_t k) { return std::sqrt(track.covariance[7 * k]); }  // 6 x 6
constexpr ColumnOf<records::TrackState> kTracks[] = {
    {"time_s", [](auto& r) { return r.stamp.true_time; }},
    {"step", [](auto& r) { return r.step; }},
    {"track", [](auto& r) { return index_of(r.track); }},
    {"valid_at_s", [](auto& r) { return true_time(r.stamp, r.valid_at); }},
    {"for_image", [](auto& r) { return r.predicted_for_image; }},
    {"x_m", [](auto& r) { return r.state[0]; }},
    {"y_m", [](auto& r) { return r.state[1]; }},
    {"vx_mps", [](auto& r) { return r.state[2]; }},
    {"vy_mps", [](auto& r) { return r.state[3]; }},
    {"ax_mps2", [](auto& r) { return r.state[4]; }},
    {"ay_mps2", [](auto& r) { return r.state[5]; }},
    {"sigma_x_m", [](auto& r) { return sigma(r, 0); }},
    {"sigma_y_m", [](auto& r) { return sigma(r, 1); }},
    {"sigma_vx_mps", [](auto& r) { return sigma(r, 2); }},
    {"sigma_vy_mps", [](auto& r) { return sigma(r, 3); }},
    {"sigma_ax_mps2", [](auto& r) { return sigma(r, 4); }},
    {"sigma_ay_mps2", [](auto& r) { return sigma(r, 5); }},
};

struct ImageRow {
  const records::ImageWritten& image;
  const records::ImageObject& object;
  std::optional<TrueTime> valid_at, newest;
};
constexpr ColumnOf<ImageRow> kImages[] = {
    {"time_s", [](auto& r) { return r.image.stamp.true_time; }},
    {"image", [](auto& r) { return r.image.sequence; }},
    {"valid_at_s", [](auto& r) { return r.valid_at; }},
    {"newest_measurement_s", [](auto& r) { return r.newest; }},
    {"track", [](auto& r) { return index_of(r.object.track); }},
    {"confirmed", [](auto& r) { return has(r.object.status, records::ImageStatus::kConfirmed); }},
    {"coasting", [](auto& r) { return has(r.object.status, records::ImageStatus::kCoasting); }},
    {"length_measured", [](auto& r) { return has(r.object.status, records::ImageStatus::kHasLength); }},
    {"width_measured", [](auto& r) { return has(r.object.status, records::ImageStatus::kHasWidth); }},
    {"x_m", [](auto& r) { return r.object.x; }},
    {"y_m", [](auto& r) { return r.object.y; }},
    {"heading_rad", [](auto& r) { return r.object.heading; }},
    {"speed_mps", [](auto& r) { return r.object.speed; }},
    {"acceleration_mps2", [](auto& r) { return r.object.acceleration; }},
    {"length_m", [](auto& r) { return r.object.length; }},
    {"width_m", [](auto& r) { return r.object.width; }},
    {"sigma_x_m", [](auto& r) { return r.object.sigma_x; }},
    {"sigma_y_m", [](auto& r) { return r.object.sigma_y; }},
    {"correlation_xy", [](auto& r) { return r.object.correlation_xy; }},
    {"sigma_heading_rad", [](auto& r) { return r.object.sigma_heading; }},
    {"sigma_speed_mps", [](auto& r) { return r.object.sigma_speed; }},
    {"sigma_acceleration_mps2", [](auto& r) { return r.object.sigma_acceleration; }},
    {"sigma_length_m", [](auto& r) { return r.object.sigma_length; }},
    {"sigma_width_m", [](auto& r) { return r.object.sigma_width; }},
};

struct AgeRow {
  TrueTime used;
  std::uint32_t image;
  std::string sensor;
  Duration age;
};
constexpr ColumnOf<AgeRow> kAges[] = {
    {"time_s", [](auto& r) { return r.used; }},
    {"image", [](auto& r) { return r.image; }},
    {"sensor", [](auto& r) { return r.sensor; }},
    {"age_ms", [](auto& r) { return in_ms(r.age); }},
};

constexpr ColumnOf<TableError> kErrors[] = {
    {"time_s", [](auto& r) { return r.used; }},
    {"object", [](auto& r) { return index_of(r.object); }},
    {"error_x_m", [](auto& r) { return r.error[0]; }},
    {"error_y_m", [](auto& r) { return r.error[1]; }},
    {"error_vx_mps", [](auto& r) { return r.error[2]; }},
    {"error_vy_mps", [](auto& r) { return r.error[3]; }},
    {"sigma_x_m", [](auto& r) { return r.sigma[0]; }},
    {"sigma_y_m", [](auto& r) { return r.sigma[1]; }},
    {"sigma_vx_mps", [](auto& r) { return r.sigma[2]; }},
    {"sigma_vy_mps", [](auto& r) { return r.sigma[3]; }},
    {"error_heading_rad", [](auto& r) { return r.heading_rad; }},
    {"error_length_m", [](auto& r) { return r.length_m; }},
    {"error_width_m", [](auto& r) { return r.width_m; }},
    {"nees", [](auto& r) { return r.nees; }},
};

struct TaskRow {
  const records::TaskRun& run;
  const LogNames& names;
};
constexpr ColumnOf<TaskRow> kTasks[] = {
    {"time_s", [](auto& r) { return r.run.start.true_time; }},
    {"node", [](auto& r) { return r.names.node(r.run.start.node); }},
    {"task", [](auto& r) { return r.names.task(r.run.start.node, r.run.task); }},
    {"activated_s", [](auto& r) { return r.run.activated.true_time; }},
    {"end_s", [](auto& r) { return r.run.end.true_time; }},
    {"deadline_met", [](auto& r) { return r.run.deadline_met; }},
};

std::vector<Column> timed_frame_columns() {
  std::vector<Column> columns = frame_columns();
  columns.insert(columns.begin(), {"time_s", ColumnType::kReal});
  return columns;
}

}  // namespace

std::vector<Column> columns(Table table) {
  switch (table) {
    case Table::kTruth: return columns_of(kTruth);
    case Table::kTracks: return columns_of(kTracks);
    case Table::kImages: return columns_of(kImages);
    case Table::kAges: return columns_of(kAges);
    case Table::kErrors: return columns_of(kErrors);
    case Table::kTasks: return columns_of(kTasks);
    case Table::kFrames: return timed_frame_columns();
  }
  return {};
}

TableExport::TableExport(LogNames names, Write write) : names_(std::move(names)), write_(std::move(write)) {
  for (std::size_t t = 0; t < kTables; ++t)
    write_(static_cast<Table>(t), names_line(columns(static_cast<Table>(t))) + '\n');
}

void TableExport::row(Table table, std::string fields) {
  fields += '\n';
  write_(table, fields);
  ++rows_[static_cast<std::size_t>(table)];
}

// Every node that recorded the truth of an instant has the same: the first node's is kept.
void TableExport::on(const records::TruthState& r) {
  if (!truth_ || truth_->first != r.at) truth_.emplace(r.at, r.node);
  if (truth_->second == r.node) row(Table::kTruth, fields_line(kTruth, r));
}

void TableExport::on(const records::TrackState& r) { row(Table::kTracks, fields_line(kTracks, r)); }

void TableExport::on(const records::ImageWritten& r) {
  const std::optional<TrueTime> valid_at = true_time(r.stamp, r.valid_at),
                                newest = r.newest.empty() ? std::nullopt : true_time(r.stamp, r.newest_measurement);
  for (const records::ImageObject& object : r.objects)
    row(Table::kImages, fields_line(kImages, ImageRow{r, object, valid_at, newest}));
}

void TableExport::on(const records::TaskRun& r) { row(Table::kTasks, fields_line(kTasks, TaskRow{r, names_})); }

void TableExport::age(TrueTime used, std::uint32_t image, SensorId sensor, Duration age) {
  row(Table::kAges, fields_line(kAges, AgeRow{used, image, names_.sensor(sensor), age}));
}

void TableExport::error(const TableError& error) { row(Table::kErrors, fields_line(kErrors, error)); }

void TableExport::frames(const FrameCollector& collector) {
  for (const LoggedFrame& frame : collector.in_order())
    row(Table::kFrames,
        fmt::format("{},{}", field_of(TrueTime{frame.time_ns}), frame_fields(collector, frame, names_)));
}

}  // namespace ttf::recording::exports
