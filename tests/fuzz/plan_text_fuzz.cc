// Any text as a plan.
#include "tests/fuzz/harness.h"
#include "tests/fuzz/plan_laws.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ttf::fuzz::check_plan(ttf::fuzz::text_of(data, size));
  return 0;
}
