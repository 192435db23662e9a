#include "bus/dds/common/participant.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <mutex>
#include <stdexcept>

#include "bus/dds/common/configuration.h"

namespace ttf::bus::dds::common {
namespace {

// Cyclone DDS has one domain of a number per process, configured once; its last participant closes it.
struct OpenDomains {
  struct Domain {
    Handle handle = 0;
    int users = 0;
  };
  std::mutex mutex;
  std::map<std::uint32_t, Domain> domains;  // guarded by mutex
};

OpenDomains& open_domains() {
  static OpenDomains open;
  return open;
}

void open_domain(std::uint32_t number, std::chrono::milliseconds lease) {
  OpenDomains& open = open_domains();
  const std::scoped_lock lock(open.mutex);
  auto& domain = open.domains[number];
  if (domain.users == 0)
    domain.handle = checked(dds_create_domain(number, loopback_configuration(lease).c_str()),
                            fmt::format("cannot set up domain {} on the loopback interface", number));
  ++domain.users;
}

void close_domain(std::uint32_t number) {
  OpenDomains& open = open_domains();
  const std::scoped_lock lock(open.mutex);
  auto& domain = open.domains[number];
  if (--domain.users == 0) dds_delete(domain.handle);
}

}  // namespace

std::int32_t checked(std::int32_t result, std::string_view what) {
  if (result < 0) throw std::runtime_error(fmt::format("DDS: {}: {}", what, dds_strretcode(-result)));
  return result;
}

Participant::Participant(std::uint32_t domain, std::chrono::milliseconds lease)
    : domain_(domain), configured_(std::getenv("CYCLONEDDS_URI") == nullptr) {
  if (configured_) open_domain(domain_, lease);
  handle_ = dds_create_participant(domain_, nullptr, nullptr);
  if (handle_ >= 0) return;
  if (configured_) close_domain(domain_);
  checked(handle_, fmt::format("cannot join domain {}; on one machine there is room for {} participants", domain_,
                               kMaxParticipants));
}

Participant::~Participant() {
  dds_delete(handle_);
  if (configured_) close_domain(domain_);
}

}  // namespace ttf::bus::dds::common
