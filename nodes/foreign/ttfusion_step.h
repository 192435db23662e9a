/* A step of one's own: the four functions of a shared library that a cluster file names as the step of a task.
 *
 *   step: distance.so            in the cluster file; loaded only from the folder that the command line allows:
 *   ttfusion run my_scenario.yaml --steps FOLDER
 *
 * C99, and C++ as well. docs/media/own_code.md has an example and the command that builds it.
 *
 * A step is pure: its outputs are a function of its inputs, its instants and its own state. It asks no clock, reads no
 * file and draws no numbers of its own. Then a drive in virtual time has the same records each time.
 *
 * Ports. The task's `reads` are the inputs, its `writes` the outputs, in the file's order. A port has a list: elements of
 * some signals each. Values are physical, in the signal's unit, and lie row by row: signal s of element e is
 * values[e * signal_count + s].
 *
 * Ownership. The library owns `self`, and the program owns everything else. No pointer but `self` outlives the call that
 * it was given to. Only the names, ports and signals of a task stay until ttf_step_destroy(). The program allocates all
 * buffers before the first run.
 *
 * Threads. The calls for one `self` never overlap. Calls for different ones may run at once, in an experiment with
 * several workers: a library has no global state, or guards it. Every call gets the default floating-point environment;
 * whatever a call changes there is undone.
 *
 * Failures. A call that does not return within --step-limit ends the process. So do a crash and exit(). A C++ exception
 * that leaves a call is a failure of the step. A signal ticks while a call lasts, a tenth of --step-limit apart: system
 * calls such as nanosleep() may return early with EINTR.
 *
 * Versions. ttf_step_abi() says for which version the library was built; the program refuses others. Within a version,
 * structs only grow at their ends, and struct_size says how much of one this program has.
 */
#ifndef TTFUSION_STEP_H
#define TTFUSION_STEP_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TTF_STEP_ABI 1u

#if defined(__GNUC__)
#define TTF_STEP_EXPORT __attribute__((visibility("default")))
#else
#define TTF_STEP_EXPORT
#endif

/* One signal of an element. On the bus its values are low + n * resolution, up to high. */
typedef struct ttf_step_signal {
  size_t struct_size;
  const char* name;
  const char* unit; /* "" for a number without one */
  double low, high, resolution;
} ttf_step_signal;

/* One port. */
typedef struct ttf_step_port {
  size_t struct_size;
  const char* name;      /* the port's name in the cluster file */
  const char* pdu;       /* the name of the PDU that it is bound to */
  uint32_t capacity;     /* the most elements of a list */
  uint32_t time_stamped; /* 1 if its lists carry a time stamp, else 0 */
  uint32_t signal_count;
  const ttf_step_signal* const* signals;
} ttf_step_port;

/* The task, for ttf_step_create(). */
typedef struct ttf_step_task {
  size_t struct_size;
  const char* node;
  const char* name;
  int64_t cycle_ns; /* the communication cycle on the node's clock */
  uint32_t input_count;
  const ttf_step_port* const* inputs;
  uint32_t output_count;
  const ttf_step_port* const* outputs;
} ttf_step_task;

/* The newest complete list at an input, as the task found it at its start. */
typedef struct ttf_step_input {
  size_t struct_size;
  uint32_t present;      /* 0 until a list has ever arrived; then all below is meaningless */
  uint32_t fresh;        /* 1 if the task sees this list for the first time */
  uint32_t sequence;     /* the sender's number of the list */
  uint32_t time_known;   /* 1 if the list has a time stamp that this node can place on its clock */
  int64_t time_stamp_ns; /* the list's instant, on the node's clock: of measurement, or as its sender means it */
  uint32_t count;        /* elements in the list */
  const double* values;  /* count * signal_count of them */
} ttf_step_input;

/* A list to send. Its values become visible to others when the task ends, by its execution time in the cluster file. */
typedef struct ttf_step_output {
  size_t struct_size;
  uint32_t written;      /* set it to 1 to send the list; it is 0 at the begin of each call */
  uint32_t sequence;     /* the list's number, which counts up; the bus carries its low bits */
  int64_t time_stamp_ns; /* the list's instant on the node's clock, for a port with time stamps */
  uint32_t count;        /* its elements, 0 to capacity */
  double* values;        /* room for capacity * signal_count; zeros at the begin of each call */
} ttf_step_output;

/* One execution of the task. */
typedef struct ttf_step_context {
  size_t struct_size;
  int64_t start_ns;     /* the task's start, on the cluster's global time as this node has it */
  uint32_t global_time; /* 0 while the node has no global time: then start_ns is of its own clock */
  uint32_t activation;  /* earlier executions of the task */
  uint32_t input_count;
  const ttf_step_input* const* inputs;
  uint32_t output_count;
  ttf_step_output* const* outputs;
} ttf_step_context;

/* Returns TTF_STEP_ABI as the library was built with it. */
TTF_STEP_EXPORT uint32_t ttf_step_abi(void);

/* Returns the state of a new step for this task, any pointer but NULL. NULL refuses the task, for instance for its ports:
 * `error` then has the words for the user, at most error_size bytes with the terminating zero. A task may be created and
 * destroyed without any run, to check a cluster. */
TTF_STEP_EXPORT void* ttf_step_create(const ttf_step_task* task, char* error, size_t error_size);

/* Runs the step once. Returns 0; any other value is a failure of the step, which ends the node.
 * A value that is not finite, a count above the capacity and a time stamp beyond 2^62 ns end the node, too. A value outside
 * its signal's range is sent as the nearest end of it, and counted. */
TTF_STEP_EXPORT int ttf_step_run(void* self, const ttf_step_context* context);

/* Frees the state. */
TTF_STEP_EXPORT void ttf_step_destroy(void* self);

#ifdef __cplusplus
}
#endif

#endif /* TTFUSION_STEP_H */
