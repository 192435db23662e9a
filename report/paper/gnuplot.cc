#include "report/paper/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/drawing/axes.h"

namespace ttf::report::paper {
namespace {

// Makes a comment line. A backslash at its end would continue it in the next line.
std::string comment(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  return "# " + text + (text.ends_with('\\') ? "." : "") + "\n";
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '`') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + '"';
}

std::string gnuplot_colour(std::size_t n) {
  constexpr std::array<std::string_view, 6> kColours{"#000000",       drawing::kVermilion, drawing::kBlue,
                                                     drawing::kGreen, drawing::kPurple,    drawing::kOrange};
  return fmt::format(" linecolor rgb \"{}\"", kColours[n % kColours.size()]);
}

std::string gnuplot_curve(std::size_t n) {
  constexpr std::array<int, 6> kPoints{7, 5, 9, 11, 13, 6};
  return fmt::format("{} dashtype {} pointtype {}", gnuplot_colour(n), n / kPoints.size() % 4 + 1,
                     kPoints[n % kPoints.size()]);
}

std::string table_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

PaperFile gnuplot_script(const GnuplotFigure& figure) {
  const auto columns = static_cast<std::size_t>(figure.columns);
  const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
  const double width = figure.panel_width_cm * figure.columns;
  const double height = figure.panel_height_cm * static_cast<double>(rows);
  std::string text = comment(fmt::format("gnuplot {0}.gp: draws {0}.pdf and {0}.png", figure.name));
  for (const std::string& line : figure.about) text += comment(line);
  text += fmt::format(
      "\n"
      "set datafile separator comma\n"
      "set encoding utf8\n"
      "set grid linecolor rgb \"#dddddd\"\n"
      "set border linewidth 0.7\n"
      "set tics scale 0.6\n"
      "set key noenhanced samplen 2 spacing 1.1 outside below horizontal\n"
      "set xlabel offset 0,0.5\n"
      "{}\n"
      "do for [format in \"pdf png\"] {{\n"
      "if (format eq \"pdf\") {{\n"
      "  set terminal pdfcairo noenhanced size {:.4g}cm,{:.4g}cm font \"DejaVu Sans,8\" linewidth 1.2\n"
      "}} else {{\n"
      "  set terminal pngcairo noenhanced size {:.0f},{:.0f} font \"DejaVu Sans,16\" linewidth 2.4 fontscale 1\n"
      "}}\n"
      "set output \"{}.\" . format\n"
      "set multiplot layout {},{}\n",
      figure.settings, width, height, width * 80, height * 80, figure.name, rows, columns);
  for (const std::string& panel : figure.panels) text += "\n" + panel;
  text += "\nunset multiplot\nunset output\n}\n";
  return {figure.name + ".gp", text};
}

}  // namespace ttf::report::paper
