// Reads and writes the lists of sensors: an element's values in the order of the signals that the code binds.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "nodes/host/signals.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::sensors {

// Return the layout of the list that the task reads or writes at a port.
inline const schedules::model::PduLayout& layout_read(const schedules::model::Cluster& cluster,
                                                      const schedules::model::Task& task, std::string_view port) {
  return cluster.pdu(nodes::host::binding_of(task.reads, port).pdu);
}
inline const schedules::model::PduLayout& layout_written(const schedules::model::Cluster& cluster,
                                                         const schedules::model::Task& task, std::string_view port) {
  return cluster.pdu(nodes::host::binding_of(task.writes, port).pdu);
}

// Returns a port's place among the task's, if the task has it.
inline std::optional<std::size_t> place_of_port(const std::vector<schedules::model::PortBinding>& bindings,
                                                std::string_view port) {
  for (std::size_t p = 0; p < bindings.size(); ++p)
    if (bindings[p].port == port) return p;
  return std::nullopt;
}

// Calls `take` with the values of each element of a list, in the order of `signals`.
template <std::size_t kCount, class Take>
void read_list(const nodes::host::Input& input, const std::array<std::size_t, kCount>& signals, Take take) {
  const int count = nodes::host::element_count(*input.layout, *input.list);
  for (int i = 0; i < count; ++i) {
    std::array<double, kCount> values;
    for (std::size_t s = 0; s < kCount; ++s)
      values[s] = nodes::host::element_value(*input.layout, *input.list, i, signals[s]);
    take(values);
  }
}

// Writes a whole list. `values_of` returns an element's values, an array in the order of `signals`. `signals` may be
// shorter than that array; the rest is not written.
template <class Element, class Signals, class ValuesOf>
void write_list(nodes::host::Output& out, std::uint32_t sequence, GlobalTime at, const Signals& signals,
                const std::vector<Element>& elements, ValuesOf values_of) {
  const auto count = static_cast<int>(elements.size());
  out.begin(sequence, count, at);
  for (int i = 0; i < count; ++i) {
    const auto values = values_of(elements[static_cast<std::size_t>(i)]);
    for (std::size_t s = 0; s < signals.size(); ++s) out.set(i, signals[s], values[s]);
  }
}

}  // namespace ttf::sensors
