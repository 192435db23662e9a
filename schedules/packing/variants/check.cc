#include "schedules/packing/variants/check.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "schedules/packing/variants/projection.h"

namespace ttf::schedules::packing::variants {

std::vector<Violation> variant_violations(const Instance& instance, const Assignment& assignment) {
  if (instance.variants.empty()) return violations(instance, assignment);
  std::map<std::size_t, std::string> wrong;
  for (int variant = 0; variant < instance.variant_count(); ++variant) {
    const Projection vehicle = projection(instance, variant);
    for (const Violation& violation : violations(vehicle.instance, vehicle.of(assignment)))
      wrong.emplace(vehicle.whole[violation.signal], fmt::format("{}, in variant {}", violation.text,
                                                                 instance.variants[static_cast<std::size_t>(variant)]));
  }
  std::vector<Violation> found;
  for (auto& [signal, text] : wrong) found.push_back({signal, std::move(text)});
  return found;
}

}  // namespace ttf::schedules::packing::variants
