// Tables and gnuplot scripts for papers, of a run's logs or of an experiment's folder.
#pragma once

#include <string>
#include <vector>

namespace ttf::cli::logs {

// `inputs`: logs, or folders of logs, of one run or of several; or one experiment's folder. Creates `out` where it is
// not there. Throws InputError, or std::runtime_error where something cannot be written. Returns the files' names.
std::vector<std::string> export_gnuplot(const std::vector<std::string>& inputs, const std::string& out);

}  // namespace ttf::cli::logs
