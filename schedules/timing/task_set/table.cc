#include "schedules/timing/task_set/table.h"

#include <cstdint>
#include <numeric>

namespace ttf::schedules::timing::task_set {

std::optional<std::pair<std::size_t, std::size_t>> overlap_in(std::span<const TableEntry> table) {
  for (std::size_t a = 0; a < table.size(); ++a) {
    if (table[a].worst > table[a].period) return std::pair(a, a);
    for (std::size_t b = a + 1; b < table.size(); ++b) {
      const std::int64_t divisor = std::gcd(table[a].period.ns, table[b].period.ns);
      const std::int64_t behind = (table[b].offset - table[a].offset).ns % divisor;
      const std::int64_t distance = behind < 0 ? behind + divisor : behind;
      if (distance < table[a].worst.ns || divisor - distance < table[b].worst.ns) return std::pair(a, b);
    }
  }
  return std::nullopt;
}

}  // namespace ttf::schedules::timing::task_set
