#include "schedules/file/load_instants.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "schedules/model/repetitions.h"

namespace ttf::schedules::file {
namespace {

constexpr Range<std::int64_t> kBaseCycles{0, 63}, kRepetitions{1, 64};

}  // namespace

void load_multiplexing(YamlMap& map, const model::GlobalParameters& flexray, const std::vector<int>& allowed,
                       const char* within, MayLack may, left_out::Instant& absent, int& base_cycle, int& repetition) {
  const auto base = may.instant ? map.integer_if("base_cycle", kBaseCycles) : map.integer("base_cycle", kBaseCycles);
  const auto every = may.repetition ? map.integer_if("repetition", kRepetitions, "cycles")
                                    : map.integer("repetition", kRepetitions, "cycles");
  absent.instant = !base;
  absent.repetition = !every;
  if (within != nullptr && may.instant && base && map.lacks(within))
    map.fail(within, fmt::format("is missing: base_cycle and {} are both written, or both left out", within));
  if (within != nullptr && may.instant && !base && map.has(within))
    map.fail("base_cycle", fmt::format("is missing: base_cycle and {} are both written, or both left out", within));
  base_cycle = static_cast<int>(base.value_or(0));
  repetition = static_cast<int>(every.value_or(within == nullptr || absent.instant ? 1 : allowed.back()));
  bool usable = true;
  if (std::find(allowed.begin(), allowed.end(), repetition) == allowed.end()) {
    map.fail("repetition", repetitions_text(flexray, allowed));
    usable = false;
  }
  if (base_cycle >= repetition && (may.repetition || map.has("repetition"))) {
    map.fail("base_cycle", fmt::format("must be below repetition, 0..{}", repetition - 1));
    usable = false;
  }
  if (!usable) base_cycle = 0, repetition = 1;
}

model::CycleInstant load_instant(YamlMap& map, const model::GlobalParameters& flexray, MayLack may,
                                 left_out::Instant& absent) {
  model::CycleInstant at;
  load_multiplexing(map, flexray, repetitions(flexray), "offset", may, absent, at.base_cycle, at.repetition);
  const Range<std::int64_t> within{0, std::max(flexray.gMacroPerCycle - 1, 0)};
  if (may.instant)
    at.offset = {map.integer_if("offset", within, "macroticks").value_or(0)};
  else
    at.offset = {map.integer("offset", within, "macroticks")};
  return at;
}

}  // namespace ttf::schedules::file
