// The part of YamlMap that reads mappings within mappings and lists.
#include <fmt/format.h>

#include <memory>
#include <utility>

#include "core/strict_yaml.h"
#include "core/yaml_content.h"
#include "core/yaml_node.h"

namespace ttf {

YamlMap YamlMap::map(std::string_view key) {
  if (is_described()) {
    ask(question(key, KeyType::kMap));
    return described_map(key_path(key));
  }
  content_->asked.emplace(key);
  const YAML::Node node = content_->child(key);
  if (!node.IsDefined()) fail(key, "is missing: must be a mapping");
  if (node.IsDefined() && !node.IsMap()) fail(key, "must be a mapping");
  auto content = std::make_shared<Content>();
  content->file = content_->file;
  content->line = line(key);
  if (node.IsDefined() && node.IsMap()) content->node.reset(node);
  return YamlMap(std::move(content), key_path(key), findings_);
}

std::optional<YamlMap> YamlMap::map_if(std::string_view key) {
  if (!has(key)) return std::nullopt;
  return map(key);
}

std::optional<YamlMap> YamlMap::map_or_word(std::string_view key, std::string_view word, std::string_view expected) {
  if (is_map(key)) return map(key);
  if (is_described())
    described_choice(key, {word}, false, std::nullopt);
  else if (const auto text = scalar(key, expected); text && *text != word)
    fail(key, std::string(expected));
  return std::nullopt;
}

std::vector<YamlMap> YamlMap::maps(std::string_view key) {
  if (is_described()) {
    ask(question(key, KeyType::kMaps));
    return {described_map(key_path(key) + "[]")};
  }
  content_->asked.emplace(key);
  const YAML::Node node = content_->child(key);
  std::vector<YamlMap> list;
  if (!node.IsDefined() || !node.IsSequence()) {
    fail(key, node.IsDefined() ? "must be a list of mappings" : "is missing: must be a list of mappings");
    return list;
  }
  std::size_t number = 0;
  for (const auto& item : node) {
    const std::string path = fmt::format("{}[{}]", key_path(key), number++);
    if (!item.IsMap()) {
      findings_->add({content_->file, line_of(item), path, "", "must be a mapping"});
      continue;
    }
    auto content = std::make_shared<Content>();
    content->file = content_->file;
    content->node.reset(item);
    list.push_back(YamlMap(std::move(content), path, findings_));
  }
  return list;
}

std::vector<YamlMap> YamlMap::maps_if(std::string_view key) { return has(key) ? maps(key) : std::vector<YamlMap>{}; }

std::vector<std::pair<std::string, YamlMap>> YamlMap::named_maps(std::string_view key) {
  if (is_described()) {
    ask(question(key, KeyType::kNamedMaps));
    return {{kAnyName, described_map(fmt::format("{}.{}", key_path(key), kAnyName))}};
  }
  YamlMap outer = map(key);
  auto list = outer.other_maps();
  outer.finish();
  return list;
}

std::vector<std::pair<std::string, YamlMap>> YamlMap::other_maps() {
  if (is_described()) {
    KeyQuestion asked = question(kAnyName, KeyType::kMap);
    asked.optional = true;
    ask(asked);
    return {{kAnyName, described_map(key_path(kAnyName))}};
  }
  std::vector<std::pair<std::string, YamlMap>> list;
  if (!content_->node.IsDefined() || !content_->node.IsMap()) return list;
  const auto known = content_->asked;
  for (const auto& entry : content_->node) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (known.contains(name)) continue;
    const std::string path = key_path(name);
    content_->asked.insert(name);
    if (!entry.second.IsMap()) {
      findings_->add({content_->file, line_of(entry.first), path, "", "must be a mapping"});
      continue;
    }
    auto content = std::make_shared<Content>();
    content->file = content_->file;
    content->node.reset(entry.second);
    list.emplace_back(name, YamlMap(std::move(content), path, findings_));
  }
  return list;
}

std::vector<std::pair<std::string, std::string>> YamlMap::named_texts(std::string_view key) {
  if (is_described()) {
    ask(question(key, KeyType::kNamedTexts));
    return {{kAnyName, kAnyName}};
  }
  YamlMap outer = map(key);
  std::vector<std::pair<std::string, std::string>> list;
  if (!outer.content_->node.IsDefined() || !outer.content_->node.IsMap()) return list;
  for (const auto& entry : outer.content_->node) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    outer.content_->asked.insert(name);
    if (entry.second.IsScalar())
      list.emplace_back(name, entry.second.Scalar());
    else
      outer.fail(name, "must be a text");
  }
  outer.finish();
  return list;
}

}  // namespace ttf
