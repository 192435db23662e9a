// The variants of a vehicle by name, as a column of a file of signals has them: "base|sport".
#pragma once

#include <string>
#include <vector>

#include "cli/schedule/packing/columns.h"
#include "schedules/packing/instance.h"

namespace ttf::cli::schedule::packing {

// Numbers the variants in the order of their first line.
class VariantNames {
 public:
  // Returns the variants of a row: all, also those of later lines, if the field is blank. Adds a finding for a name
  // that is no part of a file's name, occurs twice, or is one too many.
  schedules::packing::VariantSet read(const Rows& rows, Findings& findings);

  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

// Returns the field of a row with these variants.
std::string variants_text(schedules::packing::VariantSet variants, const std::vector<std::string>& names);

}  // namespace ttf::cli::schedule::packing
