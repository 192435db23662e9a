// Starts a set of nodes as processes and watches them until the last one has ended. The processes' work is
// their own. The caller's Hooks give the facts for the start and react to ended processes.
//
//   start     all at once; each reports {"ready": true} on its control line (cli/supervision/control.h)
//   barrier   when all are ready, on_all_ready() makes the facts for all: {"start": ...}. After ready_timeout, missing
//             nodes are named; if only optional nodes are missing, the others start without them
//   running   output is merged line by line, messages go to the hooks, a node's policy judges its end
//   stop      on SIGINT, SIGTERM or SIGHUP, when a required node fails, or on request_stop(): SIGINT to all groups,
//             after a grace SIGTERM, then SIGKILL; SIGCONT goes with each, so that stopped processes end too. Another
//             SIGINT hurries
//   end       when no process is left: the health table, the manifest, the exit code
//
// An external node is a device that takes a node's place: no process of the launch. The hooks listen to it and
// report its state. It takes no part in the barrier, as it may have nothing to answer before the others have begun. A required one
// that was not received within silence_timeout, or by the end, fails the launch.
//
// A node fails by a code other than 0, by a signal, by ending before it was ready, or by owing its result. During a stop, neither
// the stop's signals nor their codes (130, 143) count. After the last other node has ended well, optional
// nodes have optional_grace to end, before they are stopped.
//
// The exit code is that of the first required node that failed (128 + n for signal n). Otherwise it is 1 if
// the barrier was not passed or a hook threw. It is 128 + n if signal n stopped the launch, unless a signal is its usual end.
// Else it is 0.
//
// One thread runs one poll loop that sleeps until an event. Words and manifest use the real clock.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/supervision/child.h"
#include "cli/supervision/health_table.h"
#include "cli/supervision/launch_folder.h"
#include "cli/supervision/lines.h"
#include "cli/supervision/policy.h"
#include "cli/supervision/screen.h"
#include "cli/supervision/signal_watch.h"
#include "core/time.h"

namespace ttf::cli::supervision {

struct NodeSpec {
  std::string name;
  Policy policy = Policy::kRequired;
  ChildCommand command;   // not of an external node
  bool external = false;  // its policy is not kRestart
};

struct SupervisorConfig {
  std::vector<NodeSpec> nodes;
  Duration ready_timeout = Duration::milliseconds(30'000);
  Duration silence_timeout = Duration::milliseconds(30'000);  // from the start on, for required external nodes
  Duration optional_grace = Duration::milliseconds(10'000);
  Backoff::Limits restart;
  StopOrder::Grace grace;
  // How often Hooks::listen is called, if it is set or there are external nodes.
  Duration listen_every = Duration::milliseconds(100);
  // How often the nodes' health is shown: in place on a terminal, else in words. 0: never.
  Duration status_every = Duration::milliseconds(1'000);
  Duration words_every = Duration::milliseconds(5'000);
  bool stop_is_success = false;    // a signal is the launch's usual end
  bool results_due = false;        // a node that has ended well has said so: {"done": ...}
  int screen = 2;                  // descriptor for the words; -1: without output
  LaunchFolder* folder = nullptr;  // outlives the supervisor; null: leaves no files
};

// Called from run(), on its thread; may use say() and request_stop(). `node` counts as in
// SupervisorConfig::nodes.
struct Hooks {
  // All are ready; returns the facts for all. Without it: {}.
  std::function<nlohmann::json()> on_all_ready;
  // A node became ready after the start: it was restarted, or is optional and late. Without it, the node gets
  // the common facts.
  std::function<nlohmann::json(std::size_t node)> on_late_ready;
  // A process has ended; its output has been passed on already.
  std::function<void(std::size_t node, const ttf::cli::supervision::Ending& ending, bool comes_back)> on_gone;
  std::function<void(std::size_t node, const nlohmann::json& facts)> on_health;
  std::function<void(std::size_t node, const nlohmann::json& facts)> on_done;
  // Takes in all that external nodes have sent, and all that nodes have sent each other beside the bus.
  std::function<void()> listen;
  // Returns how an external node is. Without it: as never received.
  std::function<ExternalHealth(std::size_t node)> external;
  // Returns the launch's progress in a few words. Without it: "".
  std::function<std::string()> status;
};

struct Outcome {
  int exit_code = 0;
  std::string why;  // in words; "" if all went well
};

class Supervisor {
 public:
  // Holds signals back from here on. Throws std::runtime_error if the system lacks a resource.
  Supervisor(SupervisorConfig config, Hooks hooks);
  ~Supervisor();

  // Starts all nodes and returns when the last has ended. Call once.
  Outcome run();

  void say(std::string_view text);
  // Stops all in order. Counts as a failure with this exit code, unless an earlier one exists.
  void request_stop(std::string_view why, int exit_code);
  const HealthTable& health() const { return health_; }

 private:
  struct Node;

  // supervisor.cc: the loop
  Duration now() const;
  bool anybody_left() const;
  void wait();
  void take_signals();
  void take_output(Node& node);
  void take_messages(Node& node);
  void take_ending(Node& node);
  void keep_time();
  std::optional<Duration> next_instant() const;
  void flush_screen();

  // supervisor_rules.cc: the consequences of events
  void start(Node& node);
  void ended(Node& node, const Ending& ending, const std::string& why);
  bool failed(const Node& node, const Ending& ending) const;
  bool restart_later(Node& node, std::string_view what);
  void message(Node& node, const std::string& text);
  void became_ready(Node& node);
  void send_start(Node& node, const nlohmann::json& facts);
  std::vector<std::string> missing(bool optional_too) const;
  void watch_barrier();
  void pass_barrier();
  void only_optional_left();
  bool any_external() const;
  bool listens() const { return any_external() || hooks_.listen; }
  void listen();
  std::vector<std::string> silent() const;
  void watch_silent();
  void end_silent();
  void stop(std::string_view why);
  void signal_all(int signal);
  void fail(std::string_view why, int exit_code);
  void show_lines(const Node& node, const std::vector<std::string>& lines);
  void show_health();
  void show_status();
  void guarded(const std::function<void()>& hook);
  void record(const std::function<void()>& write);

  SupervisorConfig config_;
  Hooks hooks_;
  SignalWatch signals_;
  Screen screen_;
  bool colour_ = false, terminal_ = false;
  Duration status_every_{};
  std::chrono::steady_clock::time_point began_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::size_t name_width_ = 0;
  HealthTable health_;

  bool started_ = false;  // the barrier has been passed
  nlohmann::json start_facts_;
  StopOrder stop_order_;
  std::optional<Duration> barrier_at_, optional_at_, status_at_, listen_at_, silence_at_;
  std::optional<Outcome> failure_, interruption_;
  bool folder_fails_ = false;
};

}  // namespace ttf::cli::supervision
