#include "cli/live_media/dds_configuration.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/session.h"
#include "cli/supervision/descriptor.h"
#include "core/errors.h"

namespace ttf::cli::live_media {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("the DDS configuration cannot be tested: {}: {}", what, system_message(errno)));
}

// Tries to join and exits: code 0 on success.
[[noreturn]] void try_to_join(int words) {
  dup2(words, STDERR_FILENO);
  try {
    const bus::dds::common::Participant there(0, std::chrono::seconds(10));
  } catch (const std::exception&) {
    _exit(1);
  }
  _exit(0);
}

// Strips the prefix of "1795322955.674948 [0]   ttfusion: can't open configuration file x". The first line
// has the cause; later lines add no help.
std::string words_of(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  const std::size_t program = text.find("]");
  const std::size_t colon = text.find(": ", program == std::string::npos ? 0 : program);
  if (program != std::string::npos && colon != std::string::npos) text.erase(0, colon + 2);
  return text;
}

}  // namespace

void check_session_name(const std::string& name) {
  bus::dds::common::Session session;
  session.name = name;
  session.members = {NodeId{0}};
  try {
    bus::dds::common::validate(session);
  } catch (const InputError& error) {
    throw InputError({"command line", 0, "--session", name, error.findings().front().expected});
  }
}

void check_dds_configuration() {
  const char* const uri = std::getenv("CYCLONEDDS_URI");
  if (uri == nullptr) return;
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) fail("pipe");
  supervision::Descriptor reading(ends[0]), words(ends[1]);
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) try_to_join(words.get());
  words.close();
  std::string said;
  std::array<char, 4096> bytes{};
  for (ssize_t size = 0; (size = read(reading.get(), bytes.data(), bytes.size())) != 0;) {
    if (size < 0 && errno != EINTR) fail("read");
    if (size > 0 && said.size() < bytes.size()) said.append(bytes.data(), static_cast<std::size_t>(size));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail("waitpid");
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw InputError({"environment", 0, "CYCLONEDDS_URI", uri,
                    fmt::format("must be a configuration that Cyclone DDS accepts on this machine, such as "
                                "bus/dds/loopback.xml; Cyclone DDS says: {}",
                                said.empty() ? "nothing" : words_of(std::move(said)))});
}

}  // namespace ttf::cli::live_media
