#include "cli/supervision/supervisor.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <climits>

#include "cli/supervision/supervisor_node.h"

namespace ttf::cli::supervision {
namespace {

constexpr std::size_t kReadAtOnce = 65'536;     // bytes of one child, before the others' turn
constexpr std::size_t kMessagesAtOnce = 1'000;  // more than a socket holds
constexpr std::size_t kReadAtEnd = 16 << 20;    // bytes; a process outside the group could print for ever

std::vector<std::string> names_of(const std::vector<NodeSpec>& nodes) {
  std::vector<std::string> names;
  for (const NodeSpec& node : nodes) names.push_back(node.name);
  return names;
}

// Rounds up: an early wake-up would only poll again.
int milliseconds_until(std::optional<Duration> instant, Duration now) {
  if (!instant) return -1;
  const std::int64_t ms = (std::max<std::int64_t>((*instant - now).ns, 0) + 999'999) / 1'000'000;
  return static_cast<int>(std::min<std::int64_t>(ms, INT_MAX));
}

}  // namespace

Supervisor::Supervisor(SupervisorConfig config, Hooks hooks)
    : config_(std::move(config)), hooks_(std::move(hooks)),
      screen_(config_.screen, config_.folder != nullptr ? config_.folder->open_launch_log() : Descriptor()),
      colour_(config_.screen >= 0 && colour_wanted(config_.screen)),
      terminal_(config_.screen >= 0 && moves_cursor(config_.screen)), began_(std::chrono::steady_clock::now()),
      name_width_(shown_width("launch")), health_(names_of(config_.nodes)), stop_order_(config_.grace) {
  for (NodeSpec& spec : config_.nodes) {
    nodes_.push_back(std::make_unique<Node>(nodes_.size(), std::move(spec), config_.restart));
    name_width_ = std::max(name_width_, shown_width(nodes_.back()->speaker.name));
    if (config_.folder != nullptr)
      config_.folder->add_node({nodes_.back()->spec.name, std::string(name_of(nodes_.back()->spec.policy)),
                                nodes_.back()->spec.command.arguments, nodes_.back()->spec.external});
  }
}

Supervisor::~Supervisor() = default;

Duration Supervisor::now() const {
  return Duration::nanoseconds(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - began_).count());
}

bool Supervisor::anybody_left() const {
  return std::ranges::any_of(nodes_, [](const auto& node) { return node->expected(); });
}

Outcome Supervisor::run() {
  barrier_at_ = now() + config_.ready_timeout;
  status_every_ = terminal_ ? config_.status_every : config_.words_every;
  if (status_every_ > Duration{}) status_at_ = now() + status_every_;
  if (listens()) listen_at_ = now() + config_.listen_every;
  for (const auto& node : nodes_)
    if (node->spec.external)
      health_.set_external(node->index, {});
    else if (stop_order_.begun())
      health_.set_process(node->index, "not started");
    else
      start(*node);
  record([&] { config_.folder->write(); });
  while (anybody_left()) {
    wait();
    take_signals();
    for (const auto& node : nodes_)
      if (node->child != nullptr) {
        take_output(*node);
        take_messages(*node);
        take_ending(*node);
      }
    keep_time();
  }
  if (listens()) listen();
  end_silent();
  screen_.status("");
  show_health();
  const Outcome outcome = failure_ ? *failure_ : interruption_ ? *interruption_ : Outcome{};
  if (!outcome.why.empty()) say("ended: " + outcome.why);
  record([&] {
    config_.folder->set("health", health_.json());
    config_.folder->finish(outcome.exit_code, outcome.why, std::chrono::system_clock::now());
  });
  flush_screen();
  return outcome;
}

void Supervisor::wait() {
  std::vector<pollfd> watched{{signals_.fd(), POLLIN, 0}, {screen_.fd_to_write(), POLLOUT, 0}};
  for (const auto& node : nodes_)
    if (node->child != nullptr)
      for (const int fd : {node->child->process_fd(), node->child->output_fd(), node->child->control_fd()})
        watched.push_back({fd, POLLIN, 0});
  poll(watched.data(), watched.size(), milliseconds_until(next_instant(), now()));
  if (watched[1].revents != 0) screen_.write_some();
}

void Supervisor::take_signals() {
  while (const auto signal = signals_.next()) {
    if (stop_order_.begun()) {
      // A terminal's hang-up may come with other signals; only a repeated request means impatience.
      if (*signal != SIGHUP)
        if (const auto next = stop_order_.hurry(now())) signal_all(*next);
      continue;
    }
    const std::string why = *signal == SIGINT    ? "interrupted (SIGINT)"
                            : *signal == SIGTERM ? "SIGTERM"
                                                 : "the terminal was closed (SIGHUP)";
    interruption_ = Outcome{config_.stop_is_success ? 0 : 128 + *signal, why};
    stop(why);
  }
}

void Supervisor::take_output(Node& node) {
  const std::string bytes = node.child->read_output(kReadAtOnce);
  if (bytes.empty()) return;
  record([&] { config_.folder->output(node.index, bytes); });
  show_lines(node, node.lines.feed(bytes));
}

void Supervisor::take_messages(Node& node) {
  for (std::size_t taken = 0; taken < kMessagesAtOnce; ++taken) {
    const auto text = node.child->read_control();
    if (!text) return;
    message(node, *text);
  }
}

void Supervisor::take_ending(Node& node) {
  auto ending = node.child->reap();
  if (!ending) return;
  // The process' earlier output comes first.
  for (std::size_t taken = 0; taken < kReadAtEnd && node.child->output_fd() >= 0; taken += kReadAtOnce) {
    pollfd there{node.child->output_fd(), POLLIN, 0};
    if (poll(&there, 1, 0) <= 0) break;
    take_output(node);
  }
  take_messages(node);
  ending->without_result = config_.results_due && ending->success() && node.ready && !node.done;
  show_lines(node, node.lines.finish());
  node.child.reset();
  ended(node, *ending, "");
}

void Supervisor::keep_time() {
  for (const auto& node : nodes_)
    if (node->restart_at && now() >= *node->restart_at) {
      node->restart_at.reset();
      start(*node);
      record([&] { config_.folder->write(); });
    }
  watch_barrier();
  only_optional_left();
  if (listen_at_ && now() >= *listen_at_) {
    listen();
    listen_at_ = now() + config_.listen_every;
  }
  watch_silent();
  if (const auto signal = stop_order_.due(now())) signal_all(*signal);
  if (status_at_ && now() >= *status_at_) {
    show_status();
    status_at_ = now() + status_every_;
  }
}

std::optional<Duration> Supervisor::next_instant() const {
  std::optional<Duration> first;
  const auto take = [&](const std::optional<Duration>& instant) {
    if (instant && (!first || *instant < *first)) first = instant;
  };
  for (const auto& node : nodes_) take(node->restart_at);
  take(barrier_at_);
  take(optional_at_);
  take(stop_order_.next_instant());
  take(status_at_);
  take(listen_at_);
  take(silence_at_);
  return first;
}

void Supervisor::flush_screen() {
  // Waits for the output as long as needed, unless a signal arrives.
  while (screen_.fd_to_write() >= 0) {
    pollfd watched[] = {{screen_.fd_to_write(), POLLOUT, 0}, {signals_.fd(), POLLIN, 0}};
    poll(watched, 2, -1);
    if (watched[1].revents != 0) return;
    if (watched[0].revents != 0) screen_.write_some();
  }
}

}  // namespace ttf::cli::supervision
