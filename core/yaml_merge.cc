#include "core/yaml_merge.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <utility>

#include "core/check.h"
#include "core/errors.h"
#include "core/yaml_document.h"

namespace ttf {
namespace {

constexpr int kDeepest = 32;
constexpr std::size_t kMostItems = 1'000'000;

// A value of the merged document. A mapping has its entries, all else is a node of one text.
struct Entry;
struct Item {
  std::shared_ptr<const YAML::Node> node;  // an assignment to a YAML::Node would change its document
  bool is_map = false;
  bool merged = false;  // a mapping of several layers
  std::vector<Entry> entries;
};
struct Entry {
  std::string key;
  std::size_t layer = 0;
  int line = 0;  // the key's
  Item value;
};

int line_in(const YAML::Node& node) { return std::max(node.Mark().line + 1, 1); }

class Merger {
 public:
  explicit Merger(const std::vector<YamlLayer>& layers) : layers_(layers) {}

  Item merge() {
    Item whole = read(0);
    for (std::size_t layer = 1; layer < layers_.size(); ++layer) change(whole, read(layer), "");
    findings_.throw_if_any();
    return whole;
  }

 private:
  Item read(std::size_t layer) {
    const YAML::Node root = parse_document(layers_[layer].text, layers_[layer].name);
    if (!root.IsMap()) throw InputError({layers_[layer].name, 1, "", "", "must be a YAML mapping at the top level"});
    return item(root, layer, "", 0);
  }

  void fail(std::size_t layer, int line, const std::string& path, std::string expected, std::string value = "") {
    findings_.add({layers_[layer].name, line, path, std::move(value), std::move(expected)});
  }

  // Aliases make cycles. They also make texts that grow with each level.
  void limit(const YAML::Node& node, std::size_t layer, const std::string& path, int depth) {
    if (depth > kDeepest || ++items_ > kMostItems)
      throw InputError({layers_[layer].name, line_in(node), path, "",
                        depth > kDeepest ? fmt::format("must not nest deeper than {} levels", kDeepest)
                                         : fmt::format("must not have more than {} values", kMostItems)});
  }

  Item item(const YAML::Node& node, std::size_t layer, const std::string& path, int depth) {
    limit(node, layer, path, depth);
    Item made{std::make_shared<const YAML::Node>(node), node.IsMap(), false, {}};
    if (node.IsSequence())
      for (std::size_t i = 0; i < node.size(); ++i)
        (void)item(node[i], layer, fmt::format("{}[{}]", path, i), depth + 1);
    if (!made.is_map) return made;
    for (const auto& entry : node) {
      const int line = line_in(entry.first);
      if (!entry.first.IsScalar()) {
        fail(layer, line, path, "has a key that is not a plain text");
        continue;
      }
      const std::string key = entry.first.Scalar();
      const std::string inner = path.empty() ? key : path + "." + key;
      if (find(made, key) != made.entries.end())
        fail(layer, line, inner, "is given twice in one mapping");
      else
        made.entries.push_back({key, layer, line, item(entry.second, layer, inner, depth + 1)});
    }
    return made;
  }

  static std::vector<Entry>::iterator find(Item& map, const std::string& key) {
    return std::find_if(map.entries.begin(), map.entries.end(), [&](const Entry& one) { return one.key == key; });
  }

  // Returns the place for the first key of a patch, if it is new: in front of the next key that the base has.
  static std::vector<Entry>::iterator in_front(Item& base, const Item& patch) {
    for (const Entry& next : patch.entries)
      if (const auto found = find(base, next.key); found != base.entries.end() && !next.value.node->IsNull())
        return found;
    return base.entries.end();
  }

  // Both are mappings.
  void change(Item& base, const Item& patch, const std::string& path) {
    base.merged = base.merged || !patch.entries.empty();
    const std::string* before = nullptr;
    for (const Entry& entry : patch.entries) {
      const std::string inner = path.empty() ? entry.key : path + "." + entry.key;
      const auto found = find(base, entry.key);
      if (entry.value.node->IsNull()) {
        if (found == base.entries.end())
          fail(entry.layer, entry.line, inner, "must be in the file below, for ~ to remove it", "~");
        else
          base.entries.erase(found);
        continue;
      }
      if (found == base.entries.end()) {
        refuse_nulls(entry.value, inner);
        base.entries.insert(before != nullptr ? std::next(find(base, *before)) : in_front(base, patch), entry);
      } else if (found->value.is_map && entry.value.is_map) {
        change(found->value, entry.value, inner);
      } else {
        refuse_nulls(entry.value, inner);
        *found = entry;
      }
      before = &entry.key;
    }
  }

  // In a mapping that takes nothing from below, `~` has nothing to remove.
  void refuse_nulls(const Item& item, const std::string& path) {
    for (const Entry& entry : item.entries) {
      const std::string inner = path + "." + entry.key;
      if (entry.value.node->IsNull())
        fail(entry.layer, entry.line, inner, "must be in the file below, for ~ to remove it", "~");
      refuse_nulls(entry.value, inner);
    }
  }

