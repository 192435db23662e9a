#include "report/paper/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/csv.h"
#include "report/experiment/summary.h"

namespace ttf::report::paper {
namespace {

constexpr double kWideRange = 20.0;  // a positive axis with a larger ratio of its ends is logarithmic

// The quantity along the pictures' x: an axis by its numbers, all of one unit, or else point after point.
struct AcrossAxis {
  std::optional<std::size_t> axis;
  bool by_number = false, logarithmic = false;
  std::string unit;
  double least = 0.0, most = 0.0;
};

AcrossAxis across(const experiment::ExperimentSummary& summary) {
  AcrossAxis found;
  for (std::size_t a = 0; a < summary.axes.size() && !found.by_number; ++a) {
    experiment::NameList labels;
    bool numbers = true;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    std::optional<std::string> unit;
    for (const experiment::SummaryPoint& point : summary.points) {
      labels.place_of(point.labels[a]);
      const auto number = experiment::number_with_unit(point.labels[a]);
      numbers = numbers && number && (!unit || *unit == number->second);
      if (!number) continue;
      least = std::min(least, number->first), most = std::max(most, number->first);
      unit = number->second;
    }
    numbers = numbers && least < most;  // "1 ms" and "1.0 ms" are one place
    if (labels.size() < 2 || (found.axis && !numbers)) continue;
    found = {a, numbers, numbers && least > 0.0 && most > kWideRange * least, numbers ? *unit : "", least, most};
  }
  return found;
}

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string unit_text(std::string unit) {
  for (const auto& [plain, sign] : {std::pair("^2", "²"), std::pair("^3", "³")})
    if (const auto at = unit.find(plain); at != std::string::npos) unit.replace(at, 2, sign);
  return unit.empty() ? "" : " [" + unit + "]";
}

// The figure of one measure.
class MeasureFigure {
 public:
  MeasureFigure(const experiment::ExperimentSummary& summary, std::size_t measure)
      : summary_(summary), measure_(measure), x_(across(summary)) {
    for (const experiment::SummaryPoint& point : summary_.points) cases_.place_of(others(point));
  }

  // Checks that the measure has a value at all: some drives have no value.
  bool any(int column = 0) const {
    for (std::size_t k = 0; k < cases_.size(); ++k)
      for (std::size_t p = 0; p < summary_.paradigms.size(); ++p)
        if (any(k, p, column)) return true;
    return false;
  }

  std::string table() const {
    std::string text = "case";
    for (const std::string& axis : summary_.axes) text += ',' + csv_field(axis);
    text += ",x";
    for (const std::string& paradigm : summary_.paradigms)
      for (const char* what : {"mean", "half_width", "difference", "difference_half_width"})
        text += ',' + csv_field(paradigm + "_" + what);
    text += '\n';
    for (std::size_t k = 0; k < cases_.size(); ++k) {
      std::size_t nth = 0;
      for (const experiment::SummaryPoint& point : summary_.points) {
        if (others(point) != cases_.names()[k]) continue;
        text += std::to_string(k);
        for (const std::string& label : point.labels) text += ',' + csv_field(label);
        const double x =
            x_.by_number ? experiment::number_with_unit(point.labels[*x_.axis])->first : static_cast<double>(nth++);
        text += ',' + table_number(x);
        for (const experiment::SummaryCell& cell : point.cells[measure_])
          for (const double value : {cell.mean, cell.half_width, cell.difference, cell.difference_half_width})
            text += ',' + table_number(value);
        text += '\n';
      }
    }
    return text;
  }

