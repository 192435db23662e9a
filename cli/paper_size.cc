#include "cli/paper_size.h"

#include <cstdint>
#include <string_view>
#include <utility>

#include "cli/decimal_option.h"
#include "core/decimal.h"
#include "core/errors.h"

namespace ttf::cli {
namespace {

using report::drawing::Sheet;

constexpr std::int64_t kMillion = 1'000'000;  // decimals are exact to a millionth
constexpr const char* kUsualFont = "8";       // pt, that of captions

double width_mm(const std::string& text) {
  constexpr std::pair<std::string_view, double> kUnits[] = {{"mm", 1}, {"cm", 10}, {"in", 25.4}, {"pt", 25.4 / 72}};
  for (const auto& [unit, mm] : kUnits) {
    if (!text.ends_with(unit)) continue;
    std::string_view digits = std::string_view(text).substr(0, text.size() - unit.size());
    if (digits.ends_with(' ')) digits.remove_suffix(1);
    const auto number = parse_scaled(digits, kMillion);
    if (!number) break;
    return static_cast<double>(*number) / kMillion * mm;
  }
  throw InputError(
      {"command line", 0, "--width", text, "must be a number of up to six decimals and mm, cm, in or pt, as in 88mm"});
}

double font_pt(std::string text) {
  if (text.ends_with("pt")) text.resize(text.size() - 2);
  const auto millionths = [](double pt) { return static_cast<std::int64_t>(pt * kMillion); };
  return static_cast<double>(decimal_option("--font-size", text, kMillion,
                                            {millionths(Sheet::kSmallest_pt), millionths(Sheet::kLargest_pt)}, " pt")) /
         kMillion;
}

}  // namespace

void add_paper_size(CLI::App& command, PaperSizeOptions& options) {
  command
      .add_option("--width", options.width,
                  "Width of the picture on paper, in mm, cm, in or pt: 88mm (default: as large as a screen needs)")
      ->type_name("LENGTH");
  command.add_option("--font-size", options.font_size, "Size of all text with --width, in pt (default: 8)")
      ->type_name("POINTS");
}

Sheet sheet_of(const PaperSizeOptions& options) {
  if (!options.width) {
    if (options.font_size)
      throw InputError({"command line", 0, "--font-size", *options.font_size, "goes with --width only"});
    return {};
  }
  return {width_mm(*options.width), font_pt(options.font_size.value_or(kUsualFont))};
}

}  // namespace ttf::cli
