#include "cli/schedule/packing/columns.h"
#include "cli/schedule/packing/standing.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;

void take_row(const Rows& rows, StandingGatherer& standing, Findings& findings) {
  if (rows.text(kSlot).empty() && rows.text(kFirstCycle).empty() && rows.text(kBitOffset).empty()) return;
  const StandingSignal signal{rows.text(kSignal), rows.text(kNode),    rows.text(kPeriod),
                              rows.text(kBits),   rows.text(kChannel), rows.line()};
  const auto index = standing.find(signal, findings);
  if (!index) return;
  const auto slot = rows.whole(kSlot, {0, table::kLastStaticSlot}, findings);
  const auto cycle = rows.whole(kFirstCycle, {0, table::kMostCycles - 1}, findings);
  const auto offset = rows.whole(kBitOffset, {0, table::kMostPayloadBits - 1}, findings);
  if (slot && cycle && offset) standing.place(*index, signal, {{*slot, {}}, *cycle, *offset}, findings);
}

}  // namespace

void gather_csv(const std::string& text, const std::string& name, StandingGatherer& standing, Findings& findings) {
  Rows rows(text, name, {kSignal, kNode, kPeriod, kBits, kSlot, kFirstCycle, kBitOffset});
  while (rows.next(findings)) take_row(rows, standing, findings);
}

}  // namespace ttf::cli::schedule::packing
