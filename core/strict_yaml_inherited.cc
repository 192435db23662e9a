// The part of YamlMap about keys that another mapping gives, and about the key that asks for them.
#include <fmt/format.h>

#include "core/nearest.h"
#include "core/strict_yaml.h"
#include "core/yaml_content.h"
#include "core/yaml_node.h"

namespace ttf {

void YamlMap::inherit(const YamlMap& other) { content_->inherited = other.content_; }

bool YamlMap::has_own(std::string_view key) const { return !is_described() && child(content_->node, key).IsDefined(); }

std::vector<std::string> YamlMap::inherited() const {
  std::vector<std::string> keys;
  for (const std::string& key : content_->asked)
    if (!has_own(key) && content_->child(key).IsDefined()) keys.push_back(key);
  return keys;
}

std::string YamlMap::value_text(std::string_view key) {
  if (is_described()) return text(key);
  content_->asked.emplace(key);
  const YAML::Node node = content_->child(key);
  if (!node.IsDefined()) return "";
  if (node.IsNull()) return "~";
  if (node.IsScalar()) return node.Scalar().empty() ? "\"\"" : node.Scalar();
  YAML::Node copy = YAML::Clone(node);
  copy.SetStyle(YAML::EmitterStyle::Flow);
  return YAML::Dump(copy);
}

bool YamlMap::refuse_misspelt(std::string_view key) {
  if (is_described() || has_own(key) || !content_->node.IsMap()) return false;
  for (const auto& entry : content_->node) {
    const std::string typed = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (!nearest(typed, {std::string(key)})) continue;
    content_->gone.insert(typed);  // said here
    fail(typed, fmt::format("is not a known key here{}", did_you_mean(typed, {std::string(key)})));
    return true;
  }
  return false;
}

void YamlMap::mute() { findings_ = &content_->muted; }

}  // namespace ttf