  PaperFile script(const std::string& experiment, const MeasureWords& words) const {
    const std::string& measure = summary_.measures[measure_];
    GnuplotFigure figure;
    figure.name = measure;
    figure.about = {
        fmt::format("{} of the experiment {}{}{}", measure, experiment, words.meaning.empty() ? "" : ": ",
                    words.meaning),
        fmt::format("from {}.csv; points of one place stand beside each other, so that their bars can be seen",
                    measure)};
    figure.settings = axis_settings();
    const bool differences = any(2);
    figure.columns = differences ? 2 : 1;
    for (std::size_t k = 0; k < cases_.size(); ++k) {
      figure.panels.push_back(panel(k, spaced(measure) + unit_text(words.unit), 0));
      if (differences) figure.panels.push_back(panel(k, "difference from " + baseline() + unit_text(words.unit), 2));
    }
    return gnuplot_script(figure);
  }

 private:
  // Names a point's settings except along x: points that differ only along x are one case.
  std::string others(const experiment::SummaryPoint& point) const {
    std::string text;
    for (std::size_t a = 0; a < summary_.axes.size(); ++a)
      if (a != x_.axis) text += (text.empty() ? "" : ", ") + summary_.axes[a] + " " + point.labels[a];
    return text;
  }

  static double value_of(const experiment::SummaryCell& cell, int column) {
    return column == 0 ? cell.mean : cell.difference;
  }
  // Checks that the paradigm has a finite value in the case.
  bool any(std::size_t k, std::size_t paradigm, int column) const {
    return std::any_of(summary_.points.begin(), summary_.points.end(), [&](const experiment::SummaryPoint& point) {
      return others(point) == cases_.names()[k] && std::isfinite(value_of(point.cells[measure_][paradigm], column));
    });
  }

  // The baseline has values and no difference from itself.
  bool may_be_baseline(std::size_t paradigm) const {
    bool values = false, differences = false;
    for (const experiment::SummaryPoint& point : summary_.points) {
      const experiment::SummaryCell& cell = point.cells[measure_][paradigm];
      values = values || std::isfinite(cell.mean);
      differences = differences || !std::isnan(cell.difference);
    }
    return values && !differences;
  }
  // Returns the baseline's name, or a general word if several paradigms qualify.
  std::string baseline() const {
    std::string name;
    for (std::size_t p = 0; p < summary_.paradigms.size(); ++p)
      if (may_be_baseline(p)) name = name.empty() ? summary_.paradigms[p] : "the baseline";
    return name.empty() ? "the baseline" : name;
  }

  std::string axis_settings() const {
    std::string text = "set xlabel " +
                       gnuplot_text(x_.axis ? spaced(summary_.axes[*x_.axis]) + unit_text(x_.unit) : "") +
                       " noenhanced\n";
    if (x_.logarithmic)
      text += fmt::format("set logscale x\nset xrange [{}:{}]\n", x_.least / 1.3, x_.most * 1.3);
    else if (x_.by_number)
      text += fmt::format("set xrange [{}:{}]\n", x_.least - 0.05 * (x_.most - x_.least),
                          x_.most + 0.05 * (x_.most - x_.least));
    else
      text += fmt::format("set xrange [-0.6:{}]\n", most_in_a_case() - 0.4);
    return text;
  }
  double most_in_a_case() const {
    std::map<std::string, double> there;
    double most = 0.0;
    for (const experiment::SummaryPoint& point : summary_.points) most = std::max(most, ++there[others(point)]);
    return most;
  }

  // Means of a range too wide for a linear picture are drawn logarithmically, if they are positive.
  bool logarithmic_means() const {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const experiment::SummaryPoint& point : summary_.points)
      for (const experiment::SummaryCell& cell : point.cells[measure_])
        if (!std::isnan(cell.mean)) least = std::min(least, cell.mean), most = std::max(most, cell.mean);
    return least > 0.0 && most > kWideRange * least;
  }

