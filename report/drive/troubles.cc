// The tables of injected faults and of problems in a drive.
#include <fmt/format.h>

#include <utility>

#include "recording/records/enumerations.h"
#include "report/drawing/names.h"
#include "report/drive/injected_table.h"
#include "report/drive/tables.h"

namespace ttf::report::drive {

std::vector<page::PageTable> trouble_tables(const ReportedDrive& reported) {
  const drawing::Names names =
      reported.drive->log ? drawing::names_of(reported.drive->log->manifest()) : drawing::Names{};
  const std::string& label = reported.drive->label;
  const DriveSeries& series = reported.series;
  page::PageTable faults{label + ": injected faults", injected_columns(), {}};
  for (const auto& [index, fault] : series.faults)
    faults.rows.push_back(injected_row(fault, fault.node == kNoNode ? "-" : names.node(fault.node)));
  page::PageTable slots{
      label + ": slots without exactly one valid frame, by receiver", {"receiver", "status", "times"}, {}};
  for (const auto& [node, by_status] : series.slot_problems)
    for (const auto& [status, times] : by_status)
      slots.rows.push_back({names.node(node), to_text(status), std::to_string(times)});
  page::PageTable guardian{label + ": interventions of central guardians", {"why", "times"}, {}};
  for (const auto& [why, times] : series.guardian) guardian.rows.push_back({why, std::to_string(times)});
  page::PageTable deadlines{label + ": deadlines missed", {"task", "times"}, {}};
  for (const auto& [task, times] : series.deadlines_missed)
    deadlines.rows.push_back(
        {names.node(task.first) + ": " + names.task(task.first, task.second), std::to_string(times)});
  std::vector<page::PageTable> tables;
  for (page::PageTable* table : {&faults, &slots, &guardian, &deadlines})
    if (!table->rows.empty()) tables.push_back(std::move(*table));
  return tables;
}

}  // namespace ttf::report::drive
