#include "report/drawing/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "report/drawing/svg.h"

namespace ttf::report::drawing {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;
constexpr double kLeastPlot = 90;  // units

[[noreturn]] void refuse(const char* option, const std::string& value, std::string expected) {
  throw InputError({"command line", 0, option, value, std::move(expected)});
}

// Returns a width in tenths of a millimetre that is not less.
double rounded_up_mm(double mm) { return std::ceil(mm * 10) / 10; }

}  // namespace

Sheet::Sheet(double width_mm, double font_pt) {
  const std::string width = fmt::format("{:g} mm", width_mm);
  if (!(width_mm >= kNarrowest_mm && width_mm <= kWidest_mm))
    refuse("--width", width, fmt::format("must be {:g}..{:g} mm", kNarrowest_mm, kWidest_mm));
  if (!(font_pt >= kSmallest_pt && font_pt <= kLargest_pt))
    refuse("--font-size", fmt::format("{:g}", font_pt),
           fmt::format("must be {:g}..{:g} pt", kSmallest_pt, kLargest_pt));
  mm_per_unit_ = font_pt / kPointsPerMm / kPaperText;
  width_ = width_mm / mm_per_unit_;
  if (width_ < kFewestUnits - 1e-9)
    refuse(
        "--width", width,
        fmt::format("must be at least {:g} mm with a font size of {:g} pt", rounded_up_mm(mm(kFewestUnits)), font_pt));
}

double Sheet::plot_width(double on_screen, double beside) const {
  if (!on_paper()) return on_screen;
  if (width_ - beside < kLeastPlot)
    refuse("--width", fmt::format("{:g} mm", mm(width_)),
           fmt::format("must be at least {:g} mm with a font size of {:g} pt, as the names beside the plot are long",
                       rounded_up_mm(mm(beside + kLeastPlot)), mm(kPaperText) * kPointsPerMm));
  return width_ - beside;
}

std::vector<std::string> broken(std::string_view text, double size, double width, bool bold) {
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    std::string longer = lines.back();
    if (at > 0) longer += ' ';
    longer += word;
    if (lines.back().empty() || text_width(longer, size, bold) <= width)
      lines.back() = std::move(longer);
    else
      lines.emplace_back(word);
    at = end + 1;
  }
  return lines;
}

}  // namespace ttf::report::drawing
