// Any two texts, a line each, as the window of a diagram. Laws: only InputError; an accepted window has a length, does not
// begin before the drive, and has the numbers of its texts.
#include <cmath>
#include <cstdlib>
#include <string>

#include "cli/time_window.h"
#include "core/check.h"
#include "tests/fuzz/harness.h"

namespace {

void check_number(const std::optional<std::string>& text, const std::optional<ttf::TrueTime>& time) {
  TTF_CHECK(text.has_value() == time.has_value(), "{}", text.value_or("absent"));
  if (!text) return;
  const double said = std::strtod(text->c_str(), nullptr), kept = static_cast<double>(time->ns) * 1e-9;
  TTF_CHECK(std::abs(kept - said) <= 1e-15 * std::abs(said), "{} is {} s", *text, kept);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf;
  const std::string text(reinterpret_cast<const char*>(data), size);
  cli::TimeWindowOptions options;
  const std::size_t end = text.find('\n');
  if (end != 0) options.from = text.substr(0, end);
  if (end != std::string::npos) options.to = text.substr(end + 1);
  fuzz::accepted("command line", [&] {
    const cli::TimeWindow window = cli::time_window(options);
    TTF_CHECK(window.begin() >= TrueTime{} && (!window.to || *window.to > window.begin()), "{}", text);
    check_number(options.from, window.from);
    check_number(options.to, window.to);
  });
  return 0;
}
