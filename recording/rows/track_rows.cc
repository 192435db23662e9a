#include "recording/rows/track_rows.h"

#include <fmt/format.h>

#include "core/csv.h"
#include "core/decimal.h"

namespace ttf::recording::rows {
namespace {

std::string six_decimals(double value) {
  std::string text = fmt::format("{:.6f}", value);
  // A value rounded to zero has no sign.
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string if_known(const std::optional<double>& value) { return value ? six_decimals(*value) : ""; }

}  // namespace

std::string_view track_heading() {
  return "time,known,track,x,y,vx,vy,p_x_x,p_x_y,p_x_vx,p_x_vy,p_y_y,p_y_vx,p_y_vy,p_vx_vx,p_vx_vy,p_vy_vy,"
         "heading,sigma_heading,length,width,z,height,class,class_share,coasting\n";
}

std::string track_line(const TrackRow& row) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  std::string line =
      fmt::format("{},{},{}", scaled_text(row.time_ns, kSecondNs), scaled_text(row.known_ns, kSecondNs), row.track);
  for (const double value : {row.x, row.y, row.vx, row.vy}) line += ',' + six_decimals(value);
  for (const double value : row.covariance) line += fmt::format(",{:.9g}", value);
  line += ',' + six_decimals(row.heading) + ',' + six_decimals(row.sigma_heading);
  line += ',' + if_known(row.length) + ',' + if_known(row.width) + ',' + if_known(row.z) + ',' + if_known(row.height);
  line += ',' + csv_field(row.class_name) + ',' + (row.class_name.empty() ? "" : six_decimals(row.class_share));
  line += row.coasting ? ",1\n" : ",0\n";
  return line;
}

}  // namespace ttf::recording::rows
