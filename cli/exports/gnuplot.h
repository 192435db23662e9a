// Exports tables and gnuplot scripts for papers, from drives' logs or an experiment's folder.
#pragma once

#include <string>
#include <vector>

namespace ttf::cli::exports {

// `inputs` are logs, or folders of logs, of one or several drives, or one experiment's folder. Creates `out`
// if missing. Throws InputError, or std::runtime_error if a file cannot be written. Returns the files' names.
std::vector<std::string> export_gnuplot(const std::vector<std::string>& inputs, const std::string& out);

}  // namespace ttf::cli::exports
