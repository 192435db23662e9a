// Files that come with the program, found by name: `ttfusion run paper_scenario1`.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::cli {

inline constexpr std::string_view kScenarios = "scenarios", kSchedules = "schedules", kExperiments = "experiments";
inline constexpr std::string_view kTaskSets = "schedules/task_sets", kPlans = "schedules/plans";

// Returns the path of the file that `typed` means, with or without .yaml, or .csv for a task set. A file of one's own goes first. Else it is a
// shipped file by its name, or by folder and name: "scenarios/crowd.yaml". Throws InputError if there is neither. Paths
// into other folders are returned as they are, for their reader to refuse.
std::string file_named(const std::string& typed, std::initializer_list<std::string_view> folders);

// Returns the names of the shipped files in a folder, sorted; none if the program stands alone.
std::vector<std::string> shipped_names(std::string_view folder);

}  // namespace ttf::cli
