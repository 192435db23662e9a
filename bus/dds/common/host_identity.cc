#include "bus/dds/common/host_identity.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

namespace ttf::bus::dds::common {
namespace {

// FNV-1a.
std::uint64_t identity_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char letter : text) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return std::max<std::uint64_t>(hash, 1);
}

}  // namespace

std::uint64_t host_identity() {
  std::string text;
  std::ifstream boot("/proc/sys/kernel/random/boot_id");
  if (!std::getline(boot, text) || text.empty()) return 0;
  for (const char* space : {"/proc/self/ns/net", "/proc/self/ns/time"}) {
    struct stat status {};
    // A kernel without such namespaces has one clock and one network for all.
    text += '/' + (stat(space, &status) == 0 ? std::to_string(status.st_ino) : std::string("one"));
  }
  return identity_of(text);
}

}  // namespace ttf::bus::dds::common
