#include "core/yaml_edit.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "core/errors.h"
#include "core/yaml_node.h"

namespace ttf {
namespace {

// Returns an undefined node for a path that leads nowhere.
YAML::Node at(const YAML::Node& root, std::string_view path) {
  YAML::Node node = root;
  while (!path.empty() && node.IsDefined()) {
    if (path.front() == '[') {
      const std::size_t close = path.find(']');
      std::size_t index = 0;
      if (close == std::string_view::npos) return YAML::Node(YAML::NodeType::Undefined);
      const auto [end, error] = std::from_chars(path.data() + 1, path.data() + close, index);
      const bool found = error == std::errc{} && end == path.data() + close && node.IsSequence() && index < node.size();
      if (!found) return YAML::Node(YAML::NodeType::Undefined);
      node.reset(node[index]);
      path.remove_prefix(close + 1);
      if (!path.empty() && path.front() == '.') path.remove_prefix(1);
    } else {
      const std::size_t key = std::min(path.find_first_of(".["), path.size());
      node.reset(child(node, path.substr(0, key)));
      path.remove_prefix(key);
      if (!path.empty() && path.front() == '.') path.remove_prefix(1);
    }
  }
  return node;
}

YAML::Node parsed(const std::string& text, const std::string& name) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError({name, error.mark.line + 1, "", "", "is not YAML: " + error.msg});
  }
}

}  // namespace

std::string with_value(const std::string& text, const std::string& name, std::string_view path,
                       std::string_view value) {
  const YAML::Node found = at(parsed(text, name), path);
  if (!found.IsDefined())
    throw InputError({name, 0, std::string(path), "", "must be in the file: only its written keys can be varied"});
  const int line = found.Mark().line + 1;
  const auto begin = static_cast<std::size_t>(found.Mark().pos);
  const bool plain = found.IsScalar() && text.compare(begin, found.Scalar().size(), found.Scalar()) == 0;
  if (!plain) throw InputError({name, line, std::string(path), "", "must be a plain scalar to be varied"});
  std::string edited = text;
  edited.replace(begin, found.Scalar().size(), value);
  // Any other value could change type, or the meaning of the text behind it.
  std::optional<std::string> now;
  try {
    const YAML::Node again = at(YAML::Load(edited), path);
    if (again.IsScalar()) now = again.Scalar();
  } catch (const YAML::Exception&) {
  }
  if (now != value) throw InputError({name, line, std::string(path), std::string(value), "must be a plain scalar"});
  return edited;
}

std::string with_key(const std::string& text, const std::string& name, std::string_view path, std::string_view value,
                     int* line) {
  const YAML::Node root = parsed(text, name);
  const std::size_t last = path.rfind('.');
  const YAML::Node map = last == std::string_view::npos ? root : at(root, path.substr(0, last));
  if (!map.IsDefined() || !map.IsMap())
    throw InputError({name, 0, std::string(path), std::string(value), "must be in a mapping that the file has"});
  std::string entry = std::string(path.substr(last == std::string_view::npos ? 0 : last + 1)) + ": ";
  entry += value;
  const bool empty = map.size() == 0;  // {}, maybe behind an anchor
  const YAML::Mark first = empty ? map.Mark() : map.begin()->first.Mark();
  const auto begin = static_cast<std::size_t>(first.pos);
  const bool flow = empty || map.Style() == YAML::EmitterStyle::Flow;
  entry += flow ? ", " : "\n" + std::string(static_cast<std::size_t>(first.column), ' ');
  if (!flow) *line = first.line + 1;
  std::string edited = text;
  return edited.insert(empty ? text.find('{', begin) + 1 : begin, entry);
}

}  // namespace ttf
