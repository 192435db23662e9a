// Judges the use that a replay made of its input, by its account. A replay without any track has not done its work, nor
// has one that dropped most of its input. Every cause that applies gives one sentence with numbers. The causes are
// rows of one table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recording/replay/recorded_lists.h"
#include "recording/replay/replay.h"
#include "recording/rows/observation_rows.h"

namespace ttf::recording::replay {

struct ReplayVerdict {
  bool made_nothing = false;         // no track was confirmed
  bool dropped_most = false;         // more than half of the rows or of the lists
  std::string headline;              // for example "no track came of 41 lists"
  std::vector<std::string> reasons;  // in the order of the table; empty only if the work was done

  bool did_its_work() const { return !made_nothing && !dropped_most; }
};

// Rows of the recording, which may be returns of a scanner: those behind the lists, and those left out.
struct RowCounts {
  std::uint64_t sound = 0, damaged = 0;
};

// `rows` are the observations that were read; of scans there are none.
ReplayVerdict judge(const std::vector<recording::rows::ObservationRow>& rows, RowCounts counts,
                    const RecordedLists& recorded, const ReplaySetup& setup, const ReplayAccount& account);

}  // namespace ttf::recording::replay
