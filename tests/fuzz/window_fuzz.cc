// Any two numbers as the window of a diagram. Laws: only InputError, and a window has a length and is within the run.
#include <cmath>

#include "cli/time_window.h"
#include "core/check.h"
#include "tests/fuzz/harness.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf;
  fuzz::Source source(data, size);
  const auto from = source.take<double>(), to = source.take<double>();
  fuzz::accepted("command line", [&] {
    const cli::TimeWindow window = cli::time_window(from, to);
    TTF_CHECK(window.from >= TrueTime{} && (!window.to || *window.to > window.from), "{}..{} s", from, to);
    const double shown = static_cast<double>(window.from.ns) * 1e-9;
    TTF_CHECK(std::abs(shown - std::max(from, 0.0)) <= 1e-9 + 1e-15 * std::abs(from), "{} s is {}", from, shown);
  });
  return 0;
}
