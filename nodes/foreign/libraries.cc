#include "nodes/foreign/libraries.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "core/file_bytes.h"
#include "core/hash.h"
#include "nodes/foreign/foreign_step.h"
#include "schedules/model/ports.h"

namespace ttf::nodes::foreign {
namespace {

[[noreturn]] void refuse(Finding place, std::string expected) {
  place.expected = std::move(expected);
  throw InputError(std::move(place));
}

template <class Function>
Function* function_of(void* library, const char* name, const std::string& path, const Finding& place) {
  void* const address = dlsym(library, name);
  if (address == nullptr)
    refuse(place, fmt::format("must have the functions of ttfusion_step.h: {} lacks {}", path, name));
  return reinterpret_cast<Function*>(address);
}

}  // namespace

Library load_library(const std::string& path, const Finding& place, const CallTerms& terms) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none))
    refuse(place, fmt::format("must be a file in the folder of --steps: there is no {}", path));
  void* handle = nullptr;
  {
    const Call call(terms);  // a library has code that runs when it is loaded
    handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  }
  if (handle == nullptr) {
    const char* const words = dlerror();
    refuse(place, fmt::format("must be a shared library that can be loaded: {}", words != nullptr ? words : path));
  }
  const auto abi = function_of<decltype(ttf_step_abi)>(handle, "ttf_step_abi", path, place);
  std::uint32_t version = 0;
  if (const auto thrown = thrown_by(terms, [&] { version = abi(); })) refuse(place, "ttf_step_abi " + *thrown);
  if (version != TTF_STEP_ABI)
    refuse(place, fmt::format("must be built with version {} of ttfusion_step.h: {} is of version {}", TTF_STEP_ABI,
                              path, version));
  return {function_of<decltype(ttf_step_create)>(handle, "ttf_step_create", path, place),
          function_of<decltype(ttf_step_run)>(handle, "ttf_step_run", path, place),
          function_of<decltype(ttf_step_destroy)>(handle, "ttf_step_destroy", path, place)};
}

void check_steps(const schedules::model::Cluster& cluster, const StepFolder* folder) {
  for (const schedules::model::Node& node : cluster.nodes) check_steps(cluster, node, folder);
}

void check_steps(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
                 const StepFolder* folder) {
  for (const schedules::model::Task& task : node.tasks)
    if (schedules::model::names_library(task.step)) ForeignStep(cluster, node, task, folder);
}

std::vector<std::pair<std::string, std::string>> library_hashes(const schedules::model::Cluster& cluster,
                                                                const StepFolder* folder,
                                                                const std::vector<NodeId>& without) {
  std::set<std::string> names;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (std::ranges::find(without, n, [](NodeId node) { return index_of(node); }) != without.end()) continue;
    for (const schedules::model::Task& task : cluster.nodes[n].tasks)
      if (schedules::model::names_library(task.step)) names.insert(task.step);
  }
  std::vector<std::pair<std::string, std::string>> hashes;
  if (folder == nullptr) return hashes;
  for (const std::string& name : names) hashes.emplace_back(name, hex_hash(read_file(folder->path + "/" + name)));
  return hashes;
}

}  // namespace ttf::nodes::foreign
