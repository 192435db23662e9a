// Reports the distance to the nearest object of the image, and warns below 15 m. docs/media/own_code.md builds it.
//
// Ports: any input with signals x and y -> any output whose signals are the distance and the warning.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <ttfusion_step.h>

static const double kWarning_m = 15.0;

typedef struct {
  uint32_t x, y, signals;  // places in an element of the input
  uint32_t sequence;       // of the next list
} distance_step;

uint32_t ttf_step_abi(void) { return TTF_STEP_ABI; }

// Returns the place of a signal, or the number of signals without one.
static uint32_t place_of(const ttf_step_port* port, const char* name) {
  uint32_t s = 0;
  while (s < port->signal_count && strcmp(port->signals[s]->name, name) != 0) ++s;
  return s;
}

void* ttf_step_create(const ttf_step_task* task, char* error, size_t error_size) {
  if (task->input_count != 1 || task->output_count != 1 || task->outputs[0]->signal_count != 2) {
    snprintf(error, error_size, "it reads one port, and writes one with two signals");
    return NULL;
  }
  const ttf_step_port* in = task->inputs[0];
  const distance_step ports = {place_of(in, "x"), place_of(in, "y"), in->signal_count, 0};
  if (ports.x == in->signal_count || ports.y == in->signal_count) {
    snprintf(error, error_size, "the elements of %s must have signals x and y", in->name);
    return NULL;
  }
  distance_step* self = malloc(sizeof *self);
  if (self != NULL) *self = ports;
  return self;
}

int ttf_step_run(void* state, const ttf_step_context* context) {
  distance_step* self = state;
  const ttf_step_input* image = context->inputs[0];
  ttf_step_output* nearest = context->outputs[0];
  if (!image->present) return 0;  // no list is sent
  for (uint32_t e = 0; e < image->count; ++e) {
    const double* object = image->values + (size_t)e * self->signals;
    const double distance_m = sqrt(object[self->x] * object[self->x] + object[self->y] * object[self->y]);
    if (e == 0 || distance_m < nearest->values[0]) nearest->values[0] = distance_m;
  }
  nearest->count = image->count > 0 ? 1 : 0;
  nearest->values[1] = nearest->count > 0 && nearest->values[0] < kWarning_m;
  nearest->sequence = self->sequence++;
  nearest->time_stamp_ns = image->time_stamp_ns;
  nearest->written = 1;
  return 0;
}

void ttf_step_destroy(void* self) { free(self); }
