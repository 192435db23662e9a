#include "nodes/host/signals.h"

#include "core/check.h"

namespace ttf::nodes::host {

const schedules::model::PortBinding& binding_of(const std::vector<schedules::model::PortBinding>& bindings,
                                                std::string_view port) {
  const auto found = std::find_if(bindings.begin(), bindings.end(),
                                  [&](const schedules::model::PortBinding& binding) { return binding.port == port; });
  TTF_CHECK(found != bindings.end(), "no port {}", port);
  return *found;
}

}  // namespace ttf::nodes::host
