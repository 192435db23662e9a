// Binds code to the signals of a PDU by name, once, at start-up. A signal that the code needs and the layout
// lacks is a finding, as is a signal unknown to the code. Signals called "spare" are padding.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

template <std::size_t N>
std::array<std::size_t, N> bind_element(const schedules::model::Cluster& cluster,
                                        const schedules::model::PduLayout& layout,
                                        const std::array<std::string_view, N>& names) {
  Findings findings;
  std::array<std::size_t, N> signals{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto found = schedules::model::find_signal(layout.element, names[i]);
    if (found)
      signals[i] = *found;
    else
      findings.add(cluster.finding(layout.line, "pdus." + layout.name + ".element", std::string(names[i]),
                                   "is missing: the code that fills or reads this PDU needs it"));
  }
  for (const schedules::model::Signal& signal : layout.element)
    if (signal.name != "spare" && std::find(names.begin(), names.end(), signal.name) == names.end())
      findings.add(cluster.finding(layout.line, "pdus." + layout.name + ".element", signal.name,
                                   "is not a signal that the code knows"));
  findings.throw_if_any();
  return signals;
}

// Does the same for code whose number of signals depends on the PDU.
template <std::size_t N>
std::vector<std::size_t> bind_elements(const schedules::model::Cluster& cluster,
                                       const schedules::model::PduLayout& layout,
                                       const std::array<std::string_view, N>& names) {
  const auto signals = bind_element<N>(cluster, layout, names);
  return {signals.begin(), signals.end()};
}

// Returns the binding of a task's `port`; ports are known to exist by then (schedules/model/ports.h).
const schedules::model::PortBinding& binding_of(const std::vector<schedules::model::PortBinding>& bindings,
                                                std::string_view port);

}  // namespace ttf::nodes::host
