#include "nodes/host/signals.h"

#include "core/check.h"

namespace ttf::nodes {

const schedules::PortBinding& binding_of(const std::vector<schedules::PortBinding>& bindings, std::string_view port) {
  const auto found = std::find_if(bindings.begin(), bindings.end(),
                                  [&](const schedules::PortBinding& binding) { return binding.port == port; });
  TTF_CHECK(found != bindings.end(), "no port {}", port);
  return *found;
}

}  // namespace ttf::nodes
