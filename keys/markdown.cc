#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "keys/render.h"
#include "keys/rows.h"
#include "keys/value_words.h"

namespace ttf::keys {
namespace {

// One table: the keys of the file itself, or of one of its keys with all within it.
struct Section {
  std::string top;  // empty: the file itself
  std::vector<const Row*> rows;
};

// A key of the file with more keys within it than this is several tables: one for each key right within it.
constexpr std::ptrdiff_t kMostRows = 240;

// The key of the file that a path begins with.
std::string top_of(const std::string& path) { return path.substr(0, path.find_first_of(".[")); }
// The first two keys of a path.
std::string second_of(const std::string& path) {
  const std::size_t first = path.find('.');
  return first == std::string::npos ? path : path.substr(0, path.find_first_of(".[", first + 1));
}

std::vector<Section> sections_of(const std::vector<Row>& rows) {
  std::vector<Section> sections(1);
  for (const Row& row : rows) {
    std::string top = top_of(row.path);
    const auto within = [&](const Row& other) { return top_of(other.path) == top; };
    if (row.path != top && std::count_if(rows.begin(), rows.end(), within) > kMostRows &&
        second_of(row.path) != row.path)
      top = second_of(row.path);
    if (row.path == top) {
      sections.front().rows.push_back(&row);
      continue;
    }
    auto section =
        std::find_if(sections.begin() + 1, sections.end(), [&](const Section& one) { return one.top == top; });
    if (section == sections.end()) section = sections.insert(sections.end(), {top, {}});
    section->rows.push_back(&row);
  }
  return sections;
}

// As a cell of a table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string row_text(const Section& section, const Row& row) {
  const std::string_view name = std::string_view(row.path).substr(section.top.size());
  std::string meaning = row.description != nullptr ? std::string(row.description->meaning) : "";
  if (!row.only_with.empty()) meaning += fmt::format(" Only {}.", row.only_with);
  std::string need = need_words(row.key, row.may_be_alike, "`");
  if (row.description != nullptr && !row.description->example.empty())
    need += fmt::format("{}as `{}`", need.empty() ? "" : ", ", row.description->example);
  return fmt::format("| `{}` | {} | {} | {} |\n", name.starts_with('.') ? name.substr(1) : name, cell(meaning),
                     cell(value_words(row.key, "`")), cell(need));
}

std::string section_text(const Section& section) {
  std::string text = "| key | meaning | value | default, or example |\n|---|---|---|---|\n";
  for (const Row* row : section.rows) text += row_text(section, *row);
  return text;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string written_by(const Document& document) {
  return fmt::format("<!-- Written by `ttfusion keys {} --format markdown`. Meanings: keys/describe_*.cc. -->\n",
                     document.kind);
}

std::string own_page(const Document& document, const Section& section) {
  return fmt::format("# `{}` of a {} file\n\n{}\nAll keys of the file: [{}]({}.md). Paths are below `{}`.\n\n{}",
                     section.top, document.kind, written_by(document), document.kind, document.kind, section.top,
                     section_text(section));
}

std::string file_of(const Document& document, const Section& section) {
  std::string top = section.top;
  std::replace(top.begin(), top.end(), '.', '_');
  return fmt::format("{}_{}.md", document.kind, top);
}

std::string first_page(const Document& document, const std::vector<Section>& sections,
                       const std::vector<const Section*>& apart) {
  std::string text = fmt::format(
      "# {}: every key\n\n{}\n{} The program refuses any other key by its name. `[]` stands for each entry "
      "of a "
      "list, `NAME` for any name.\n\n## The file\n\n",
      document.title, written_by(document), document.about);
  for (const Section& section : sections) {
    if (!section.top.empty()) text += fmt::format("\n## `{}`\n\n", section.top);
    const bool elsewhere = std::find(apart.begin(), apart.end(), &section) != apart.end();
    text += elsewhere ? fmt::format("[{} keys on a page of their own]({}).\n", section.rows.size(),
                                    file_of(document, section))
                      : section_text(section);
  }
  return text;
}

}  // namespace

std::vector<Page> markdown_pages(const Document& document, const Outline& outline) {
  const std::vector<Row> rows = rows_of(document, outline);
  const std::vector<Section> sections = sections_of(rows);
  std::vector<const Section*> by_size;
  for (const Section& section : sections)
    if (!section.top.empty()) by_size.push_back(&section);
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const Section* a, const Section* b) { return a->rows.size() > b->rows.size(); });
  std::vector<const Section*> apart;
  std::string first = first_page(document, sections, apart);
  for (const Section* largest : by_size) {
    if (lines(first) <= kMostLines) break;
    apart.push_back(largest);
    first = first_page(document, sections, apart);
  }
  std::vector<Page> pages{{document.kind + ".md", std::move(first)}};
  for (const Section* section : apart) pages.push_back({file_of(document, *section), own_page(document, *section)});
  return pages;
}

std::string text_of(const Document& document, const Outline& outline) {
  std::string text = fmt::format("{}\n{}\n", document.title, document.about);
  for (const Row& row : rows_of(document, outline)) {
    const std::string need = need_words(row.key, row.may_be_alike, "");
    text += fmt::format("\n{}: {}{}{}\n", row.path, value_words(row.key, ""), need.empty() ? "" : ", ", need);
    if (row.description == nullptr) continue;
    text += fmt::format("    {}\n", row.description->meaning);
    if (!row.only_with.empty()) text += fmt::format("    Only {}.\n", row.only_with);
    if (!row.description->example.empty()) text += fmt::format("    As in: {}\n", row.description->example);
  }
  return text;
}

}  // namespace ttf::keys
