// The consequences of events: starts, barrier, ends, stop.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <exception>

#include "cli/supervision/control.h"
#include "cli/supervision/supervisor.h"
#include "cli/supervision/supervisor_node.h"
#include "core/counted.h"

namespace ttf::cli::supervision {
namespace {

std::string seconds_text(Duration duration) { return fmt::format("{:.4g} s", duration.seconds()); }

std::string_view signal_name(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGKILL";
}

}  // namespace

// An exception from the caller's code ends the launch in order.
void Supervisor::guarded(const std::function<void()>& hook) {
  try {
    hook();
  } catch (const std::exception& error) {
    fail(error.what(), 1);
  }
}

// An unwritable folder (a full disk) is reported once; the nodes continue.
void Supervisor::record(const std::function<void()>& write) {
  if (config_.folder == nullptr || folder_fails_) return;
  try {
    write();
  } catch (const std::exception& error) {
    folder_fails_ = true;
    say(fmt::format("{}; later output is not kept", error.what()));
  }
}

void Supervisor::say(std::string_view text) {
  const Speaker self{"launch", 0};
  const std::string shown = printable(text);
  screen_.line(prefixed(now(), self, name_width_, colour_, shown), prefixed(now(), self, name_width_, false, shown));
}

void Supervisor::show_lines(const Node& node, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    const std::string text = printable(line);
    screen_.line(prefixed(now(), node.speaker, name_width_, colour_, text),
                 prefixed(now(), node.speaker, name_width_, false, text));
  }
}

void Supervisor::start(Node& node) {
  node.lines = LineCutter();
  node.ready = node.done = false;
  node.began = now();
  health_.begin_process(node.index);
  try {
    node.child = std::make_unique<Child>(node.spec.command);
    record([&] { config_.folder->process_began(node.index, node.child->pid(), std::chrono::system_clock::now()); });
  } catch (const StartFailure& failure) {
    ended(node, failure.ending(), failure.what());
  } catch (const std::exception& error) {
    ended(node, {false, 1}, error.what());
  }
}

void Supervisor::ended(Node& node, const Ending& ending, const std::string& why) {
  const bool bad = failed(node, ending);
  node.ready = false;
  std::string what = why.empty() ? ending.text() : why;
  if (bad && ending.success()) what += ", before it was ready";
  record([&] {
    config_.folder->process_ended(node.index, ending, std::chrono::system_clock::now(),
                                  ending.without_result ? what : why);
  });
  health_.end_process(node.index, what, ending.success());
  if (terminal_ && status_at_) show_status();
  const bool comes_back =
      bad && node.spec.policy == Policy::kRestart && !stop_order_.begun() && restart_later(node, what);
  if (!comes_back) {
    node.failed = bad;
    say(fmt::format("{}: {}", node.spec.name, what));
  }
  if (hooks_.on_gone) guarded([&] { hooks_.on_gone(node.index, ending, comes_back); });
  if (node.failed && node.spec.policy != Policy::kOptional)
    fail(fmt::format("{}: {}", node.spec.name, what), ending.success() ? 1 : ending.exit_code());
  record([&] { config_.folder->write(); });
}

bool Supervisor::failed(const Node& node, const Ending& ending) const {
  if (!stop_order_.begun()) return !ending.success() || !node.ready;
  const int code = ending.exit_code();
  const bool killed = stop_order_.signal() == SIGKILL && ending.by_signal && ending.value == SIGKILL;
  return !ending.success() && code != 128 + SIGINT && code != 128 + SIGTERM && !killed;
}

bool Supervisor::restart_later(Node& node, std::string_view what) {
  const auto wait = node.backoff.next(now() - node.began);
  if (!wait) return false;
  node.restart_at = now() + *wait;
  const std::string next =
      fmt::format("restart {} of {} in {}", node.backoff.tried(), config_.restart.count, seconds_text(*wait));
  say(fmt::format("{}: {}; {}", node.spec.name, what, next));
  health_.set_process(node.index, next);
  return true;
}

void Supervisor::message(Node& node, const std::string& text) {
  const auto refuse = [&](std::string_view why) {
    say(fmt::format("{}: sent an invalid message, which is ignored: {}", node.spec.name, why));
  };
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return refuse(text.size() == kLongestMessage ? "too long" : "not a JSON object");
  if (const auto ready = json.find("ready"); ready != json.end() && *ready == true) became_ready(node);
  if (const auto health = json.find("health"); health != json.end()) {
    if (const auto wrong = health_.update(node.index, *health)) return refuse(*wrong);
    if (hooks_.on_health) guarded([&] { hooks_.on_health(node.index, *health); });
  }
  if (const auto done = json.find("done"); done != json.end()) {
    node.done = true;
    if (hooks_.on_done) guarded([&] { hooks_.on_done(node.index, *done); });
  }
}

void Supervisor::became_ready(Node& node) {
  if (node.ready) return;
  node.ready = true;
  health_.set_process(node.index, "ready");
  if (!started_ || stop_order_.begun()) return;
  guarded([&] { send_start(node, hooks_.on_late_ready ? hooks_.on_late_ready(node.index) : start_facts_); });
}

void Supervisor::send_start(Node& node, const nlohmann::json& facts) {
  // A node that has closed its line is probably just ending.
  const bool sent = node.child->send_control(nlohmann::json{{"start", facts}}.dump());
  health_.set_process(node.index, sent ? "running" : "not told to start");
}

