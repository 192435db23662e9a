// Makes the tables and pictures of docs/fusion/late_measurements.md. The cost of a late measurement at each lag
// comes from the kept counts of instructions (tests/bench/instruction_counts). The loss against the best
// estimate is computed without chance (true_error.h).
//   late_page PROJECT_DIR            makes them
//   late_page PROJECT_DIR --check    exits with 1 when they differ from the kept ones
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/drawing/axes.h"
#include "tests/fusion/oosm/any_methods.h"
#include "tests/fusion/oosm/true_error.h"

namespace ttf::fusion::oosm {
namespace {

using report::drawing::Area;
using report::drawing::Point;

constexpr int kLags[] = {1, 3, 5, 10};
constexpr double kNoises[] = {0.001, 0.01, 0.1, 1.0, 10.0, 100.0};
constexpr Kind kLateKinds[] = {Kind::kC, Kind::kB, Kind::kA, Kind::kBl1, Kind::kAl1};

std::string colour_of(Kind kind) {
  constexpr std::string_view kColours[] = {
      report::drawing::kBlack,  report::drawing::kGrey,    report::drawing::kGreen,
      report::drawing::kPurple, report::drawing::kBlue,    report::drawing::kVermilion,
      report::drawing::kYellow, report::drawing::kSkyBlue, report::drawing::kOrange};
  return std::string(kColours[static_cast<std::size_t>(kind)]);
}

bool one_lag_only(Kind kind) { return kind == Kind::kA || kind == Kind::kB || kind == Kind::kC; }

// ---- the cost

// Instructions by method and lag.
using Costs = std::map<std::pair<std::string, int>, long>;

Costs kept_costs(const std::string& project) {
  Costs costs;
  std::ifstream file(project + "/tests/bench/instruction_counts");
  std::string name;
  for (std::string count; file >> name >> count;) {
    const std::size_t last = name.rfind('_');
    if (name.rfind("late_", 0) == 0)
      costs[{name.substr(5, last - 5), std::stoi(name.substr(last + 1))}] = std::stol(count);
  }
  return costs;
}

std::string cost_table(const Costs& costs) {
  std::string table = "| method | 1 lag | 3 lags | 5 lags | 10 lags |\n|---|---|---|---|---|\n";
  for (const NamedKind& named : kKinds) {
    table += fmt::format("| {} |", named.name);
    for (const int lag : kLags) {
      const auto found = costs.find({std::string(named.name), lag});
      table += found == costs.end() ? " - |" : fmt::format(" {} |", found->second);
    }
    table += '\n';
  }
  return table;
}

// ---- the loss

// The standard deviation of the position's error [m].
double sigma(Kind kind, double noise, const Timeline<2, 1>& arrivals) {
  const Line motion{noise};
  return std::sqrt(
      true_error(OnLine(kind, motion), motion, linear::Matrix<2>(linear::Matrix<2>::Identity()), arrivals)(0, 0));
}

// In percent of the best, which is rewinding. Without a kind, the late measurement is left out.
double worse_by(std::optional<Kind> kind, double noise, int lag) {
  auto arrivals = positions(lag);
  const double best = sigma(Kind::kRewind, noise, arrivals);
  if (!kind) arrivals.pop_back();
  return 100.0 * (sigma(kind.value_or(Kind::kRewind), noise, arrivals) / best - 1.0);
}

std::string error_table() {
  std::string table = "| method | lag |";
  for (const double noise : kNoises) table += fmt::format(" q = {} |", noise);
  table += "\n|---|---|---|---|---|---|---|---|\n";
  const auto row = [&table](std::string_view name, std::optional<Kind> kind, int lag) {
    table += fmt::format("| {} | {} |", name, lag);
    for (const double noise : kNoises) table += fmt::format(" {:.2f} |", std::abs(worse_by(kind, noise, lag)));
    table += '\n';
  };
  for (const int lag : {1, 3}) {
    row("left out", {}, lag);
    for (const Kind kind : kLateKinds)
      if (lag == 1 || !one_lag_only(kind)) row(name_of(kind), kind, lag);
  }
  return table;
}

// ---- pictures

struct Curve {
  std::string name, colour, dash;
  std::vector<Point> points;
};

struct Panel {
  std::string title, x, y;
  report::drawing::Extent x_extent, y_extent;
  std::vector<Curve> curves;
};

std::string picture(std::string_view title, const std::vector<Panel>& panels) {
  constexpr double kLeft = 70, kWidth = 380, kHeight = 280, kTop = 100;
  std::map<std::string, report::drawing::LegendEntry> entries;
  std::vector<report::drawing::LegendEntry> legend;
  for (const Panel& panel : panels)
    for (const Curve& curve : panel.curves)
      if (entries.try_emplace(curve.name).second)
        legend.push_back({report::drawing::LegendEntry::Kind::kLine, curve.name, curve.colour, {}, false, curve.dash});
  const double width = static_cast<double>(panels.size()) * (kLeft + kWidth) + 24;
  report::drawing::Svg svg(width, kTop + kHeight + 54, title);
  svg.text({24, 24}, title, {.size = 14, .bold = true});
  report::drawing::draw_legend(svg, {24, 36}, width - 48, legend);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Panel& panel = panels[i];
    const Area area{kLeft + static_cast<double>(i) * (kLeft + kWidth), kTop, kWidth, kHeight};
    const report::drawing::PlotFrame frame(area, panel.x_extent, panel.y_extent);
    frame.draw(svg, panel.x, panel.y);
    svg.text({area.x, area.y - 8}, panel.title, {.size = 12});
    svg.open_group("curves", area);
    for (const Curve& curve : panel.curves) {
      std::vector<Point> drawn;
      for (const Point& p : curve.points) drawn.push_back(frame.at(p.x, p.y));
      svg.polyline(drawn, {.stroke = curve.colour, .width = 1.6, .dash = curve.dash}, false, curve.name, "curve");
    }
    svg.close_group();
  }
  return svg.str();
}

std::string cost_picture(const Costs& costs) {
  Panel panel{"", "lags", "instructions", {0, 11}, {0, 9000}, {}};
  for (const NamedKind& named : kKinds) {
    if (one_lag_only(named.kind) || named.kind == Kind::kAugmented) continue;
    Curve curve{std::string(named.name), colour_of(named.kind), "", {}};
    for (const int lag : kLags)
      if (const auto found = costs.find({std::string(named.name), lag}); found != costs.end())
        curve.points.push_back({static_cast<double>(lag), static_cast<double>(found->second)});
    panel.curves.push_back(std::move(curve));
  }
  return picture("What one late measurement costs", {panel});
}

std::string error_picture() {
  std::vector<Panel> panels;
  for (const int lag : {1, 3}) {
    Panel panel{lag == 1 ? "1 lag" : "3 lags",
                "process noise q [m^2/s^3], power of ten",
                "worse by [%], power of ten",
                {-3, 2},
                {-3, 2},
                {}};
    const auto curve = [&](std::string_view name, std::optional<Kind> kind, const std::string& colour) {
      // B and Bl1 are one line at one lag.
      Curve made{std::string(name), colour, !kind ? "5 3" : kind == Kind::kBl1 ? "2 4" : "", {}};
      for (int step = -30; step <= 20; ++step)
        if (const double worse = worse_by(kind, std::pow(10.0, 0.1 * step), lag); worse > 1e-4)
          made.points.push_back({0.1 * step, std::log10(worse)});
      if (!made.points.empty()) panel.curves.push_back(std::move(made));
    };
    curve("left out", {}, std::string(report::drawing::kBlack));
    for (const Kind kind : kLateKinds)
      if (lag == 1 || !one_lag_only(kind)) curve(name_of(kind), kind, colour_of(kind));
    panels.push_back(std::move(panel));
  }
  return picture("What the position is worse by than with an exact method", panels);
}

// ---- the page

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Replaces the text between "<!-- name -->" and "<!-- end -->" by `table`.
std::string with(const std::string& page, const std::string& name, const std::string& table) {
  const std::string begin = "<!-- " + name + " -->\n";
  const std::size_t from = page.find(begin);
  if (from == std::string::npos) return page;
  const std::size_t to = page.find("<!-- end -->", from);
  return page.substr(0, from + begin.size()) + table + page.substr(to);
}

int make(const std::string& project, bool check) {
  const Costs costs = kept_costs(project);
  const std::string page = project + "/docs/fusion/late_measurements.md", pictures = project + "/docs/pictures/";
  const std::pair<std::string, std::string> files[] = {
      {page, with(with(read(page), "costs", cost_table(costs)), "errors", error_table())},
      {pictures + "late_cost.svg", cost_picture(costs)},
      {pictures + "late_error.svg", error_picture()}};
  int different = 0;
  for (const auto& [path, content] : files) {
    if (read(path) == content) continue;
    ++different;
    if (check)
      fmt::print(stderr, "{} is not what is computed; if that is right: late_page {}\n", path, project);
    else
      std::ofstream(path, std::ios::binary) << content;
  }
  return check && different > 0 ? 1 : 0;
}

}  // namespace
}  // namespace ttf::fusion::oosm

int main(int argc, char** argv) {
  const bool check = argc == 3 && std::string_view(argv[2]) == "--check";
  if (argc != 2 && !check) {
    fmt::print(stderr, "usage: late_page PROJECT_DIR [--check]\n");
    return 2;
  }
  return ttf::fusion::oosm::make(argv[1], check);
}
