// One HTML page that needs no other file: text, tables, pictures, plots, scenes and timing diagrams, with their style
// and scripts (report/page/). Sections keep the order of their addition; the contents at the top list them.
//
// The page escapes all text, because names come from files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::report::page {

struct PageTable {
  std::string caption;
  std::vector<std::string> header;                               // the first column names the rows
  std::vector<std::vector<std::string>> rows;                    // missing cells at the end are empty
  std::vector<std::pair<std::string, std::size_t>> groups = {};  // a heading above so many columns of the header, or ""
};

// One curve. `low` and `high`, if present, are its interval; values that are not finite are gaps.
struct Curve {
  std::string label;
  int colour = 0;  // the same number has the same colour all over the page
  std::vector<double> x, y, low, high;
};

// One view of a plot. With several views, the reader chooses from a list above the plot.
struct PlotView {
  std::string label;  // in that list
  std::string y;      // axis, with its unit
  std::vector<Curve> curves;
};

struct Plot {
  std::string heading, caption;
  std::string x;                                                                   // axis, with its unit
  enum class Kind : std::uint8_t { kLines, kPoints, kSteps } kind = Kind::kLines;  // steps are for histograms
  bool logarithmic_x = false;
  bool zero = false;  // draws a line at 0, for differences
  std::vector<PlotView> views;
};

struct PageDiagram {
  std::string label, svg;               // TimingDiagram::svg(TimingUse::kPage)
  nlohmann::ordered_json windows = {};  // as report/timing/windows/packed.h packs them; null: `svg` alone
};

class Page {
 public:
  // `title` names the document and is its heading; `kind` stands above it, in a word or two.
  Page(std::string title, std::string kind);

  void section(std::string_view heading);
  void lead(std::string_view text);  // the conclusion, set large
  void paragraph(std::string_view text);
  void points(const std::vector<std::string>& sentences);
  void facts(const std::vector<std::pair<std::string, std::string>>& facts);
  void table(const PageTable& table);
  void plot(const Plot& plot);
  // Adds an SVG document of ours unchanged.
  void picture(std::string_view svg, std::string_view caption);
  void diagrams(std::vector<PageDiagram> diagrams, std::string_view caption);
  // Adds scenes side by side, each as report/scene/packed.h packs it, with one clock for all.
  void scenes(std::vector<nlohmann::ordered_json> scenes, std::string_view caption);
  void command(std::string_view words);                                // to copy into a shell
  void preformatted(std::string_view summary, std::string_view text);  // folded behind a line
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
  nlohmann::ordered_json scenes_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json timings_ = nlohmann::ordered_json::array();
  int pictures_ = 0, diagrams_ = 0;
};

// Returns the word quoted for a shell.
std::string shell_word(const std::string& word);

}  // namespace ttf::report::page