std::vector<std::string> Supervisor::missing(bool optional_too) const {
  std::vector<std::string> names;
  for (const auto& node : nodes_)
    if (node->expected() && !node->ready && (optional_too || node->spec.policy != Policy::kOptional))
      names.push_back(node->spec.name);
  return names;
}

bool Supervisor::any_external() const {
  return std::ranges::any_of(nodes_, [](const auto& node) { return node->spec.external; });
}

void Supervisor::listen() {
  if (hooks_.listen) guarded(hooks_.listen);
  for (const auto& node : nodes_) {
    if (!node->spec.external || !hooks_.external) continue;
    ExternalHealth health;
    guarded([&] { health = hooks_.external(node->index); });
    if (health.sending != node->external.sending) say(fmt::format("{}: {}", node->spec.name, health.words));
    health_.set_external(node->index, health);
    node->external = std::move(health);
  }
}

std::vector<std::string> Supervisor::silent() const {
  std::vector<std::string> names;
  for (const auto& node : nodes_)
    if (node->spec.external && !node->external.received && node->spec.policy != Policy::kOptional)
      names.push_back(node->spec.name);
  return names;
}

void Supervisor::watch_silent() {
  if (!silence_at_ || now() < *silence_at_) return;
  silence_at_.reset();
  if (const std::vector<std::string> names = silent(); !names.empty())
    fail(fmt::format("nothing was heard within {} of {}", seconds_text(config_.silence_timeout), joined(names)), 1);
}

// A drive may be over before the timeout.
void Supervisor::end_silent() {
  if (!started_ || stop_order_.begun()) return;
  if (const std::vector<std::string> names = silent(); !names.empty())
    failure_ = Outcome{1, fmt::format("nothing was heard of {}", joined(names))};
}

void Supervisor::watch_barrier() {
  if (!barrier_at_ || !anybody_left()) return;
  const std::vector<std::string> all = missing(true);
  if (all.empty()) {
    say("all nodes are ready");
    return pass_barrier();
  }
  if (now() < *barrier_at_) return;
  const std::vector<std::string> needed = missing(false);
  if (!needed.empty())
    return fail(fmt::format("nodes are not ready within {}: {}", seconds_text(config_.ready_timeout), joined(needed)),
                1);
  say(fmt::format("optional nodes are not ready within {}: {}; the others start", seconds_text(config_.ready_timeout),
                  joined(all)));
  pass_barrier();
}

void Supervisor::pass_barrier() {
  started_ = true;
  barrier_at_.reset();
  if (any_external()) silence_at_ = now() + config_.silence_timeout;
  start_facts_ = nlohmann::json::object();
  guarded([&] {
    if (hooks_.on_all_ready) start_facts_ = hooks_.on_all_ready();
  });
  if (stop_order_.begun()) return;
  for (const auto& node : nodes_)
    if (node->child != nullptr && node->ready) send_start(*node, start_facts_);
  record([&] {
    config_.folder->state("running");
    config_.folder->write();
  });
}

void Supervisor::only_optional_left() {
  const bool others = std::ranges::any_of(
      nodes_, [](const auto& node) { return node->spec.policy != Policy::kOptional && node->expected(); });
  const bool any_other = std::ranges::any_of(
      nodes_, [](const auto& node) { return node->spec.policy != Policy::kOptional && !node->spec.external; });
  if (others || !any_other || stop_order_.begun()) return;
  if (!optional_at_) optional_at_ = now() + config_.optional_grace;
  if (now() < *optional_at_) return;
  optional_at_.reset();
  stop("only optional nodes are left");
}

void Supervisor::fail(std::string_view why, int exit_code) {
  if (!failure_) failure_ = Outcome{exit_code, std::string(why)};
  stop(why);
}

void Supervisor::request_stop(std::string_view why, int exit_code) { fail(why, exit_code); }

void Supervisor::stop(std::string_view why) {
  const auto signal = stop_order_.begin(now());
  if (!signal) return;
  barrier_at_.reset();
  optional_at_.reset();
  silence_at_.reset();
  for (const auto& node : nodes_)
    if (node->restart_at) {
      node->restart_at.reset();
      health_.set_process(node->index, "not restarted");
    }
  say(fmt::format("stopping: {}", why));
  record([&] {
    config_.folder->state("stopping");
    config_.folder->write();
  });
  signal_all(*signal);
}

void Supervisor::signal_all(int signal) {
  std::vector<std::string> there;
  for (const auto& node : nodes_)
    if (node->child != nullptr) {
      there.push_back(node->spec.name);
      node->child->signal_group(signal);
      node->child->signal_group(SIGCONT);  // a stopped process takes only SIGKILL otherwise
    }
  if (signal != SIGINT && !there.empty())
    say(fmt::format("still running, {} is sent: {}", signal_name(signal), joined(there)));
}

// Words before the barrier would only say that nodes start.
void Supervisor::show_status() {
  if (!terminal_ && !started_) return;
  const std::string words = hooks_.status ? hooks_.status() + ": " : "";
  if (terminal_)
    screen_.status(fitted(words + health_.up() + "\n" + health_.text(), terminal_size(config_.screen)));
  else
    say(words + health_.summary());
}

void Supervisor::show_health() {
  const std::string text = health_.text();
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    screen_.line(rest.substr(0, end), rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
}

}  // namespace ttf::cli::supervision
