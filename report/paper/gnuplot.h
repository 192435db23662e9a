// Pictures for papers: a table as CSV, and a gnuplot script that draws it, for the author to change.
//
//   gnuplot errors.gp        leaves errors.pdf and errors.png beside it
//
// For Debian's gnuplot-nox (5.4). Tables have a line of names; an empty field is a value that is not there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::paper {

struct PaperFile {
  std::string name, text;
};

// A picture of panels, row by row.
struct GnuplotFigure {
  std::string name;                // of the script and of what it draws
  std::vector<std::string> about;  // what the picture shows, a line each; comments of the script
  std::string settings;            // commands for all panels
  int columns = 1;
  double panel_width_cm = 8.5, panel_height_cm = 6.0;
  std::vector<std::string> panels;  // commands of each, ending in a plot
};
PaperFile gnuplot_script(const GnuplotFigure& figure);

// As gnuplot reads it between double quotes, not as its enhanced text.
std::string gnuplot_text(std::string_view text);

// Of the n-th curve, Okabe and Ito's colours, told apart in grey by dashes and points: " linecolor rgb ..." alone, or
// with " dashtype ... pointtype ...".
std::string gnuplot_colour(std::size_t n);
std::string gnuplot_curve(std::size_t n);

// A number as tables have it: so that it is read as the same; empty where it is none.
std::string table_number(double value);

}  // namespace ttf::report::paper
