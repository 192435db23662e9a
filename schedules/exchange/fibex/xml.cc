#include "schedules/exchange/fibex/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/file_bytes.h"

namespace ttf::schedules::exchange::fibex {

struct XmlElement::Content {
  std::string file;
  std::vector<std::ptrdiff_t> line_starts;
  std::map<std::string, std::string, std::less<>> prefixes;  // the file's prefix -> ours
  pugi::xml_document document;

  int line_at(std::ptrdiff_t offset) const {
    const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
    return static_cast<int>(after - line_starts.begin());
  }
  std::string canonical(std::string_view name) const {
    const auto colon = name.find(':');
    const std::string_view prefix = colon == std::string_view::npos ? std::string_view{} : name.substr(0, colon);
    const std::string_view local = colon == std::string_view::npos ? name : name.substr(colon + 1);
    const auto found = prefixes.find(prefix);
    return found == prefixes.end() ? std::string(name) : fmt::format("{}:{}", found->second, local);
  }
  // An attribute without a prefix is in no namespace, not even the default one.
  std::string attribute_name(std::string_view name) const {
    return name.find(':') == std::string_view::npos ? std::string(name) : canonical(name);
  }
};

namespace {

constexpr std::string_view kSpace = " \t\r\n";

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kSpace) - first + 1));
}

bool is_text(const pugi::xml_node& node) { return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata; }

// Returns the offset of the first character other than space.
std::ptrdiff_t text_offset(const pugi::xml_node& node) {
  const auto first = std::string_view(node.value()).find_first_not_of(kSpace);
  return node.offset_debug() + static_cast<std::ptrdiff_t>(first == std::string_view::npos ? 0 : first);
}

// Returns the length of the first UTF-8 character, 0 if it is invalid: RFC 3629, table 3-7 of the Unicode
// standard.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if ((first & 0xf0) == 0xe0) {
    const bool overlong = first == 0xe0 && byte(1) < 0xa0;
    const bool surrogate = first == 0xed && byte(1) >= 0xa0;
    return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const bool overlong = first == 0xf0 && byte(1) < 0x90;
    const bool beyond = first == 0xf4 && byte(1) >= 0x90;
    return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
  }
  return 0;
}

// Returns the offset of the first invalid XML character in UTF-8. The parser would stop there or skip it.
std::size_t first_bad_character(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text.substr(at));
    const auto code = static_cast<unsigned char>(text[at]);
    if (length == 0 || code == 0x7f || (code < 0x20 && kSpace.find(text[at]) == std::string_view::npos)) return at;
    at += length;
  }
  return std::string_view::npos;
}

}  // namespace

XmlFile XmlFile::load(const std::string& path) { return parse(read_file(path), path); }

XmlFile XmlFile::parse(std::string text, std::string name) {
  auto content = std::make_shared<XmlElement::Content>();
  content->file = std::move(name);
  content->line_starts.push_back(0);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') content->line_starts.push_back(static_cast<std::ptrdiff_t>(i + 1));
  const auto damaged = [&](std::ptrdiff_t offset, std::string what) {
    return InputError(Finding{content->file, content->line_at(offset), "", "", std::move(what)});
  };
  if (const std::size_t bad = first_bad_character(text); bad != std::string_view::npos)
    throw damaged(static_cast<std::ptrdiff_t>(bad), "is not XML in UTF-8: a byte here is invalid");
  // Keeps the document type and text outside the root element, to report them.
  const unsigned how = pugi::parse_default | pugi::parse_doctype | pugi::parse_fragment;
  const auto result = content->document.load_buffer(text.data(), text.size(), how, pugi::encoding_utf8);
  if (!result) throw damaged(result.offset, fmt::format("is not well-formed XML: {}", result.description()));
  pugi::xml_node root;
  for (const pugi::xml_node& node : content->document.children()) {
    if (node.type() == pugi::node_doctype) throw damaged(node.offset_debug(), "has a document type; FIBEX has none");
    if (is_text(node)) throw damaged(text_offset(node), "is not well-formed XML: text outside the root element");
    if (node.type() != pugi::node_element) continue;
    if (root) throw damaged(node.offset_debug(), "is not well-formed XML: a second root element");
    root = node;
  }
  if (!root) throw damaged(0, "is not XML: it has no element");
  for (const pugi::xml_attribute& attribute : root.attributes()) {
    const std::string_view key = attribute.name();
    if (key != "xmlns" && !key.starts_with("xmlns:")) continue;
    for (const XmlNamespace& known : kFibexNamespaces)
      if (attribute.value() == known.name)
        content->prefixes[key == "xmlns" ? std::string() : std::string(key.substr(6))] = known.prefix;
  }
  XmlFile file;
  file.content_ = std::move(content);
  return file;
}

