// An experiment's summary.csv for drawing: its grid of points, with the estimates of each point's measures.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::report::experiment {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

struct SummaryCell {
  double mean = kAbsent, half_width = kAbsent, difference = kAbsent, difference_half_width = kAbsent;
};
struct SummaryPoint {
  std::vector<std::string> labels;              // by axis
  std::vector<std::vector<SummaryCell>> cells;  // by measure, then paradigm
};
struct ExperimentSummary {
  std::vector<std::string> axes, paradigms, measures;  // in the order of the file; a measure can name a file
  std::vector<SummaryPoint> points;
};

// Throws InputError if the text is no summary; `file` is for messages.
ExperimentSummary read_summary(std::string_view text, const std::string& file);

// Splits "42 ms" into the number and the text behind it.
std::optional<std::pair<double, std::string>> number_with_unit(const std::string& label);

// Unique names in the order of their first occurrence.
class NameList {
 public:
  // Returns the name's place in the list; adds a new name.
  std::size_t place_of(const std::string& name);
  const std::vector<std::string>& names() const { return names_; }
  std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace ttf::report::experiment
