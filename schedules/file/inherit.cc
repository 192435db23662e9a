#include "schedules/file/inherit.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "core/yaml_merge.h"

namespace ttf::schedules::file {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestChain = 16;

// Returns the base's path, and the finding that names the entry in the file.
std::pair<std::string, Finding> base_of(const StrictYaml& file) {
  Findings findings;
  YamlMap root = file.root(findings);
  const std::string base = root.text("extends");
  findings.throw_if_any();
  return {(fs::path(file.name()).parent_path() / base).lexically_normal().string(),
          {file.name(), root.line("extends"), "extends", base, ""}};
}

bool extends(const StrictYaml& file) {
  Findings none;
  return file.root(none).has("extends");
}

// `heirs`: the files that led here.
void refuse_circle(const std::string& base, const std::vector<YamlLayer>& heirs, Finding entry) {
  const fs::path there = fs::weakly_canonical(base);
  const bool again = std::any_of(heirs.begin(), heirs.end(),
                                 [&](const YamlLayer& heir) { return fs::weakly_canonical(heir.name) == there; });
  if (again)
    entry.expected = "must not lead back to a file that extends it";
  else if (heirs.size() >= kLongestChain)
    entry.expected = fmt::format("must end after {} files", kLongestChain);
  else
    return;
  throw InputError(std::move(entry));
}

// Returns the file and all that it extends, the lowest first.
std::vector<YamlLayer> layers_of(StrictYaml file) {
  std::vector<YamlLayer> layers{{file.text(), file.name()}};
  while (extends(file)) {
    const auto [base, entry] = base_of(file);
    refuse_circle(base, layers, entry);
    (void)read_named_file(base, entry, "a cluster file");
    file = load_of_kind(base, FileKind::kCluster);
    layers.push_back({file.text(), base});
  }
  std::reverse(layers.begin(), layers.end());
  return layers;
}

}  // namespace

ClusterText inherited(const std::string& path) {
  StrictYaml file = load_of_kind(path, FileKind::kCluster);
  if (!extends(file)) return {file.text(), path, {}};
  Findings none;
  const TextPlace heir{path, file.root(none).line("extends")};
  try {
    MergedYaml merged = merge_yaml(layers_of(std::move(file)), "extends");
    merged.origins.set_heir(heir);
    return {std::move(merged.text), path, std::move(merged.origins)};
  } catch (const InputError& error) {
    TextOrigins origins;
    origins.set_heir(heir);
    std::vector<Finding> findings = error.findings();
    for (Finding& finding : findings) finding = origins.with_heir(std::move(finding));
    throw InputError(std::move(findings));
  }
}

}  // namespace ttf::schedules::file
