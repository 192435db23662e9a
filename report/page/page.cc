#include "report/page/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "report/drawing/svg.h"
#include "report/page/assets.h"

namespace ttf::report::page {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRoomyColumns = 7;  // tables with more are set closer

// Cells to align right: "12.5", "-", "0.11 ± 0.02", "+3 less", "36 / 0 / 0".
bool is_figure(std::string_view cell) {
  return cell.empty() || cell == "-" ||
         (cell.find_first_of("0123456789") <= 1 && cell.find_first_of("_:") == cell.npos);
}

// Seven digits are finer than a plot shows.
Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values)
    out.push_back(std::isfinite(value) ? Json(std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr))
                                       : Json(nullptr));
  return out;
}

Json curve_json(const Curve& curve) {
  Json json{{"label", curve.label}, {"colour", curve.colour}, {"x", numbers(curve.x)}, {"y", numbers(curve.y)}};
  if (!curve.low.empty()) {
    json["low"] = numbers(curve.low);
    json["high"] = numbers(curve.high);
  }
  return json;
}

// Returns data for a script element, without any text that could end the element or begin a comment.
std::string script_data(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

// Makes the picture's ids unique by a prefix, so that one page can hold several pictures.
std::string inlined(std::string_view svg, const std::string& prefix) {
  svg.remove_prefix(std::min(svg.find("<svg"), svg.size()));
  struct Mark {
    std::string_view text;
    std::size_t at;  // position of its next occurrence
  };
  Mark marks[] = {{" id=\"", 0}, {"url(#", 0}};
  for (Mark& mark : marks) mark.at = svg.find(mark.text);
  std::string out;
  out.reserve(svg.size() + svg.size() / 8);
  std::size_t copied = 0;
  while (true) {
    Mark& next = marks[0].at < marks[1].at ? marks[0] : marks[1];
    if (next.at == svg.npos) break;
    const std::size_t end = next.at + next.text.size();
    out.append(svg.substr(copied, end - copied)).append(prefix);
    copied = end;
    next.at = svg.find(next.text, end);
  }
  return out.append(svg.substr(copied));
}

}  // namespace

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-./,:=@+") == word.npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

Page::Page(std::string title, std::string kind) : title_(std::move(title)), kind_(std::move(kind)) {}

void Page::section(std::string_view heading) {
  if (!contents_.empty()) body_ += "</section>\n";
  contents_.push_back({fmt::format("section-{}", contents_.size() + 1), std::string(heading)});
  body_ += fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-h\"><h2 id=\"{0}-h\">{1}</h2>\n", contents_.back().id,
                       drawing::escape(heading));
}

void Page::lead(std::string_view text) { body_ += fmt::format("<p class=\"lead\">{}</p>\n", drawing::escape(text)); }
void Page::paragraph(std::string_view text) { body_ += fmt::format("<p>{}</p>\n", drawing::escape(text)); }

void Page::points(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& sentence : sentences) body_ += fmt::format("<li>{}</li>\n", drawing::escape(sentence));
  body_ += "</ul>\n";
}

void Page::facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  body_ += "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts)
    body_ += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", drawing::escape(name), drawing::escape(value));
  body_ += "</dl>\n";
}