XmlElement XmlFile::root(Findings& left_out) const {
  pugi::xml_node root = content_->document.first_child();
  while (root.type() != pugi::node_element) root = root.next_sibling();
  return XmlElement(content_, root, &left_out);
}

const std::string& XmlFile::name() const { return content_->file; }

std::string XmlElement::name() const { return content_->canonical(node_.name()); }

std::string XmlElement::path() const {
  std::vector<std::string> names;
  for (pugi::xml_node node = node_; node.type() == pugi::node_element; node = node.parent())
    names.push_back(content_->canonical(node.name()));
  std::string path;
  for (auto one = names.rbegin(); one != names.rend(); ++one) path += (path.empty() ? "" : "/") + *one;
  return path;
}

int XmlElement::line() const { return content_->line_at(node_.offset_debug()); }

bool XmlElement::has(std::string_view wanted) const {
  for (const pugi::xml_node& node : node_.children())
    if (node.type() == pugi::node_element && content_->canonical(node.name()) == wanted) return true;
  return false;
}

std::vector<XmlElement> XmlElement::children(std::string_view wanted) {
  asked_.emplace_back(wanted);
  std::vector<XmlElement> found;
  for (const pugi::xml_node& node : node_.children())
    if (node.type() == pugi::node_element && content_->canonical(node.name()) == wanted)
      found.push_back(XmlElement(content_, node, left_out_));
  return found;
}

std::vector<XmlElement> XmlElement::elements() const {
  std::vector<XmlElement> found;
  for (const pugi::xml_node& node : node_.children())
    if (node.type() == pugi::node_element) found.push_back(XmlElement(content_, node, left_out_));
  return found;
}

std::optional<XmlElement> XmlElement::child(std::string_view wanted) {
  std::vector<XmlElement> found = children(wanted);
  if (found.empty()) return std::nullopt;
  for (std::size_t i = 1; i < found.size(); ++i) leave_out(found[i].path(), found[i].line());
  return std::move(found.front());
}

std::vector<XmlElement> XmlElement::children_of(std::string_view list, std::string_view wanted) {
  std::vector<XmlElement> found;
  for (XmlElement& one : children(list)) {
    for (XmlElement& item : one.children(wanted)) found.push_back(std::move(item));
    one.finish();
  }
  return found;
}

std::optional<std::string> XmlElement::text_of(std::string_view wanted) {
  auto found = child(wanted);
  if (!found) return std::nullopt;
  std::string text = found->text();
  found->finish();
  return text;
}

std::string XmlElement::reference(std::string_view wanted) {
  auto found = child(wanted);
  if (!found) return {};
  std::string id = found->attribute("ID-REF");
  found->finish();
  return id;
}

std::string XmlElement::text() {
  text_asked_ = true;
  std::string text;
  for (const pugi::xml_node& node : node_.children())
    if (is_text(node)) text += node.value();
  return trimmed(text);
}

std::string XmlElement::attribute(std::string_view wanted) {
  // Some tools omit the prefix of an attribute.
  const std::string_view local = wanted.substr(wanted.find(':') == std::string_view::npos ? 0 : wanted.find(':') + 1);
  for (const std::string_view name : {wanted, local}) asked_.push_back(fmt::format("@{}", name));
  for (const pugi::xml_attribute& attribute : node_.attributes()) {
    const std::string name = content_->attribute_name(attribute.name());
    if (name == wanted || name == local) return trimmed(attribute.value());
  }
  return {};
}

bool XmlElement::is_asked(std::string_view wanted) const {
  return std::find(asked_.begin(), asked_.end(), wanted) != asked_.end();
}

void XmlElement::leave_out(std::string path, int line) {
  left_out_->add({content_->file, line, std::move(path), "", "is not understood, and left out"});
}

void XmlElement::finish() {
  for (const pugi::xml_attribute& attribute : node_.attributes()) {
    const std::string_view raw = attribute.name();
    // IDs and types have no meaning beyond the attributes read.
    if (raw == "ID" || raw == "xmlns" || raw.starts_with("xmlns:")) continue;
    const std::string name = content_->attribute_name(raw);
    if (!name.starts_with("xsi:") && !is_asked("@" + name)) leave_out(path() + "/@" + name, line());
  }
  for (const pugi::xml_node& node : node_.children()) {
    const bool element = node.type() == pugi::node_element;
    if (element && !is_asked(content_->canonical(node.name())))
      leave_out(fmt::format("{}/{}", path(), content_->canonical(node.name())), content_->line_at(node.offset_debug()));
    if (is_text(node) && !text_asked_ && !trimmed(node.value()).empty())
      leave_out(path() + "/text()", content_->line_at(text_offset(node)));
  }
}

}  // namespace ttf::schedules::exchange::fibex
