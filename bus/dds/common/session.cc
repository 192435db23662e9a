#include "bus/dds/common/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "bus/dds/common/configuration.h"
#include "bus/dds/common/said.h"
#include "core/errors.h"

namespace ttf::bus::dds::common {
namespace {

constexpr std::size_t kMaxNameLength = 64;

bool name_is_valid(const std::string& name) {
  const auto valid = [](unsigned char c) {
    return c < 128 && (std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.');
  };
  return !name.empty() && name.size() <= kMaxNameLength && std::all_of(name.begin(), name.end(), valid);
}

std::string named(const std::vector<NodeId>& nodes) {
  std::string text;
  for (const NodeId node : nodes) {
    if (!text.empty()) text += ", ";
    text += node == kSupervisor ? "the supervisor" : fmt::format("node {}", index_of(node));
  }
  return text;
}

std::string sentence(const Session& session, std::chrono::milliseconds waited, const std::vector<NodeId>& absent,
                     const std::vector<NodeId>& deaf) {
  std::string text = fmt::format("session {} on DDS domain {}: not ready after {:.1f} s", session.name, session.domain,
                                 static_cast<double>(waited.count()) / 1000);
  if (!absent.empty()) text += "; not heard: " + named(absent);
  if (!deaf.empty()) text += "; not hearing all others: " + named(deaf);
  return text;
}

}  // namespace

const Session& validate(const Session& session) {
  Findings findings;
  if (session.domain > kMaxDomain)
    findings.add({"DDS", 0, "domain", std::to_string(session.domain), fmt::format("must be 0..{}", kMaxDomain)});
  if (!name_is_valid(session.name))
    findings.add({"DDS", 0, "session", session.name,
                  fmt::format("must be 1 to {} letters, digits, '_', '-' or '.'", kMaxNameLength)});
  const std::set<NodeId> members(session.members.begin(), session.members.end());
  if (members.empty() || members.size() != session.members.size() || members.contains(kSupervisor))
    findings.add({"DDS", 0, "members", named(session.members), "must be one or more nodes, each once"});
  if (session.lease < std::chrono::milliseconds{100} || session.lease > std::chrono::hours{1})
    findings.add({"DDS", 0, "lease", std::to_string(session.lease.count()), "must be 100..3600000 ms"});
  findings.throw_if_any();
  return session;
}

NotReady::NotReady(const Session& session, std::chrono::milliseconds waited, std::vector<NodeId> absent,
                   std::vector<NodeId> deaf)
    : std::runtime_error(sentence(session, waited, absent, deaf)), absent_(std::move(absent)), deaf_(std::move(deaf)) {}

}  // namespace ttf::bus::dds::common
