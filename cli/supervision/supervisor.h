// Starts a set of nodes as processes, and looks after them until the last one has ended. What the processes do is their
// own business; what is said to them at the start, and what follows for others when one is gone, is the caller's
// (Hooks).
//
//   start     all at once; each says {"ready": true} on its control line (cli/supervision/control.h)
//   barrier   when everybody is ready, on_all_ready() makes what all are told: {"start": ...}. Who is missing after
//             ready_timeout is named; if only optional nodes are, the others start without them
//   running   output is merged line by line, messages go to the hooks, ends are judged by the node's policy
//   stop      on SIGINT, SIGTERM or SIGHUP, when a required node fails, or on request_stop(): SIGINT to all groups,
//             after a grace SIGTERM, then SIGKILL; SIGCONT goes with each, so that stopped processes end too. Another
//             SIGINT hurries
//   end       when no process is left: the health table, the manifest, the exit code
//
// A node fails by a code other than 0, by a signal, or by ending before it was ready; while all are being stopped,
// neither the signals of the stop nor their codes (130, 143) count. When all nodes but optional ones have ended well,
// those have optional_grace to end too, before they are stopped.
//
// Exit code: of the first required node that failed (128 + n by signal n); 1 where the barrier was not passed, or a
// hook threw; else 128 + n where signal n stopped it all; else 0.
//
// One thread, one poll loop that sleeps until something happens. Words and manifest are the real clock's.
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
  ChildCommand command;
};

struct SupervisorConfig {
  std::vector<NodeSpec> nodes;
  Duration ready_timeout = Duration::milliseconds(30'000);
  Duration optional_grace = Duration::milliseconds(10'000);
  Backoff::Limits restart;
  StopOrder::Grace grace;
  Duration health_every = Duration::milliseconds(10'000);  // while it runs, on a terminal only; 0: never
  int screen = 2;                                          // where words go; -1: nowhere
  LaunchFolder* folder = nullptr;                          // outlives the supervisor; nothing: leaves no files
};

// Called from run(), on its thread; they may use say() and request_stop(). `node` counts as in SupervisorConfig::nodes.
struct Hooks {
  // Everybody is ready: what all are told. Without it: {}.
  std::function<nlohmann::json()> on_all_ready;
  // One that became ready after the start, because it was restarted or is late and optional. Without it: what all were
  // told.
  std::function<nlohmann::json(std::size_t node)> on_late_ready;
  // A process has ended, and all that it said has been passed on before.
  std::function<void(std::size_t node, const ttf::cli::supervision::Ending& ending, bool comes_back)> on_gone;
  std::function<void(std::size_t node, const nlohmann::json& facts)> on_health;
  std::function<void(std::size_t node, const nlohmann::json& facts)> on_done;
};

struct Outcome {
  int exit_code = 0;
  std::string why;  // in words, "" where all went well
};

class Supervisor {
 public:
  // Signals are held back from here on. Throws std::runtime_error where the system lacks what is needed.
  Supervisor(SupervisorConfig config, Hooks hooks);
  ~Supervisor();

  // Starts everybody, returns when nobody is left. Once.
  Outcome run();

  void say(std::string_view text);
  // All are stopped in order; counts as a failure with this exit code, unless there was one before.
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

  // supervisor_rules.cc: what follows
  void start(Node& node);
  void ended(Node& node, const Ending& ending, const std::string& why);
  bool failed(const Node& node, const Ending& ending) const;
  bool restart_later(Node& node, std::string_view what);
  void message(Node& node, const std::string& text);
  void became_ready(Node& node);
  void tell_start(Node& node, const nlohmann::json& facts);
  std::vector<std::string> missing(bool optional_too) const;
  void watch_barrier();
  void pass_barrier();
  void only_optional_left();
  void stop(std::string_view why);
  void signal_all(int signal);
  void fail(std::string_view why, int exit_code);
  void show_lines(const Node& node, const std::vector<std::string>& lines);
  void show_health();
  void guarded(const std::function<void()>& hook);
  void record(const std::function<void()>& write);

  SupervisorConfig config_;
  Hooks hooks_;
  SignalWatch signals_;
  Screen screen_;
  bool colour_ = false, terminal_ = false;
  std::chrono::steady_clock::time_point began_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::size_t name_width_ = 0;
  HealthTable health_;

  bool started_ = false;  // the barrier is behind us
  nlohmann::json start_facts_;
  StopOrder stop_order_;
  std::optional<Duration> barrier_at_, optional_at_, health_at_;
  std::optional<Outcome> failure_, interruption_;
  bool folder_fails_ = false;
};

}  // namespace ttf::cli::supervision
