#include "cli/supervision/control.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <stdexcept>

namespace ttf::cli::supervision {

std::optional<ControlLine> ControlLine::from_environment() {
  const char* const text = std::getenv(kControlVariable.data());
  if (text == nullptr) return std::nullopt;
  const std::string number = text;
  int fd = -1;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), fd);
  int type = 0;
  socklen_t size = sizeof type;
  if (error != std::errc{} || end != number.data() + number.size() || fd < 0 ||
      getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET)
    throw std::runtime_error(
        fmt::format("{} = {}: must be the descriptor of a supervisor's control line", kControlVariable, number));
  unsetenv(kControlVariable.data());
  fcntl(fd, F_SETFD, FD_CLOEXEC);
  return ControlLine(Descriptor(fd));
}

void ControlLine::send(std::string_view key, const nlohmann::json& value, bool wait) {
  const std::string message = nlohmann::json{{std::string(key), value}}.dump();
  ssize_t sent = 0;
  do sent = ::send(line_.get(), message.data(), message.size(), MSG_NOSIGNAL | (wait ? 0 : MSG_DONTWAIT));
  while (sent < 0 && errno == EINTR);
  // The wait for the start notices a lost supervisor.
  if (sent < 0) ++dropped_;
}

void ControlLine::ready() { send("ready", true, true); }
void ControlLine::health(const nlohmann::json& facts) { send("health", facts, false); }
void ControlLine::done(const nlohmann::json& facts) { send("done", facts, true); }

std::optional<nlohmann::json> ControlLine::wait_for_start() {
  std::string message(kLongestMessage, '\0');
  for (;;) {
    const ssize_t got = recv(line_.get(), message.data(), message.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return std::nullopt;
    const auto json =
        nlohmann::json::parse(std::string_view(message).substr(0, static_cast<std::size_t>(got)), nullptr, false);
    // An older node does not support every message of the supervisor.
    if (json.is_object() && json.contains("start")) return json["start"];
  }
}

}  // namespace ttf::cli::supervision
