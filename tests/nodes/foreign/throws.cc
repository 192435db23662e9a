// A step in C++ that throws where TEST_PLACE says: at its creation, in its first execution or at its end.
#include <ttfusion_step.h>
#include <stdexcept>

namespace {

enum Place { kCreate, kRun, kDestroy };
void maybe_throw(Place place) {
  if (place == TEST_PLACE) throw TEST_THROWN;
}
int state;

}  // namespace

uint32_t ttf_step_abi(void) { return TTF_STEP_ABI; }
void* ttf_step_create(const ttf_step_task*, char*, size_t) {
  maybe_throw(kCreate);
  return &state;
}
int ttf_step_run(void*, const ttf_step_context*) {
  maybe_throw(kRun);
  return 0;
}
void ttf_step_destroy(void*) { maybe_throw(kDestroy); }
