#include "report/page/index_page.h"

#include <fmt/format.h>

#include <fstream>

#include "report/drawing/svg.h"

namespace ttf::report::page {
namespace {

constexpr std::string_view kStyle =
    "body{font-family:'DejaVu Sans',sans-serif;max-width:1500px;margin:2em auto;padding:0 1em;color:#111}"
    "h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}img{max-width:100%;border:1px solid #ddd}"
    "pre{background:#f6f6f6;padding:.8em;overflow-x:auto;font-family:'DejaVu Sans "
    "Mono',monospace;font-size:.85em}"
    "p.caption{color:#333;max-width:70em}";

// Returns a file name as a relative URL.
std::string url(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    const bool plain = (u >= '0' && u <= '9') || (u >= 'A' && u <= 'Z') || (u >= 'a' && u <= 'z') || c == '-' ||
                       c == '_' || c == '.' || c == '/' || c == '~';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", u);
  }
  return out;
}

}  // namespace

std::string index_html(std::string_view title, std::span<const IndexEntry> entries) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\"/><title>{0}</title><style>{1}</style></head>\n"
      "<body><h1>{0}</h1>\n",
      drawing::escape(title), kStyle);
  for (const IndexEntry& e : entries) {
    if (!e.heading.empty()) out += fmt::format("<h2>{}</h2>\n", drawing::escape(e.heading));
    if (!e.picture.empty())
      out += fmt::format("<a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"/></a>\n", url(e.picture),
                         drawing::escape(e.heading.empty() ? e.picture : e.heading));
    if (!e.caption.empty()) out += fmt::format("<p class=\"caption\">{}</p>\n", drawing::escape(e.caption));
    if (!e.preformatted.empty()) out += fmt::format("<pre>{}</pre>\n", drawing::escape(e.preformatted));
    if (!e.more.empty()) {
      out += "<p>";
      for (std::size_t i = 0; i < e.more.size(); ++i)
        out += fmt::format("{}<a href=\"{}\">{}</a>", i > 0 ? " · " : "", url(e.more[i]), drawing::escape(e.more[i]));
      out += "</p>\n";
    }
  }
  if (entries.empty()) out += "<p>Nothing to show.</p>\n";
  return out + "</body></html>\n";
}

void write_index(const std::string& dir, std::string_view title, std::span<const IndexEntry> entries) {
  const std::string path = dir + "/index.html";
  std::ofstream out(path, std::ios::binary);
  out << index_html(title, entries);
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace ttf::report::page
