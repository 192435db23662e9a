// Laws of a report's page, for any input files.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/check.h"

namespace ttf::fuzz {

inline std::size_t count_of(std::string_view text, std::string_view word) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != text.npos; at += word.size()) ++count;
  return count;
}

// The text between the first `begin` and the next `end`.
inline std::string_view between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  TTF_CHECK(from != text.npos, "no {}", begin);
  const std::size_t to = text.find(end, from + begin.size());
  TTF_CHECK(to != text.npos, "no {}", end);
  return text.substr(from + begin.size(), to - from - begin.size());
}

// It is complete; no name contains markup or ends a script; its plots are data.
inline void check_page(std::string_view html) {
  TTF_CHECK(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>\n"), "no whole page");
  // The plots and seven scripts; with scenes, these and four more; with timing diagrams, their windows.
  const bool has_scenes = html.find("<script type=\"application/json\" id=\"scenes\">") != html.npos;
  const bool has_timings = html.find("<script type=\"application/json\" id=\"timings\">") != html.npos;
  const std::size_t scripts = (has_scenes ? 13 : 8) + (has_timings ? 1 : 0);
  TTF_CHECK(count_of(html, "</script") == scripts, "{} scripts end, not {}", count_of(html, "</script"), scripts);
  TTF_CHECK(count_of(html, "<main") == 1 && count_of(html, "</main>") == 1, "a name begins or ends the main part");
  const std::string_view main = between(html, "<main id=\"main\">", "</main>");
  for (const char* tag : {"<script", "<img", "<style", "<!--", "<a "})
    TTF_CHECK(main.find(tag) == main.npos, "{} in the page", tag);
  TTF_CHECK(count_of(main, "<section") == count_of(main, "</section>"), "sections that do not end");
  TTF_CHECK(std::ranges::none_of(main, [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t' && c != '\r'; }),
            "a control character");
  const std::string_view plots = between(html, "<script type=\"application/json\" id=\"plots\">", "</script>");
  TTF_CHECK(nlohmann::json::parse(plots, nullptr, false).is_array(), "plots are no data: {}", plots.substr(0, 80));
}

}  // namespace ttf::fuzz
