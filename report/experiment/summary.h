// An experiment's summary.csv as it is drawn: its grid of points, and of each what the measures came to.
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
  std::vector<std::string> axes, paradigms, measures;  // in the order of the file; measures are fit for a file's name
  std::vector<SummaryPoint> points;
};

// Throws InputError where the text is none; `file` is for messages.
ExperimentSummary read_summary(std::string_view text, const std::string& file);

// "42 ms": the number, and what is behind it.
std::optional<std::pair<double, std::string>> number_with_unit(const std::string& label);

// Names in the order in which they came first, each once.
class NameList {
 public:
  // Where it is in the list; added where it is new.
  std::size_t place_of(const std::string& name);
  const std::vector<std::string>& names() const { return names_; }
  std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace ttf::report::experiment
