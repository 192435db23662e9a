#include "nodes/foreign/port_descriptions.h"

#include <cstddef>
#include <cstdint>

namespace ttf::nodes::foreign {

PortDescriptions::PortDescriptions(const schedules::model::Cluster& cluster,
                                   const std::vector<schedules::model::PortBinding>& bindings)
    : described_(bindings.size()) {
  for (std::size_t p = 0; p < bindings.size(); ++p) {
    const schedules::model::PduLayout& layout = cluster.pdu(bindings[p].pdu);
    Described& one = described_[p];
    one.signals.reserve(layout.element.size());
    for (const schedules::model::Signal& signal : layout.element) {
      one.signals.push_back({.struct_size = sizeof(ttf_step_signal),
                             .name = signal.name.c_str(),
                             .unit = signal.unit.c_str(),
                             .low = signal.low,
                             .high = signal.high,
                             .resolution = signal.resolution});
      one.pointers.push_back(&one.signals.back());
    }
    one.port = {.struct_size = sizeof(ttf_step_port),
                .name = bindings[p].port.c_str(),
                .pdu = layout.name.c_str(),
                .capacity = static_cast<std::uint32_t>(layout.max_elements),
                .time_stamped = schedules::model::find_signal(layout.header, "timestamp") ? 1u : 0u,
                .signal_count = static_cast<std::uint32_t>(layout.element.size()),
                .signals = one.pointers.data()};
    pointers_.push_back(&one.port);
  }
}

}  // namespace ttf::nodes::foreign
