#include "report/drive/injected_table.h"

#include <optional>

#include "report/drawing/tables.h"

namespace ttf::report::drive {
namespace {

std::string seconds_cell(const std::optional<TrueTime>& at) {
  return at ? drawing::cell((*at - TrueTime{}).seconds(), 6) : "-";
}

}  // namespace

std::vector<std::string> injected_columns() {
  return {"#", "fault", "node", "begins [s]", "first act [s]", "acts", "ends [s]", "its first act"};
}

std::vector<std::string> injected_row(const evaluation::faults::InjectedFault& fault, const std::string& node) {
  return {std::to_string(fault.fault),
          fault.kind,
          node,
          seconds_cell(fault.begins),
          seconds_cell(fault.first_act),
          std::to_string(fault.acts),
          seconds_cell(fault.ends),
          fault.text};
}

}  // namespace ttf::report::drive
