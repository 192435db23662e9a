#include "recording/exports/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "recording/exports/captures.h"
#include "recording/scene/instants.h"

namespace ttf::recording::exports {
namespace {

// Columns, in order; those without a type are real.
constexpr std::array<std::string_view, kTables> kHeads{
    "time_s,object INTEGER,x_m,y_m,heading_rad,speed_mps,acceleration_mps2,yaw_rate_radps,length_m,width_m",
    "time_s,step INTEGER,track INTEGER,valid_at_s,for_image INTEGER,x_m,y_m,vx_mps,vy_mps,ax_mps2,ay_mps2,"
    "sigma_x_m,sigma_y_m,sigma_vx_mps,sigma_vy_mps,sigma_ax_mps2,sigma_ay_mps2",
    "time_s,image INTEGER,valid_at_s,newest_measurement_s,track INTEGER,confirmed INTEGER,coasting INTEGER,"
    "length_measured INTEGER,width_measured INTEGER,x_m,y_m,heading_rad,speed_mps,acceleration_mps2,length_m,"
    "width_m,sigma_x_m,sigma_y_m,correlation_xy,sigma_heading_rad,sigma_speed_mps,sigma_acceleration_mps2,"
    "sigma_length_m,sigma_width_m",
    "time_s,image INTEGER,sensor TEXT,age_ms",
    "time_s,object INTEGER,error_x_m,error_y_m,error_vx_mps,error_vy_mps,sigma_x_m,sigma_y_m,sigma_vx_mps,"
    "sigma_vy_mps,error_heading_rad,error_length_m,error_width_m,nees",
    "time_s,node TEXT,task TEXT,activated_s,end_s,deadline_met INTEGER",
    "time_s,bus TEXT,channel TEXT,cycle INTEGER,id INTEGER,sender TEXT,kind TEXT,flags TEXT,pdu TEXT,"
    "sequence INTEGER,fragment INTEGER,measurement TEXT,payload TEXT"};

// A damaged log may have any global times.
constexpr Duration kFarthest = Duration::milliseconds(3'600'000);

// A number that reads back equal.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string seconds(TrueTime at) {
  const bool before = at.ns < 0;
  const std::uint64_t ns = before ? ~static_cast<std::uint64_t>(at.ns) + 1 : static_cast<std::uint64_t>(at.ns);
  return fmt::format("{}{}.{:09}", before ? "-" : "", ns / 1'000'000'000, ns % 1'000'000'000);
}

std::string seconds(const records::Stamp& stamp, GlobalTime at) {
  using scene::within_reach;
  if (!within_reach(stamp.true_time.ns) || !within_reach(stamp.global.ns) || !within_reach(at.ns)) return "";
  const Duration ahead = at - stamp.global;
  return ahead < kFarthest && ahead > -kFarthest ? seconds(records::true_time_of(stamp, at)) : "";
}

// Quotes a name that could not be read back without.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string numbers(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += ',' + number(value);
  return text;
}

}  // namespace

std::vector<Column> columns(Table table) {
  std::vector<Column> columns;
  std::string_view rest = kHeads[static_cast<std::size_t>(table)];
  while (!rest.empty()) {
    const std::string_view column = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), column.size() + 1));
    const std::size_t end = std::min(column.find(' '), column.size());
    const std::string_view type = column.substr(end);
    columns.push_back({column.substr(0, end), type == " INTEGER" ? ColumnType::kInteger
                                              : type == " TEXT"  ? ColumnType::kText
                                                                 : ColumnType::kReal});
  }
  return columns;
}

TableExport::TableExport(LogNames names, Write write) : names_(std::move(names)), write_(std::move(write)) {
  for (std::size_t t = 0; t < kTables; ++t) {
    std::string head;
    for (const Column& column : columns(static_cast<Table>(t)))
      head += fmt::format("{}{}", head.empty() ? "" : ",", column.name);
    write_(static_cast<Table>(t), head + '\n');
  }
}

void TableExport::row(Table table, std::string text) {
  text += '\n';
  write_(table, text);
  ++rows_[static_cast<std::size_t>(table)];
}

// Every node that recorded the truth of an instant has the same: the first node's is kept.
void TableExport::on(const records::TruthState& r) {
  if (!truth_ || truth_->first != r.at) truth_.emplace(r.at, r.node);
  if (truth_->second != r.node) return;
  row(Table::kTruth,
      fmt::format("{},{}{}", seconds(r.at), index_of(r.object),
                  numbers(std::array{r.x, r.y, r.heading, r.speed, r.acceleration, r.yaw_rate, r.length, r.width})));
}

void TableExport::on(const records::TrackState& r) {
  std::array<double, 6> sigma{};
  for (std::size_t k = 0; k < sigma.size(); ++k) sigma[k] = std::sqrt(r.covariance[7 * k]);  // of a 6 x 6 matrix
  row(Table::kTracks,
      fmt::format("{},{},{},{},{}{}{}", seconds(r.stamp.true_time), r.step, index_of(r.track),
                  seconds(r.stamp, r.valid_at), r.predicted_for_image ? 1 : 0, numbers(r.state), numbers(sigma)));
}

void TableExport::on(const records::ImageWritten& r) {
  const std::string newest = r.newest.empty() ? "" : seconds(r.stamp, r.newest_measurement);
  for (const records::ImageObject& o : r.objects) {
    const auto bit = [&](records::ImageStatus mask) { return has(o.status, mask) ? 1 : 0; };
    row(Table::kImages,
        fmt::format("{},{},{},{},{},{},{},{},{}{}", seconds(r.stamp.true_time), r.sequence,
                    seconds(r.stamp, r.valid_at), newest, index_of(o.track), bit(records::ImageStatus::kConfirmed),
                    bit(records::ImageStatus::kCoasting), bit(records::ImageStatus::kHasLength),
                    bit(records::ImageStatus::kHasWidth),
                    numbers(std::array{o.x, o.y, o.heading, o.speed, o.acceleration, o.length, o.width, o.sigma_x,
                                       o.sigma_y, o.correlation_xy, o.sigma_heading, o.sigma_speed,
                                       o.sigma_acceleration, o.sigma_length, o.sigma_width})));
  }
}

void TableExport::on(const records::TaskRun& r) {
  row(Table::kTasks, fmt::format("{},{},{},{},{},{}", seconds(r.start.true_time), field(names_.node(r.start.node)),
                                 field(names_.task(r.start.node, r.task)), seconds(r.activated.true_time),
                                 seconds(r.end.true_time), r.deadline_met ? 1 : 0));
}

void TableExport::age(TrueTime used, std::uint32_t image, SensorId sensor, Duration age) {
  row(Table::kAges, fmt::format("{},{},{},{}", seconds(used), image, field(names_.sensor(sensor)), number(in_ms(age))));
}

void TableExport::error(const TableError& e) {
  row(Table::kErrors, fmt::format("{},{}{}{}{}", seconds(e.used), index_of(e.object), numbers(e.error),
                                  numbers(e.sigma), numbers(std::array{e.heading_rad, e.length_m, e.width_m, e.nees})));
}

void TableExport::frames(const FrameCollector& collector) {
  for (const LoggedFrame& frame : collector.in_order())
    row(Table::kFrames, fmt::format("{},{}", seconds(TrueTime{frame.time_ns}), csv_fields(collector, frame, names_)));
}

}  // namespace ttf::recording::exports
