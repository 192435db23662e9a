// Passes lists on, as the program's own gateway does: the task's k-th output is its k-th input. The definitions make
// libraries that go wrong: TEST_ABI is another version, TEST_REFUSAL the words of a refusal, and TEST_RUN what the tenth
// execution does.
#include <fenv.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <ttfusion_step.h>
#include <unistd.h>

#ifndef TEST_ABI
#define TEST_ABI TTF_STEP_ABI
#endif
#ifndef TEST_RUN
#define TEST_RUN
#endif

typedef struct {
  uint32_t signals[4];  // of each port
  int runs;
  double spare[64];  // values that are not the program's
} copy_step;

uint32_t ttf_step_abi(void) { return TEST_ABI; }

void* ttf_step_create(const ttf_step_task* task, char* error, size_t error_size) {
#ifdef TEST_REFUSAL
  snprintf(error, error_size, TEST_REFUSAL, task->inputs[0]->name, task->inputs[0]->pdu);
  return NULL;
#endif
  copy_step* self = calloc(1, sizeof *self);
  if (task->input_count != task->output_count || task->input_count > 4) {
    snprintf(error, error_size, "as many outputs as inputs are needed");
    free(self);
    return NULL;
  }
  for (uint32_t p = 0; p < task->input_count; ++p) self->signals[p] = task->inputs[p]->signal_count;
  return self;
}

#ifndef TEST_NO_RUN
// Takes half a second of the processor's time.
static void spin(void) {
  const clock_t begin = clock();
  fprintf(stderr, "it spins\n");
  while (clock() - begin < CLOCKS_PER_SEC / 2) {
  }
}

static int grow(volatile char* below) {
  volatile char here[4096];
  here[0] = below[0];
  return grow(here) + here[0];
}

// Sends a list with the rounding that it finds, and leaves another one.
static void turn_rounding(ttf_step_output* out) {
  out->written = 1;
  out->count = 1;
  out->values[0] = fegetround() == FE_TONEAREST ? 8 : 16;
  fesetround(FE_DOWNWARD);
}

static void quit(void) {
  void quick_exit(int);  // C11
  quick_exit(0);
}

static void block_all(void) {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, NULL);
}

int ttf_step_run(void* state, const ttf_step_context* context) {
  copy_step* self = state;
  for (uint32_t p = 0; p < context->input_count; ++p) {
    const ttf_step_input* in = context->inputs[p];
    ttf_step_output* out = context->outputs[p];
    if (!in->fresh) continue;
    out->written = 1;
    out->sequence = in->sequence;
    out->time_stamp_ns = in->time_stamp_ns;
    out->count = in->count;
    memcpy(out->values, in->values, sizeof(double) * in->count * self->signals[p]);
  }
  if (++self->runs == 10) {
    TEST_RUN;
  }
  (void)block_all;
  (void)grow;
  (void)quit;
  (void)spin;
  (void)turn_rounding;
  return 0;
}
#endif

void ttf_step_destroy(void* self) { free(self); }