void Page::table(const PageTable& table) {
  std::vector<bool> figures(table.header.size(), true);
  for (const auto& row : table.rows)
    for (std::size_t c = 1; c < row.size() && c < figures.size(); ++c) figures[c] = figures[c] && is_figure(row[c]);
  body_ += "<div class=\"table\" tabindex=\"0\" role=\"group\"";
  body_ += fmt::format(" aria-label=\"{}\"><table{}>", drawing::escape(table.caption),
                       table.header.size() > kMostRoomyColumns ? " class=\"many\"" : "");
  if (!table.caption.empty()) body_ += fmt::format("<caption>{}</caption>", drawing::escape(table.caption));
  body_ += "<thead>";
  if (!table.groups.empty()) body_ += "<tr class=\"groups\">";
  for (const auto& [heading, columns] : table.groups)
    body_ += heading.empty()
                 ? fmt::format("<td colspan=\"{}\"></td>", columns)
                 : fmt::format("<th scope=\"colgroup\" colspan=\"{}\">{}</th>", columns, drawing::escape(heading));
  if (!table.groups.empty()) body_ += "</tr>\n";
  body_ += "<tr>";
  for (std::size_t c = 0; c < table.header.size(); ++c)
    body_ += fmt::format("<th scope=\"col\"{}>{}</th>", c > 0 && figures[c] ? " class=\"n\"" : "",
                         drawing::escape(table.header[c]));
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      const std::string text = c < row.size() ? drawing::escape(row[c]) : "";
      // An indented row is a part of the row above it.
      if (c == 0)
        body_ += fmt::format("<th scope=\"row\"{}>{}</th>", text.starts_with("  ") ? " class=\"part\"" : "", text);
      else
        body_ += fmt::format("<td{}>{}</td>", figures[c] ? " class=\"n\"" : "", text);
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Page::plot(const Plot& plot) {
  const bool any = std::ranges::any_of(plot.views, [](const PlotView& view) { return !view.curves.empty(); });
  if (!any) return;
  static constexpr std::string_view kKinds[] = {"lines", "points", "steps"};
  Json json{{"heading", plot.heading},   {"x", plot.x},       {"kind", kKinds[static_cast<std::size_t>(plot.kind)]},
            {"log", plot.logarithmic_x}, {"zero", plot.zero}, {"views", Json::array()}};
  for (const PlotView& view : plot.views) {
    Json one{{"label", view.label}, {"y", view.y}, {"curves", Json::array()}};
    for (const Curve& curve : view.curves) one["curves"].push_back(curve_json(curve));
    json["views"].push_back(std::move(one));
  }
  body_ += fmt::format(
      "<figure class=\"plot\" data-plot=\"{}\"><figcaption><strong>{}</strong> {}</figcaption>"
      "<noscript><p>Plots need JavaScript, which is in this page.</p></noscript></figure>\n",
      plots_.size(), drawing::escape(plot.heading), drawing::escape(plot.caption));
  plots_.push_back(std::move(json));
}

void Page::picture(std::string_view svg, std::string_view caption) {
  body_ += fmt::format(
      "<figure class=\"picture\"><div class=\"paper\" tabindex=\"0\" role=\"img\" aria-label=\"{0}\">{1}"
      "</div><figcaption>{0}</figcaption></figure>\n",
      drawing::escape(caption), inlined(svg, fmt::format("p{}-", pictures_++)));
}

void Page::diagrams(std::vector<PageDiagram> diagrams, std::string_view caption) {
  if (diagrams.empty()) return;
  body_ += fmt::format("<figure class=\"timing\"><figcaption>{}</figcaption>\n", drawing::escape(caption));
  for (PageDiagram& diagram : diagrams) {
    const std::string ids = fmt::format("d{}-", diagrams_++);
    std::string windows;
    if (!diagram.windows.is_null()) {
      windows = fmt::format(" data-windows=\"{}\" data-ids=\"{}\"", timings_.size(), ids);
      timings_.push_back(std::move(diagram.windows));
    }
    body_ += fmt::format("<div class=\"diagram\" data-label=\"{}\"{}><div class=\"paper\">{}</div></div>\n",
                         drawing::escape(diagram.label), windows, inlined(diagram.svg, ids));
  }
  body_ += "</figure>\n";
}

void Page::scenes(std::vector<Json> scenes, std::string_view caption) {
  if (scenes.empty()) return;
  body_ += fmt::format(
      "<figure class=\"scenes\" data-first=\"{}\" data-count=\"{}\"><figcaption>{}</figcaption>"
      "<noscript><p>Scenes need JavaScript, which is in this page.</p></noscript></figure>\n",
      scenes_.size(), scenes.size(), drawing::escape(caption));
  for (Json& scene : scenes) scenes_.push_back(std::move(scene));
}

void Page::command(std::string_view words) {
  body_ += fmt::format("<pre class=\"command\" tabindex=\"0\"><code>{}</code></pre>\n", drawing::escape(words));
}

void Page::preformatted(std::string_view summary, std::string_view text) {
  body_ += fmt::format("<details><summary>{}</summary><pre tabindex=\"0\">{}</pre></details>\n",
                       drawing::escape(summary), drawing::escape(text));
}

void Page::open_details(std::string_view summary) {
  body_ += fmt::format("<details><summary>{}</summary>\n", drawing::escape(summary));
}
void Page::close_details() { body_ += "</details>\n"; }

std::string Page::html() const {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src 'unsafe-inline'; img-src data:\">"
      "<meta name=\"color-scheme\" content=\"light dark\"><link rel=\"icon\" "
      "href=\"data:,\"><title>{}</title>\n<style>",
      drawing::escape(title_));
  out += kUplotStyle;
  out += kStyle;
  out += fmt::format(
      "</style></head>\n<body>\n<a class=\"skip\" href=\"#main\">To the report</a>\n"
      "<header><p class=\"kind\">{}</p><h1>{}</h1></header>\n<nav aria-label=\"Contents\"><ol>",
      drawing::escape(kind_), drawing::escape(title_));
  for (const Entry& entry : contents_)
    out += fmt::format("<li><a href=\"#{}\">{}</a></li>", entry.id, drawing::escape(entry.heading));
  out += "</ol></nav>\n<main id=\"main\">\n" + body_ + (contents_.empty() ? "" : "</section>\n") + "</main>\n<footer>";
  out += fmt::format("<details><summary>Plots: uPlot, MIT licence</summary><pre>{}</pre></details></footer>\n",
                     drawing::escape(kUplotLicence));
  out += "<script type=\"application/json\" id=\"plots\">" + script_data(plots_) + "</script>\n";
  if (!timings_.empty())
    out += "<script type=\"application/json\" id=\"timings\">" + script_data(timings_) + "</script>\n";
  const auto add = [&out](std::string_view script) { out.append("<script>").append(script).append("</script>\n"); };
  for (const std::string_view script : {kUplot, kElementsScript, kInstantScript, kPlotsScript, kTimingDrawingScript,
                                        kTimingWindowsScript, kTimingScript})
    add(script);
  if (scenes_.empty()) return out + "</body></html>\n";
  out += "<script type=\"application/json\" id=\"scenes\">" + script_data(scenes_) + "</script>\n";
  for (const std::string_view script : {kSceneDataScript, kSceneDrawingScript, kSceneControlsScript, kSceneScript})
    add(script);
  return out + "</body></html>\n";
}

}  // namespace ttf::report::page
