#include "report/experiment/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "core/counted.h"
#include "report/drive/plots.h"

namespace ttf::report::experiment {
namespace {

constexpr std::size_t kMostViews = 150;  // per plot
constexpr double kLogarithmic = 50.0;    // a larger factor between an axis' ends makes it logarithmic

// A number and its unit: "42 ms" is 42 and "ms".
struct Quantity {
  double value = 0.0;
  std::string unit;
};
std::optional<Quantity> quantity_of(const std::string& label) {
  char* end = nullptr;
  const double value = std::strtod(label.c_str(), &end);
  if (end == label.c_str() || !std::isfinite(value)) return std::nullopt;
  while (*end == ' ') ++end;
  return Quantity{value, end};
}

struct XAxis {
  std::optional<std::size_t> axis;  // no value: points by their number
  std::string name;
  bool logarithmic = false;
};

XAxis x_axis(const ExperimentFolder& folder) {
  XAxis chosen{std::nullopt, "point (see the table)", false};
  std::size_t most = 1;
  for (std::size_t a = 0; a < folder.axes.size(); ++a) {
    std::set<double> values;
    std::set<std::string> units;
    bool numeric = true;
    for (const ExperimentPoint& point : folder.points) {
      const auto quantity = quantity_of(point.settings[a]);
      numeric = numeric && quantity.has_value();
      if (!quantity) continue;
      values.insert(quantity->value);
      units.insert(quantity->unit);
    }
    // "500 us" and "1 ms" count as words: no table converts units.
    if (!numeric || units.size() != 1 || values.size() <= most) continue;
    most = values.size();
    const std::string& unit = *units.begin();
    chosen = {a, folder.axes[a] + (unit.empty() ? "" : " [" + unit + "]"),
              *values.begin() > 0.0 && *values.rbegin() / *values.begin() > kLogarithmic};
  }
  return chosen;
}

std::string others_of(const ExperimentFolder& folder, const ExperimentPoint& point, const XAxis& x) {
  std::vector<std::string> others;
  for (std::size_t a = 0; x.axis && a < folder.axes.size(); ++a)
    if (a != *x.axis) others.push_back(folder.axes[a] + " " + point.settings[a]);
  return joined(others);
}

page::Plot plot_over_axis(const ExperimentFolder& folder, bool differences) {
  const XAxis x = x_axis(folder);
  page::Plot plot{
      differences ? "Differences from " + folder.baseline_name() : "Means",
      fmt::format(
          "With {:g} % intervals{}.", 100.0 * folder.confidence,
          differences ? "; differences are paired, replication by replication: below 0 is less than the baseline" : ""),
      x.name,
      x.axis ? page::Plot::Kind::kLines : page::Plot::Kind::kPoints,
      x.logarithmic,
      differences,
      {}};
  const auto x_of = [&](const ExperimentPoint* point) {
    return x.axis ? quantity_of(point->settings[*x.axis])->value : static_cast<double>(point->point);
  };
  std::vector<std::string> combinations;
  std::map<std::string, std::vector<const ExperimentPoint*>> points;
  for (const ExperimentPoint& point : folder.points) {
    const std::string others = others_of(folder, point, x);
    if (points[others].empty()) combinations.push_back(others);
    points[others].push_back(&point);
  }
  if (x.axis)
    for (auto& [others, of_one] : points) std::ranges::stable_sort(of_one, {}, x_of);
  for (std::size_t m = 0; m < folder.measures.size(); ++m)
    for (const std::string& others : combinations) {
      if (plot.views.size() >= kMostViews) return plot;
      page::PlotView view{
          folder.measures[m].name + (others.empty() ? "" : ", " + others), folder.measures[m].with_unit(), {}};
      for (std::size_t p = 0; p < folder.paradigms.size(); ++p) {
        page::Curve curve{folder.paradigms[p], static_cast<int>(p), {}, {}, {}, {}};
        for (const ExperimentPoint* point : points.at(others)) {
          const Estimate& estimate = point->estimates[p][m];
          if (differences && !estimate.difference) continue;
          const experiments::results::Interval& interval = differences ? *estimate.difference : estimate.mean;
          curve.x.push_back(x_of(point));
          curve.y.push_back(interval.mean);
          curve.low.push_back(interval.low());
          curve.high.push_back(interval.high());
        }
        if (!curve.x.empty()) view.curves.push_back(std::move(curve));
      }
      if (!view.curves.empty()) plot.views.push_back(std::move(view));
    }
  return plot;
}

}  // namespace

page::Plot means_plot(const ExperimentFolder& folder) { return plot_over_axis(folder, false); }
page::Plot differences_plot(const ExperimentFolder& folder) { return plot_over_axis(folder, true); }

page::Plot replications_plot(const ExperimentFolder& folder) {
  page::Plot plot{"Distributions over the replications",
                  "Shares of a point's drives.",
                  "value",
                  page::Plot::Kind::kSteps,
                  false,
                  false,
                  {}};
  if (!folder.store) return plot;
  // Shows an even choice of many points.
  const std::size_t shown = std::clamp(kMostViews / folder.measures.size(), std::size_t{1}, folder.points.size());
  if (shown < folder.points.size())
    plot.caption += fmt::format(" {} of {} points are shown.", shown, folder.points.size());
  const std::vector<std::string>& columns = folder.store->head().measures;
  std::vector<std::vector<experiments::results::Row>> rows;
  std::vector<const ExperimentPoint*> points;
  for (std::size_t s = 0; s < shown; ++s) {
    points.push_back(&folder.points[s * folder.points.size() / shown]);
    rows.push_back(folder.store->of_point(points.back()->point));
  }
  for (const ExperimentMeasure& measure : folder.measures) {
    const auto column = static_cast<std::size_t>(std::ranges::find(columns, measure.name) - columns.begin());
    for (std::size_t s = 0; s < shown; ++s) {
      std::vector<drive::NamedValues> values;
      for (std::size_t p = 0; p < folder.paradigms.size(); ++p)
        values.push_back({folder.paradigms[p], static_cast<int>(p), {}});
      for (const experiments::results::Row& row : rows[s])
        if (row.status == experiments::results::kDone && row.key.paradigm < values.size())
          values[row.key.paradigm].values.push_back(row.values[column]);
      std::vector<std::string> settings;
      for (std::size_t a = 0; a < folder.axes.size(); ++a)
        settings.push_back(folder.axes[a] + " " + points[s]->settings[a]);
      std::vector<page::Curve> curves = histogram(values, 30);
      if (curves.empty()) continue;
      plot.views.push_back({measure.with_unit() + (settings.empty() ? "" : ", " + joined(settings)),
                            "share of runs [%]", std::move(curves)});
    }
  }
  return plot;
}

}  // namespace ttf::report::experiment
