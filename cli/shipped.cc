#include "cli/shipped.h"

#include <fmt/format.h>
#include <ttf_built.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "core/counted.h"
#include "core/errors.h"
#include "core/nearest.h"

namespace ttf::cli {
namespace {

namespace fs = std::filesystem;

// The end of the names of files in a folder.
std::string_view end_of(std::string_view folder) { return folder == kTaskSets ? ".csv" : ".yaml"; }

// Returns the folder of the shipped files: beside the program in a build, where it was installed, or in the prefix that it was
// built for. An installed tree may be moved.
std::optional<fs::path> data_folder() {
  std::error_code none;
  const fs::path own = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder : {own / TTF_DATA_IN_BUILD, own / TTF_DATA_FROM_PROGRAM, fs::path(TTF_DATA_INSTALLED)})
    if (fs::is_directory(folder / kScenarios, none)) return folder.lexically_normal();
  return std::nullopt;
}

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

std::string_view without_end(std::string_view name) {
  for (const std::string_view end : {".yaml", ".csv"})
    if (name.ends_with(end)) name.remove_suffix(end.size());
  return name;
}

// Returns the word for one file of a folder: "scenarios" are scenarios.
std::string one_of_folder(std::string_view folder) {
  if (folder == kTaskSets) return "task set";
  const std::string_view last = folder.substr(folder.rfind('/') + 1);
  return std::string(last.substr(0, last.size() - 1));
}

[[noreturn]] void refuse(const std::string& typed, const std::vector<std::string_view>& folders) {
  std::vector<std::string> names, kinds;
  for (const std::string_view folder : folders) {
    for (std::string& name : shipped_names(folder)) names.push_back(std::move(name));
    kinds.push_back(one_of_folder(folder));
  }
  const std::string name = fs::path(typed).filename().string();
  throw InputError({typed, 0, "", "",
                    fmt::format("is neither a file nor the name of a shipped {}{}", joined(kinds, " or "),
                                did_you_mean(without_end(name), names))});
}

}  // namespace

std::string file_named(const std::string& typed, std::initializer_list<std::string_view> folders) {
  std::error_code none;
  const fs::path path = typed;
  const bool is_own = fs::exists(path, none) && !fs::is_directory(path, none);  // a folder has results
  if (typed.empty() || path.is_absolute() || is_own) return typed;
  for (const std::string_view folder : folders)
    if (const std::string own = typed + std::string(end_of(folder)); is_file(own)) return own;
  std::vector<std::string_view> searched;
  for (const std::string_view folder : folders)
    if (!path.has_parent_path() || path.parent_path() == folder) searched.push_back(folder);
  if (searched.empty()) return typed;
  const std::string name = path.filename().string();
  if (const auto data = data_folder())
    for (const std::string_view folder : searched)
      for (const std::string& file : {name, name + std::string(end_of(folder))})
        if (const fs::path shipped = *data / folder / file; is_file(shipped)) return shipped.string();
  refuse(typed, searched);
}

std::vector<std::string> shipped_names(std::string_view folder) {
  std::vector<std::string> names;
  std::error_code none;
  if (const auto data = data_folder())
    for (const fs::directory_entry& entry : fs::directory_iterator(*data / folder, none))
      if (is_file(entry.path()) && entry.path().extension() == end_of(folder))
        names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace ttf::cli
