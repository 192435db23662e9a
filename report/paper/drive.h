// Scripts for a paper from one or several drives: positions, errors with the filter's own bands, consistency
// and ages. The exporter writes the tables:
//
//   <run>_positions.csv   kind,time_s,x_m,y_m                 kinds: truth, reference, image, and a sensor's (below)
//   <run>_errors.csv      time_s,object,x_error_m,y_error_m,vx_error_mps,vy_error_mps,x_sigma_m,...,nees
//   <run>_nees.csv        from_s,to_s,samples,mean,low_95,high_95
//   <run>_ages.csv        of,sensor,from_ms,to_ms,count       of: fused, used
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/drawing/svg.h"
#include "report/paper/gnuplot.h"

namespace ttf::report::paper {

inline constexpr const char kPositionsHead[] = "kind,time_s,x_m,y_m\n";
inline constexpr const char kErrorsHead[] =
    "time_s,object,x_error_m,y_error_m,vx_error_mps,vy_error_mps,x_sigma_m,y_sigma_m,vx_sigma_mps,vy_sigma_mps,nees\n";
inline constexpr const char kNeesHead[] = "from_s,to_s,samples,mean,low_95,high_95\n";
inline constexpr const char kAgesHead[] = "of,sensor,from_ms,to_ms,count\n";

// Returns a sensor's name, or `sensor truth` if the name would be another kind.
std::string sensor_kind(const std::string& name);

// A sensor as all pictures show it (report/drawing/names.h).
struct PaperSensor {
  std::string name, colour;  // "#d55e00"
  drawing::Marker marker{};
};

// The content of a drive's tables; absent content is not drawn.
struct PaperDrive {
  std::string label;  // names its files
  std::string title;
  std::vector<PaperSensor> sensors;
  std::vector<std::string> kinds;                         // of positions
  int object = 0;                                         // whose errors are drawn
  bool errors = false, sigmas = false, nees = false;      // for that object; for all
  double first_error_s = 0, last_error_s = 0;             // for that object
  std::vector<std::pair<std::string, std::string>> ages;  // (of, sensor)
  double least_age_ms = 0, most_age_ms = 0;               // 0 is within this range
};

std::vector<PaperFile> scripts_of_drives(const std::vector<PaperDrive>& drives);

}  // namespace ttf::report::paper