  // Sets the y range by hand if all values are equal.
  std::string range_of(std::size_t k, int column) const {
    double least = column == 2 ? 0.0 : std::numeric_limits<double>::infinity(), most = column == 2 ? 0.0 : -least;
    for (const experiment::SummaryPoint& point : summary_.points)
      for (const experiment::SummaryCell& cell : point.cells[measure_]) {
        const double value = value_of(cell, column), width = column == 0 ? cell.half_width : cell.difference_half_width;
        if (others(point) != cases_.names()[k] || !std::isfinite(value)) continue;
        least = std::min(least, value - (std::isfinite(width) ? width : 0.0));
        most = std::max(most, value + (std::isfinite(width) ? width : 0.0));
      }
    if (least < most) return "set yrange [*:*]\n";
    const double middle = least == most ? least : 0.0, room = middle == 0.0 ? 1.0 : 0.1 * std::abs(middle);
    return fmt::format("set yrange [{}:{}]\n", middle - room, middle + room);
  }

  // If x has no numbers, the points get their labels.
  std::string label_tics(std::size_t k) const {
    std::string names;
    std::size_t nth = 0;
    for (const experiment::SummaryPoint& point : summary_.points)
      if (x_.axis && others(point) == cases_.names()[k])
        names += fmt::format("{}{} {}", nth == 0 ? "" : ", ", gnuplot_text(point.labels[*x_.axis]), nth), ++nth;
    return names.empty() ? "unset xtics\n" : "set xtics (" + names + ")\n";
  }

  // `column` is 0 for means, 2 for differences.
  std::string panel(std::size_t k, const std::string& label, int column) const {
    std::string text =
        fmt::format("set title {}\nset ylabel {}\n", gnuplot_text(cases_.names()[k]), gnuplot_text(label));
    text += column == 0 && logarithmic_means() ? "set logscale y\n" : "unset logscale y\n";
    text += range_of(k, column);
    if (!x_.by_number) text += label_tics(k);
    std::string curves = column == 2 ? "0 with lines linecolor rgb \"#888888\" notitle" : "";
    const std::size_t first = summary_.axes.size() + 2;  // the column of x, counted from 1
    const std::size_t all = summary_.paradigms.size();
    const std::string table = gnuplot_text(summary_.measures[measure_] + ".csv");
    for (std::size_t p = 0; p < all; ++p) {
      if (!any(k, p, column)) continue;
      const double beside = static_cast<double>(p) - 0.5 * static_cast<double>(all - 1);
      const std::string x =
          x_.logarithmic
              ? fmt::format("${}*{:.6g}", first, std::pow(x_.most / x_.least, 0.006 * beside))
              : fmt::format("${}+{:.6g}", first,
                            (x_.by_number ? 0.006 * (x_.most - x_.least) : 0.6 / static_cast<double>(all)) * beside);
      const std::size_t value = first + 1 + 4 * p + static_cast<std::size_t>(column);
      // A missing interval, as after a single drive, has width 0.
      curves += fmt::format(
          "{}{} skip 1 using ($1=={}?{}:NaN):{}:(valid({})?column({}):0) with {} title {}{} "
          "pointsize 0.5",
          curves.empty() ? "" : ", \\\n  ", table, k, x, value, value + 1, value + 1,
          x_.by_number ? "yerrorlines" : "yerrorbars", gnuplot_text(summary_.paradigms[p]), gnuplot_curve(p));
    }
    if (curves.empty()) curves = "0 with lines linecolor rgb \"#ffffff\" notitle";
    return text + "plot " + curves + "\n";
  }

  const experiment::ExperimentSummary& summary_;
  std::size_t measure_;
  AcrossAxis x_;
  experiment::NameList cases_;
};

}  // namespace

std::vector<PaperFile> paper_of_experiment(std::string_view summary, const std::string& file, const std::string& name,
                                           const std::function<MeasureWords(std::string_view measure)>& words) {
  const experiment::ExperimentSummary read = experiment::read_summary(summary, file);
  std::vector<PaperFile> files;
  for (std::size_t m = 0; m < read.measures.size(); ++m) {
    const MeasureFigure figure(read, m);
    if (!figure.any()) continue;
    files.push_back({read.measures[m] + ".csv", figure.table()});
    files.push_back(figure.script(name, words(read.measures[m])));
  }
  return files;
}

}  // namespace ttf::report::paper
