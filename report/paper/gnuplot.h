// Pictures for papers: a table as CSV, and a gnuplot script that draws it and that the author can change.
//
//   gnuplot errors.gp        leaves errors.pdf and errors.png beside it
//
// For Debian's gnuplot-nox (5.4). Tables have a line of names; an empty field is an absent value.
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
  std::string name;                // names the script and its pictures
  std::vector<std::string> about;  // a description of the picture, one entry per line, as comments
  std::string settings;            // commands for all panels
  int columns = 1;
  double panel_width_cm = 8.5, panel_height_cm = 6.0;
  std::vector<std::string> panels;  // the commands of each panel, ending in a plot
};
PaperFile gnuplot_script(const GnuplotFigure& figure);

// Quotes text for gnuplot's double quotes, without its enhanced markup.
std::string gnuplot_text(std::string_view text);

// Returns the style of the n-th curve: colours by Okabe and Ito, distinct in grey by dashes and points. The
// first function returns " linecolor rgb ..." alone, the second adds " dashtype ... pointtype ...".
std::string gnuplot_colour(std::size_t n);
std::string gnuplot_curve(std::size_t n);

// Writes a number so that it reads back equal; "" if it is not finite.
std::string table_number(double value);

}  // namespace ttf::report::paper
