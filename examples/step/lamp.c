// Prints a line when the warning of distance.c comes or goes, as a lamp on the dashboard would show it.
#include <stdio.h>
#include <stdlib.h>
#include <ttfusion_step.h>

typedef struct {
  int on;
} lamp_step;

uint32_t ttf_step_abi(void) { return TTF_STEP_ABI; }

void* ttf_step_create(const ttf_step_task* task, char* error, size_t error_size) {
  if (task->input_count == 1 && task->inputs[0]->signal_count == 2) return calloc(1, sizeof(lamp_step));
  snprintf(error, error_size, "it reads one port with two signals");
  return NULL;
}

int ttf_step_run(void* state, const ttf_step_context* context) {
  lamp_step* self = state;
  const ttf_step_input* nearest = context->inputs[0];
  const int on = nearest->present && nearest->count > 0 && nearest->values[1] > 0.5;
  if (on != self->on)
    fprintf(stderr, "%.3f s: lamp %s, nearest object at %.2f m\n", (double)context->start_ns * 1e-9, on ? "on" : "off",
            nearest->values[0]);
  self->on = on;
  return 0;
}

void ttf_step_destroy(void* self) { free(self); }
