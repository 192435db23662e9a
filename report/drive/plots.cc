#include "report/drive/plots.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "report/drawing/axes.h"

namespace ttf::report::drive {
namespace {

constexpr std::size_t kMostPoints = 3000;  // a curve's most; a longer curve keeps the largest of neighbours
constexpr int kBins = 40;
constexpr std::string_view kTimeAxis = "true time [s]";

using Series = std::vector<TimedValue> DriveSeries::*;

std::vector<page::Curve> curves_of(const std::vector<ReportedDrive>& drives, Series series) {
  std::vector<page::Curve> curves;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    page::Curve curve{drives[d].drive->label, static_cast<int>(d), {}, {}, {}, {}};
    for (const TimedValue& one : thinned(drives[d].series.*series, kMostPoints)) {
      curve.x.push_back(one.t_s);
      curve.y.push_back(one.value);
    }
    if (!curve.x.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

void add_view(page::Plot& plot, std::string label, std::string y, std::vector<page::Curve> curves) {
  if (!curves.empty()) plot.views.push_back({std::move(label), std::move(y), std::move(curves)});
}

std::string sensor_name(const std::vector<ReportedDrive>& drives, SensorId sensor) {
  for (const ReportedDrive& reported : drives)
    if (reported.drive->log && index_of(sensor) < reported.drive->log->manifest().sensor_names.size())
      return reported.drive->log->manifest().sensor_names[index_of(sensor)];
  return "sensor " + std::to_string(index_of(sensor));
}

using Ages = std::map<SensorId, std::vector<double>> DriveSeries::*;

// Adds one view of all sensors together, and one for each of several sensors.
void add_age_views(page::Plot& plot, const std::vector<ReportedDrive>& drives, Ages ages, const std::string& when) {
  std::set<SensorId> sensors;
  std::vector<NamedValues> all;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    NamedValues& one = all.emplace_back(NamedValues{drives[d].drive->label, static_cast<int>(d), {}});
    for (const auto& [sensor, values] : drives[d].series.*ages) {
      sensors.insert(sensor);
      one.values.insert(one.values.end(), values.begin(), values.end());
    }
  }
  add_view(plot, "age when " + when + ", all sensors", "share [%]", histogram(all, kBins));
  for (const SensorId sensor : sensors) {
    if (sensors.size() < 2) break;
    std::vector<NamedValues> of_one;
    for (std::size_t d = 0; d < drives.size(); ++d)
      if (const auto found = (drives[d].series.*ages).find(sensor); found != (drives[d].series.*ages).end())
        of_one.push_back({drives[d].drive->label, static_cast<int>(d), found->second});
    add_view(plot, "age when " + when + ", " + sensor_name(drives, sensor), "share [%]", histogram(of_one, kBins));
  }
}

}  // namespace

std::vector<page::Curve> histogram(const std::vector<NamedValues>& all, int bins) {
  drawing::Extent extent;
  for (const NamedValues& one : all)
    for (const double value : one.values) extent.add(value);
  if (extent.empty()) return {};
  const double step = nice_ticks(extent.padded(0.0, 1e-9 + 1e-6 * std::abs(extent.high)), bins).step;
  const double first = std::floor(extent.low / step) * step;
  // A damaged log may hold values far from all others, even at an infinite distance.
  const double wanted = std::floor((extent.high - first) / step) + 1.0;
  const std::size_t count = wanted >= 1.0 && wanted < 1000.0 ? static_cast<std::size_t>(wanted) : 1000;
  const auto bin_of = [&](double value) {
    const double bin = (value - first) / step;
    return bin > 0.0 ? static_cast<std::size_t>(std::min(bin, static_cast<double>(count - 1))) : 0;
  };
  std::vector<page::Curve> curves;
  for (const NamedValues& one : all) {
    std::vector<double> shares(count, 0.0);
    double finite = 0.0;
    for (const double value : one.values) {
      if (!std::isfinite(value)) continue;
      ++finite;
      shares[bin_of(value)] += 1.0;
    }
    if (finite == 0.0) continue;
    page::Curve curve{one.label, one.colour, {}, {}, {}, {}};
    for (std::size_t b = 0; b <= count; ++b) {
      curve.x.push_back(first + static_cast<double>(b) * step);
      curve.y.push_back(b < count ? 100.0 * shares[b] / finite : 0.0);
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

page::Plot error_plot(const std::vector<ReportedDrive>& drives) {
  page::Plot plot{"Error over time",
                  "At each use of an image, against the truth: the root mean square over the matched objects.",
                  std::string(kTimeAxis),
                  page::Plot::Kind::kLines,
                  false,
                  false,
                  {}};
  add_view(plot, "position", "position error [m]", curves_of(drives, &DriveSeries::position_error));
  add_view(plot, "velocity", "velocity error [m/s]", curves_of(drives, &DriveSeries::velocity_error));
  return plot;
}

page::Plot age_plot(const std::vector<ReportedDrive>& drives) {
  page::Plot plot{"Age over time",
                  "Age of each sensor's newest measurement in an image, at the image's use.",
                  std::string(kTimeAxis),
                  page::Plot::Kind::kLines,
                  false,
                  false,
                  {}};
  add_view(plot, "newest of the sensors", "age [ms]", curves_of(drives, &DriveSeries::newest_age));
  add_view(plot, "oldest of the sensors", "age [ms]", curves_of(drives, &DriveSeries::oldest_age));
  return plot;
}

page::Plot age_histogram(const std::vector<ReportedDrive>& drives) {
  page::Plot plot{"Ages of measurements",
                  "Latency from the instant of measuring, as shares of all.",
                  "age [ms]",
                  page::Plot::Kind::kSteps,
                  false,
                  false,
                  {}};
  add_age_views(plot, drives, &DriveSeries::age_used, "used");
  add_age_views(plot, drives, &DriveSeries::age_fused, "fused");
  return plot;
}

page::Plot precision_plot(const std::vector<ReportedDrive>& drives) {
  page::Plot plot{"Precision",
                  "Largest difference between any two nodes' global times, double cycle by double cycle.",
                  std::string(kTimeAxis),
                  page::Plot::Kind::kLines,
                  false,
                  false,
                  {}};
  add_view(plot, "precision", "clocks apart [us]", curves_of(drives, &DriveSeries::precision));
  return plot;
}

page::Plot corrections_plot(const ReportedDrive& reported, const drawing::Names& names) {
  page::Plot plot{reported.drive->label + ": offset corrections",
                  "Each node's correction of its clock in a double cycle.",
                  std::string(kTimeAxis),
                  page::Plot::Kind::kLines,
                  false,
                  true,
                  {}};
  std::vector<page::Curve> curves;
  int colour = 0;
  for (const auto& [node, values] : reported.series.offset_corrections) {
    page::Curve curve{names.node(node), colour++, {}, {}, {}, {}};
    for (const TimedValue& one : thinned(values, kMostPoints)) {
      curve.x.push_back(one.t_s);
      curve.y.push_back(one.value);
    }
    curves.push_back(std::move(curve));
  }
  add_view(plot, "offset", "correction [microticks]", std::move(curves));
  return plot;
}

}  // namespace ttf::report::drive
