// Any text as a scenario file. Law: a file is one document; text behind its end is refused, never skipped.
#include "core/check.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/scenario_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf::fuzz;
  const std::string text = ttf::fuzz::text_of(data, size);
  if (ttf::fuzz::check_scenario(text))
    TTF_CHECK(!ttf::fuzz::check_scenario(text + "\n...\n---\nunknown: 1\n"), "a second document is passed over");
  return 0;
}
