// Sections of a page that are drawn from drives' logs, side by side: the same in a run's page and in an experiment's.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/time.h"
#include "report/page/page.h"
#include "report/run/results_folder.h"
#include "report/run/tables.h"

namespace ttf::report::run {

// What is drawn as timing diagrams, half a megabyte for 160 ms of a drive.
struct DiagramWindow {
  // From where the drive is judged unless given; 2 s at most.
  std::optional<TrueTime> from, to;
  Duration length = Duration::milliseconds(160);  // where it is not given
  std::size_t most = 6;                           // drives
};

// The drive with what its log comes to.
ToldDrive told_of(const Drive& drive);

// Each is left out where there is nothing to show, but for the faults: that there were none is worth a sentence.
void errors_section(page::Page& page, const std::vector<ToldDrive>& drives);
void timing_section(page::Page& page, const std::vector<ToldDrive>& drives, const DiagramWindow& window);
void time_base_section(page::Page& page, const std::vector<ToldDrive>& drives,
                       std::size_t most);  // corrections of so many
void troubles_section(page::Page& page, const std::vector<ToldDrive>& drives);

}  // namespace ttf::report::run
