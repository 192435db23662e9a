// `schedule check --task-set FILE.csv`: responses and chains of bare tasks and messages.
#pragma once

#include <string>

namespace ttf::cli::schedule {

// Prints the responses and the chains; returns 1 if a deadline or a largest age is not kept. Throws InputError.
int check_task_set(const std::string& file, bool json);

}  // namespace ttf::cli::schedule
