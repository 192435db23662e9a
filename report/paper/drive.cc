#include "report/paper/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/check.h"
#include "report/drawing/axes.h"

namespace ttf::report::paper {
namespace {

// Collects the curves of a plot command.
class Curves {
 public:
  void add(const std::string& curve) { text_ += (text_.empty() ? "plot " : ", \\\n  ") + curve; }
  bool empty() const { return text_.empty(); }
  // An empty panel needs a curve, too: it draws a white one.
  std::string command() const {
    return (text_.empty() ? "plot 0 with lines linecolor rgb \"#ffffff\" notitle" : text_) + "\n";
  }

 private:
  std::string text_;
};

bool is_sensor(std::string_view kind) { return kind != "truth" && kind != "reference" && kind != "image"; }

std::string table_of(const PaperDrive& drive, const char* what) {
  return gnuplot_text(drive.label + "_" + what + ".csv") + " skip 1";
}

std::string labels(const std::string& title, const std::string& x, const std::string& y) {
  return fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", gnuplot_text(title), gnuplot_text(x),
                     gnuplot_text(y));
}

int point_type(drawing::Marker marker) {
  switch (marker) {
    case drawing::Marker::kPlus: return 1;
    case drawing::Marker::kCross: return 2;
    case drawing::Marker::kSquare: return 4;
    case drawing::Marker::kCircle: return 6;
    case drawing::Marker::kTriangle: return 8;
    case drawing::Marker::kDownTriangle: return 10;
    case drawing::Marker::kDiamond: return 12;
  }
  TTF_CHECK(false, "marker {}", static_cast<int>(marker));
}

const PaperSensor& sensor_named(const PaperDrive& drive, const std::string& name) {
  const auto found =
      std::ranges::find_if(drive.sensors, [&](const PaperSensor& sensor) { return sensor.name == name; });
  TTF_CHECK(found != drive.sensors.end(), "{} has no sensor {}", drive.label, name);
  return *found;
}

// Returns colours and markers as in the other pictures (report/plots/position_draw.cc).
std::string style_of(const PaperDrive& drive, const std::string& kind) {
  const auto points = [](drawing::Marker marker, double size, std::string_view colour) {
    return fmt::format("with points pointtype {} pointsize {} linecolor rgb \"{}\"", point_type(marker), size, colour);
  };
  if (kind == "truth") return "with lines linecolor rgb \"#888888\" linewidth 1.5";
  if (kind == "reference") return points(drawing::Marker::kCircle, 0.5, drawing::kPurple);
  if (kind == "image") return points(drawing::Marker::kSquare, 0.35, drawing::kBlack);
  const auto sensor =
      std::ranges::find_if(drive.sensors, [&](const PaperSensor& one) { return sensor_kind(one.name) == kind; });
  TTF_CHECK(sensor != drive.sensors.end(), "{} has no sensor for {}", drive.label, kind);
  return points(sensor->marker, 0.4, sensor->colour);
}

// `x` and `y` are columns of the table: 2 is time, 3 and 4 are the plane.
std::string positions_panel(const PaperDrive& drive, const std::string& title, int x, int y) {
  constexpr const char* kAxes[] = {"", "", "time [s]", "x [m]", "y [m]"};
  Curves curves;
  for (const std::string& kind : drive.kinds) {
    const std::string style = style_of(drive, kind);
    curves.add(fmt::format("{} using (strcol(1) eq {} ? ${} : NaN):{} {} title {}", table_of(drive, "positions"),
                           gnuplot_text(kind), x, y, style, gnuplot_text(kind)));
  }
  return labels(title, kAxes[x], kAxes[y]) + curves.command();
}

PaperFile positions(const PaperDrive& drive) {
  GnuplotFigure figure;
  figure.name = drive.label + "_positions";
  figure.about = {drive.title + ": the tracked car by sensors, fusion and reference",
                  "axes follow ISO 8855: x forward, y left; from " + drive.label + "_positions.csv"};
  figure.columns = 1;
  figure.panel_width_cm = 17;
  figure.panels = {positions_panel(drive, drive.title, 2, 3), positions_panel(drive, "", 2, 4),
                   positions_panel(drive, "", 3, 4)};
  return gnuplot_script(figure);
}

// Draws an error with the filter's own band of two standard deviations.
std::string error_panel(const PaperDrive& drive, const std::string& axis, int error, int sigma) {
  const std::string of_object = fmt::format("$2=={}", drive.object), table = table_of(drive, "errors");
  Curves curves;
  if (drive.errors && drive.sigmas)
    curves.add(
        fmt::format("{0} using ({1} && valid({2}) ? $1 : NaN):(-2*${2}):(2*${2}) with filledcurves linecolor rgb "
                    "\"#cfe3f2\" title \"±2σ of the filter\"",
                    table, of_object, sigma));
  if (drive.errors)
    curves.add(
        fmt::format("{} using ({} ? $1 : NaN):{} with linespoints pointtype 7 pointsize 0.2 linecolor rgb \"#0072b2\" "
                    "title \"error\"",
                    table, of_object, error));
  curves.add("0 with lines linecolor rgb \"#888888\" notitle");
  return labels(drive.title, "time [s]", axis) + curves.command();
}

// For a single instant gnuplot has no range and complains. Each later panel sets its own range.
std::string range_of_errors(const PaperDrive& drive, bool any_of_one) {
  if (!any_of_one) return "";
  if (!drive.errors || drive.first_error_s < drive.last_error_s) return "set xrange [*:*]\n";
  return fmt::format("set xrange [{}:{}]\n", drive.first_error_s - 0.5, drive.first_error_s + 0.5);
}

PaperFile errors(const std::vector<PaperDrive>& drives) {
  const bool any_of_one = std::any_of(drives.begin(), drives.end(), [](const PaperDrive& drive) {
    return drive.errors && drive.first_error_s == drive.last_error_s;
  });
  GnuplotFigure figure;
  figure.name = "errors";
  figure.about = {"error of the image of the tracked car when it was used, against the truth, and ±2σ of the filter",
                  "from <run>_errors.csv"};
  figure.columns = 2;
  for (const PaperDrive& drive : drives) {
    const std::string range = range_of_errors(drive, any_of_one);
    figure.panels.push_back(range + error_panel(drive, "x error [m]", 3, 7));
    figure.panels.push_back(range + error_panel(drive, "y error [m]", 4, 8));
  }
  return gnuplot_script(figure);
}

PaperFile nees(const std::vector<PaperDrive>& drives) {
  GnuplotFigure figure;
  figure.name = "nees";
  figure.about = {
      "normalised estimation error squared of (x, y, vx, vy) over all objects, averaged over windows: 4 if the",
      "filter knows its own error. Grey is the band around 4 with 95 % of such averages, if samples were",
      "independent. They are not quite, so more lie outside. From <run>_nees.csv"};
  figure.settings = "set yrange [0:*]\nset autoscale xfix\n";
  for (const PaperDrive& drive : drives) {
    Curves curves;
    if (drive.nees) {
      const std::string table = table_of(drive, "nees");
      curves.add(
          fmt::format("{} using (($1+$2)/2):(4):1:2:5:6 with boxxyerror fillstyle solid noborder linecolor rgb "
                      "\"#dddddd\" title \"95 % if consistent\", 4 with lines linecolor rgb \"#888888\" notitle",
                      table));
      curves.add(fmt::format(
          "{} using (($1+$2)/2):4 with linespoints pointtype 7 pointsize 0.4 linecolor rgb \"#d55e00\" title "
          "\"mean\"",
          table));
    }
    figure.panels.push_back(labels(drive.title, "time [s]", "NEES, 4 degrees of freedom") + curves.command());
  }
  figure.panel_width_cm = 17;
  return gnuplot_script(figure);
}

std::string ages_panel(const PaperDrive& drive, const char* of, const std::string& axis, const char* counted) {
  Curves curves;
  for (const auto& [what, sensor] : drive.ages) {
    if (what != of) continue;
    curves.add(fmt::format(
        "{} using (strcol(1) eq \"{}\" && strcol(2) eq {} ? ($3+$4)/2 : NaN):5:($4-$3) with boxes title {} linecolor "
        "rgb \"{}\"",
        table_of(drive, "ages"), of, gnuplot_text(sensor), gnuplot_text(sensor), sensor_named(drive, sensor).colour));
  }
  return labels(drive.title, axis, counted) + curves.command();
}

PaperFile ages(const std::vector<PaperDrive>& drives) {
  GnuplotFigure figure;
  figure.name = "ages";
  figure.about = {
      "how old measurements were when they were fused, and the newest of each sensor when an image was used",
      "from <run>_ages.csv"};
  figure.columns = 2;
  double least = 0.0, most = 0.0;
  for (const PaperDrive& drive : drives)
    least = std::min(least, drive.least_age_ms), most = std::max(most, drive.most_age_ms);
  figure.settings = fmt::format(
      "set style fill transparent solid 0.5 noborder\nset yrange [0:*]\nset offsets 0,0,graph 0.05,0\n"
      "set xrange [{}:{}]\n",
      least, 1.03 * most);
  for (const PaperDrive& drive : drives) {
    figure.panels.push_back(ages_panel(drive, "fused", "age when fused [ms]", "measurements"));
    figure.panels.push_back(ages_panel(drive, "used", "age when used [ms]", "uses of an image"));
  }
  return gnuplot_script(figure);
}

}  // namespace

std::string sensor_kind(const std::string& name) {
  std::string_view last = name;  // `sensor truth` itself becomes `sensor sensor truth`
  while (last.starts_with("sensor ")) last.remove_prefix(std::string_view("sensor ").size());
  return is_sensor(last) ? name : "sensor " + name;
}

std::vector<PaperFile> scripts_of_drives(const std::vector<PaperDrive>& drives) {
  std::vector<PaperFile> files;
  for (const PaperDrive& drive : drives)
    if (!drive.kinds.empty()) files.push_back(positions(drive));
  const auto any = [&](auto has) { return std::any_of(drives.begin(), drives.end(), has); };
  if (any([](const PaperDrive& drive) { return drive.errors; })) files.push_back(errors(drives));
  if (any([](const PaperDrive& drive) { return drive.nees; })) files.push_back(nees(drives));
  if (any([](const PaperDrive& drive) { return !drive.ages.empty(); })) files.push_back(ages(drives));
  return files;
}

}  // namespace ttf::report::paper
