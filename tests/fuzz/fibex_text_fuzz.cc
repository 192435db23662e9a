// Any text as a FIBEX file.
#include "tests/fuzz/fibex_laws.h"
#include "tests/fuzz/harness.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ttf::fuzz::check_fibex(ttf::fuzz::text_of(data, size));
  return 0;
}
