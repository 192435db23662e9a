// Sections drawn from drives' logs, side by side; the page of a results folder and an experiment's share them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/time.h"
#include "report/drive/results_folder.h"
#include "report/drive/tables.h"
#include "report/page/page.h"

namespace ttf::report::drive {

// The part of each drive that its timing diagram shows first; 160 ms take half a megabyte. The whole drive is packed,
// in windows of that length.
struct DiagramWindow {
  // By default, it begins with the judged part of the drive; 2 s at most.
  std::optional<TrueTime> from, to;
  Duration length = Duration::milliseconds(160);  // if an end is missing
  std::size_t most = 6;                           // drives
  std::size_t packed_bytes = 5'000'000;           // all drives together
};

inline constexpr std::size_t kMostScenes = 6;  // drives

// Returns the drives with the series of their logs, and the first with their scenes.
std::vector<ReportedDrive> reported_drives(const std::vector<const Drive*>& drives);

// Each section is omitted if it is empty, except the faults: their absence deserves a sentence.
void scene_section(page::Page& page, const std::vector<ReportedDrive>& drives);
void errors_section(page::Page& page, const std::vector<ReportedDrive>& drives);
void timing_section(page::Page& page, const std::vector<ReportedDrive>& drives, const DiagramWindow& window);
void time_base_section(page::Page& page, const std::vector<ReportedDrive>& drives,
                       std::size_t most);  // the most drives with a plot of corrections
void troubles_section(page::Page& page, const std::vector<ReportedDrive>& drives);

}  // namespace ttf::report::drive
