// The table of a drive's injected faults, as the program prints it and as it stands on pages.
#pragma once

#include <string>
#include <vector>

#include "evaluation/faults/injected_fault.h"

namespace ttf::report::drive {

std::vector<std::string> injected_columns();
// `node`: the faulty node's name, or "-".
std::vector<std::string> injected_row(const evaluation::faults::InjectedFault& fault, const std::string& node);

}  // namespace ttf::report::drive