  const std::vector<YamlLayer>& layers_;
  Findings findings_;
  std::size_t items_ = 0;
};

// Writes a merged document, and notes where its lines come from.
class Writer {
 public:
  explicit Writer(std::vector<std::string> files) : origins_(std::move(files)) {}

  void line(std::size_t layer, int origin, const std::string& text) {
    text_ += text + "\n";
    origins_.add(layer, origin);
  }

  void map(const Item& map, int indent) {
    const std::string start(static_cast<std::size_t>(indent), ' ');
    for (const Entry& entry : map.entries)
      value(entry.value, entry.layer, entry.line, start + yaml_scalar(entry.key) + ":", indent);
  }

  MergedYaml take() { return {std::move(text_), std::move(origins_)}; }

 private:
  // `start`: the line's beginning, with the key.
  void value(const Item& item, std::size_t layer, int key_line, const std::string& start, int indent) {
    if (item.is_map && item.merged) {
      line(layer, key_line, start + (item.entries.empty() ? " {}" : ""));
      return map(item, indent + 2);
    }
    node(*item.node, layer, key_line, start, indent);
  }

  void node(const YAML::Node& node, std::size_t layer, int key_line, const std::string& start, int indent) {
    if (const auto flow = on_one_line(node))
      return line(layer, node.IsScalar() ? line_in(node) : key_line, start + " " + *flow);
    line(layer, key_line, start);
    if (node.IsMap()) return block_map(node, layer, indent + 2, "");
    const std::string dash(static_cast<std::size_t>(indent) + 2, ' ');
    for (const auto& one : node) element(one, layer, dash, indent + 2);
  }

  void element(const YAML::Node& one, std::size_t layer, const std::string& dash, int indent) {
    if (const auto flow = on_one_line(one))
      line(layer, line_in(one), dash + "- " + *flow);
    else if (one.IsMap())
      block_map(one, layer, indent + 2, dash + "- ");
    else
      node(one, layer, line_in(one), dash + "-", indent);
  }

  void block_map(const YAML::Node& map, std::size_t layer, int indent, std::string start) {
    for (const auto& entry : map) {
      if (start.empty()) start = std::string(static_cast<std::size_t>(indent), ' ');
      node(entry.second, layer, line_in(entry.first), start + yaml_scalar(entry.first.Scalar()) + ":", indent);
      start.clear();
    }
  }

  // Returns the text of a value that is a scalar, empty, or on one line of its own file; else none.
  static std::optional<std::string> on_one_line(const YAML::Node& node) {
    if (node.IsNull()) return "~";
    if (node.IsScalar()) return yaml_scalar(node.Scalar());
    if (node.size() > 0 && (node.Style() != YAML::EmitterStyle::Flow || !ends_on(node, line_in(node))))
      return std::nullopt;
    return flow(node);
  }
  static bool ends_on(const YAML::Node& node, int line) {
    if (line_in(node) != line) return false;
    if (node.IsMap())
      return std::all_of(node.begin(), node.end(), [&](const auto& one) { return ends_on(one.second, line); });
    return !node.IsSequence() ||
           std::all_of(node.begin(), node.end(), [&](const auto& one) { return ends_on(one, line); });
  }
  static std::string flow(const YAML::Node& node) {
    if (node.IsNull()) return "~";
    if (node.IsScalar()) return yaml_scalar(node.Scalar());
    std::string text;
    if (node.IsMap())
      for (const auto& one : node)
        text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", yaml_scalar(one.first.Scalar()), flow(one.second));
    else
      for (const auto& one : node) text += (text.empty() ? "" : ", ") + flow(one);
    return node.IsMap() ? "{" + text + "}" : "[" + text + "]";
  }

  std::string text_;
  TextOrigins origins_;
};

}  // namespace

std::string yaml_scalar(const std::string& text) {
  const auto harmless = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' || c == '/' || c == '+';
  };
  const auto begins = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '/';
  };
  const bool number = text.size() > 1 && text[0] == '-' && std::isdigit(static_cast<unsigned char>(text[1])) != 0;
  const bool plain = !text.empty() && (begins(text.front()) || number) && text.back() != ' ' &&
                     std::all_of(text.begin(), text.end(), [&](char c) { return c == ' ' || harmless(c); });
  if (plain && text != "null" && text != "Null" && text != "NULL") return text;
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

MergedYaml merge_yaml(const std::vector<YamlLayer>& layers, std::string_view left_out) {
  TTF_CHECK(!layers.empty(), "nothing to merge");
  Item whole = Merger(layers).merge();
  std::erase_if(whole.entries, [&](const Entry& one) { return one.key == left_out; });
  std::vector<std::string> files;
  for (const YamlLayer& layer : layers) files.push_back(layer.name);
  Writer writer(std::move(files));
  writer.map(whole, 0);
  return writer.take();
}

}  // namespace ttf
