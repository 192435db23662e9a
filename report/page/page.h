// One HTML page that needs nothing beside it: text, tables, pictures, plots and timing diagrams, with their style and
// script (report/page/). Sections come in the order they are added, and make the contents at its top.
//
// All text is escaped here: names come from files.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::report::page {

struct PageTable {
  std::string caption;
  std::vector<std::string> header;             // the first column names the rows
  std::vector<std::vector<std::string>> rows;  // cells missing at the end are empty
};

// One curve. `low` and `high`, if any, are its interval; what is not finite is a gap.
struct Curve {
  std::string label;
  int colour = 0;  // the same number is the same colour all over the page
  std::vector<double> x, y, low, high;
};

// What a plot shows; several of them in one plot are chosen from a list above it.
struct PlotView {
  std::string label;  // in that list
  std::string y;      // axis, with its unit
  std::vector<Curve> curves;
};

struct Plot {
  std::string heading, caption;
  std::string x;                                                                   // axis, with its unit
  enum class Kind : std::uint8_t { kLines, kPoints, kSteps } kind = Kind::kLines;  // steps: of histograms
  bool logarithmic_x = false;
  bool zero = false;  // a line at 0: differences
  std::vector<PlotView> views;
};

struct PageDiagram {
  std::string label, svg;  // TimingDiagram::svg(TimingUse::kPage)
};

class Page {
 public:
  // `title`: of the document and its heading; `kind`: what it is, in a word or two above it.
  Page(std::string title, std::string kind);

  void section(std::string_view heading);
  void lead(std::string_view text);  // what it comes to, set large
  void paragraph(std::string_view text);
  void points(const std::vector<std::string>& sentences);
  void facts(const std::vector<std::pair<std::string, std::string>>& facts);
  void table(const PageTable& table);
  void plot(const Plot& plot);
  // A picture as it is: an SVG document of ours.
  void picture(std::string_view svg, std::string_view caption);
  void diagrams(const std::vector<PageDiagram>& diagrams, std::string_view caption);
  void command(std::string_view words);                                // to be copied into a shell
  void preformatted(std::string_view summary, std::string_view text);  // behind a line that opens it
  void open_details(std::string_view summary);
  void close_details();

  std::string html() const;

 private:
  std::string title_, kind_, body_;
  struct Entry {
    std::string id, heading;
  };
  std::vector<Entry> contents_;
  nlohmann::ordered_json plots_ = nlohmann::ordered_json::array();
  int pictures_ = 0, diagrams_ = 0;
};

// The word as a shell takes it back.
std::string shell_word(const std::string& word);

}  // namespace ttf::report::page
