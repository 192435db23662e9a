#include "core/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/errors.h"
#include "core/file_bytes.h"

namespace ttf {
namespace {

struct Kind {
  FileKind kind;
  std::string_view name;
  std::string_view taken_by;
  std::span<const std::string_view> own;   // keys that no other kind has
  std::span<const std::string_view> only;  // all keys of a kind that is recognised by having no others; else empty
};

constexpr std::string_view kExperimentKeys[] = {"kind", "paradigms", "variants", "axes"};
constexpr std::string_view kScenarioKeys[] = {"clusters", "world"};
constexpr std::string_view kClusterKeys[] = {"flexray", "node_parameters", "nodes", "pdus", "extends"};
constexpr std::string_view kTrackOwn[] = {"strategy", "scans"};
constexpr std::string_view kTrackKeys[] = {"strategy", "tracker", "sensors", "scans"};
constexpr std::string_view kFaultKeys[] = {"faults"};

constexpr std::array<Kind, 9> kKinds{{
    {FileKind::kExperiment, "an experiment", "`ttfusion experiment` takes it", kExperimentKeys, {}},
    {FileKind::kScenario, "a scenario", "`ttfusion run` takes it", kScenarioKeys, {}},
    {FileKind::kCluster, "a cluster", "`ttfusion schedule check` takes it", kClusterKeys, {}},
    {FileKind::kTrack, "a track configuration", "`ttfusion track --config` takes it", kTrackOwn, kTrackKeys},
    {FileKind::kFaults, "a fault list", "an experiment takes it by the key faults", {}, kFaultKeys},
    {FileKind::kFibex, "a FIBEX file", "`ttfusion schedule export --format yaml` takes it", {}, {}},
    {FileKind::kDbc, "a DBC file", "`ttfusion schedule export` writes such files, and no command reads them", {}, {}},
    {FileKind::kLog, "a log", "`ttfusion diagram` and `ttfusion export` take it", {}, {}},
    {FileKind::kCapture, "a capture", "`ttfusion schedule check --against` takes it", {}, {}},
}};

const Kind& row_of(FileKind kind) {
  return *std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& one) { return one.kind == kind; });
}

bool has_any(const YamlMap& root, std::span<const std::string_view> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) { return root.has(key); });
}

// Whether the file has some of the keys, and no other.
bool has_only(const StrictYaml& file, std::span<const std::string_view> keys) {
  Findings others;
  YamlMap root = file.root(others);
  std::size_t there = 0;
  for (const std::string_view key : keys) there += root.has(key) ? 1 : 0;
  root.finish();
  return there > 0 && others.empty();
}

// Returns whether a line begins with the keyword and a colon: a section of a DBC file.
bool has_section(std::string_view text, std::string_view keyword) {
  for (std::size_t at = text.find(keyword); at != std::string_view::npos; at = text.find(keyword, at + 1)) {
    const std::size_t colon = text.find_first_not_of(" \t", at + keyword.size());
    const bool begins_line = at == 0 || text[at - 1] == '\n';
    if (begins_line && colon != std::string_view::npos && text[colon] == ':') return true;
  }
  return false;
}

constexpr std::string_view kMcap = "\x89MCAP0\r\n";
// pcapng, and pcap in both byte orders, with microseconds and with nanoseconds.
constexpr std::string_view kCaptures[] = {"\x0a\x0d\x0d\x0a", "\xa1\xb2\xc3\xd4", "\xd4\xc3\xb2\xa1",
                                          "\xa1\xb2\x3c\x4d", "\x4d\x3c\xb2\xa1"};

std::optional<FileKind> exchange_kind_of(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf", kFibexNamespace = "http://www.asam.net/xml/fbx";
  if (text.starts_with(kMcap)) return FileKind::kLog;
  for (const std::string_view magic : kCaptures)
    if (text.starts_with(magic)) return FileKind::kCapture;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return std::nullopt;
  if (text[first] == '<')
    return text.find(kFibexNamespace) != std::string_view::npos ? std::optional(FileKind::kFibex) : std::nullopt;
  return has_section(text, "BS_") && has_section(text, "BU_") ? std::optional(FileKind::kDbc) : std::nullopt;
}

[[noreturn]] void refuse(const std::string& path, const Kind& found, std::string_view wanted) {
  throw InputError({path, 0, "", "", fmt::format("this is {}, not {}; {}", found.name, wanted, found.taken_by)});
}

}  // namespace

std::optional<FileKind> kind_of(const StrictYaml& file) {
  if (file.text().empty()) return std::nullopt;  // a described file: its loader alone may ask for keys
  Findings none;
  const YamlMap root = file.root(none);
  for (const Kind& one : kKinds)
    if (has_any(root, one.own)) return one.kind;
  for (const Kind& one : kKinds)
    if (has_only(file, one.only)) return one.kind;
  return std::nullopt;
}

std::optional<FileKind> kind_of_file(const std::string& path) {
  std::string text = read_file(path);
  if (const auto found = exchange_kind_of(text)) return found;
  return kind_of(StrictYaml::parse(std::move(text), path));
}

StrictYaml load_of_kind(const std::string& path, FileKind wanted) {
  std::string text = read_file(path);
  if (const auto found = exchange_kind_of(text)) refuse(path, row_of(*found), row_of(wanted).name);
  StrictYaml file = StrictYaml::parse(std::move(text), path);
  expect_kind(file, wanted);
  return file;
}

void expect_kind(const StrictYaml& file, FileKind wanted) {
  const auto found = kind_of(file);
  if (!found || *found == wanted) return;
  Findings none;
  if (has_any(file.root(none), row_of(wanted).own)) return;
  refuse(file.name(), row_of(*found), row_of(wanted).name);
}

void expect_log(const std::string& path) {
  if (!read_file(path, kMcap.size()).starts_with(kMcap)) refuse_any_kind(path, row_of(FileKind::kLog).name);
}

void refuse_any_kind(const std::string& path, std::string_view wanted) {
  std::optional<FileKind> found;
  try {
    found = kind_of_file(path);
  } catch (const InputError&) {
    return;  // neither readable nor YAML
  }
  if (found && row_of(*found).name != wanted) refuse(path, row_of(*found), wanted);
}

}  // namespace ttf
