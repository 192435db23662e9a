#include "core/yaml_document.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <sstream>
#include <string_view>

#include "core/errors.h"

namespace ttf {
namespace {

// YAML allows tabs and line ends, but no other control character. The parser takes some of them for the end of
// the file and skips the rest. Throws InputError at the first one.
void check_characters(const std::string& text, const std::string& name) {
  int line = 1;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if ((code < 0x20 && c != '\t' && c != '\n' && c != '\r') || code == 0x7f)
      throw InputError({name, line, "", fmt::format("byte {:#04x}", code), "must not be in a YAML text"});
    if (c == '\n') ++line;
  }
}

// Notes the line where a document begins, and builds no nodes.
struct DocumentStart final : YAML::EventHandler {
  int line = 0;  // the last one's; 0 before the first
  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// YAML::Load reads the first document only. YAML::LoadAll reads all, but loops forever on some empty documents, such
// as a tag without a value.
void check_one_document(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStart start;
  if (parser.HandleNextDocument(start) && parser.HandleNextDocument(start))
    throw InputError({name, start.line, "", "", "must be one YAML document: another one begins here"});
}

// Whether the text is one document if it is a mapping: its first key begins a line, and no line has a mark of documents.
// The mapping then ends with the text. All other texts are read once more, to see whether more follows.
bool is_surely_one_mapping(const std::string& text) {
  if (text.find('\r') != std::string::npos) return false;  // the parser's lines may be others
  bool first = true;                                       // no key has been seen
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = std::string_view(text).substr(at);
    if (rest.starts_with("---") || rest.starts_with("...") || rest.starts_with('%')) return false;
    const char begin = rest.front();
    if (first && begin != '#' && begin != '\n') {
      if (!((begin >= 'a' && begin <= 'z') || (begin >= 'A' && begin <= 'Z'))) return false;
      first = false;
    }
    const std::size_t end = text.find('\n', at);
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return !first;
}

}  // namespace

YAML::Node parse_document(const std::string& text, const std::string& name) {
  check_characters(text, name);
  try {
    YAML::Node root = YAML::Load(text);
    if (!root.IsMap() || !is_surely_one_mapping(text)) check_one_document(text, name);
    return root;
  } catch (const YAML::Exception& error) {
    throw InputError({name, error.mark.line + 1, "", "", "is not valid YAML: " + error.msg});
  }
}

}  // namespace ttf
