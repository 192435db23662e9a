// Lays out the panels of report/plots/position_plot.h.
#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "report/plots/crowd_panel.h"
#include "report/plots/position_panel.h"

namespace ttf::report::plots {
namespace {

using Selection = PositionPlots::Selection;
using Crowd = PositionPlots::Crowd;

constexpr double kLeft = 70, kBelow = 68;                 // the room for the numbers beside and below a panel
constexpr double kLeastHeight = 100, kLeastBeside = 110;  // a panel on paper, and its width beside another
constexpr std::string_view kNoPositions = "There are no positions in this window.";
constexpr std::string_view kCaption =
    "Axes follow ISO 8855 (x forward, y to the left of the sensor vehicle); the paper draws y forward and x "
    "sideways.";

std::string scale_note(const Extents& e, const drawing::Area& area) {
  const double ratio = (area.width / e.x.size()) / (area.height / e.y.size());
  return std::abs(ratio - 1) < 0.02 ? "Both axes have the same scale." : "The axes have different scales.";
}

// The panels of a picture. If a drive has several objects, all panels show all objects.
class Panels {
 public:
  explicit Panels(std::span<const PositionPlots* const> plots)
      : plots_(plots), several_(std::ranges::any_of(plots, [](const PositionPlots* p) { return p->several(); })) {
    for (const PositionPlots* p : plots) {
      if (several_)
        crowds_.push_back(p->crowd());
      else
        ones_.push_back(p->select());
    }
  }
  bool empty() const {
    return !several_ && std::ranges::all_of(ones_, [](const Selection& s) { return s.empty(); });
  }
  Extents extents(PositionView view) const { return several_ ? extents_of(crowds_, view) : extents_of(ones_, view); }
  std::vector<drawing::LegendEntry> legend() const {
    return several_ ? legend_of(crowds_) : legend_of(ones_, plots_.front()->names());
  }
  std::string caption() const { return std::string(kCaption) + (several_ ? " " + words_of(crowds_) : ""); }
  void draw(drawing::Svg& svg, const drawing::PlotFrame& frame, std::size_t i, PositionView view, bool with_x,
            bool numbers, const drawing::Sheet& sheet) const {
    if (several_)
      draw_panel(svg, frame, crowds_[i], view, with_x, sheet);
    else
      draw_panel(svg, frame, ones_[i], plots_[i]->names(), view, with_x, numbers, sheet);
  }

 private:
  std::span<const PositionPlots* const> plots_;
  bool several_;
  std::vector<Selection> ones_;
  std::vector<Crowd> crowds_;
};

// The words above and below the panels, beginning with the title.
struct Words {
  double left = kLeft, width = 0;
  std::vector<std::string> title, caption;
  std::vector<drawing::LegendEntry> legend;
  double legend_top = 0, top = 0;  // where the legend begins and ends

  // `panels` is the width of the panels without the numbers left of the first.
  Words(const std::string& title_text, const std::string& caption_text, std::vector<drawing::LegendEntry> entries,
        double panels, const drawing::Sheet& sheet)
      : legend(std::move(entries)) {
    if (sheet.on_paper()) left = 10;
    width = kLeft + panels - left;
    if (!title_text.empty()) title = drawing::broken(title_text, sheet.text(14), sheet.line(width), true);
    caption = drawing::broken(caption_text, sheet.text(10), sheet.line(width));
    legend_top = title.empty() ? 10 : 22 + drawing::kLineHeight * static_cast<double>(title.size());
    top = legend_top + legend_height(legend, width);
  }
  double caption_height() const { return drawing::kLineHeight * static_cast<double>(caption.size() - 1); }
  void draw(drawing::Svg& svg, double below) const {
    svg.lines({left + width / 2, 22}, title, {.size = 14, .anchor = drawing::Anchor::kMiddle, .bold = true});
    draw_legend(svg, {left, legend_top}, width, legend);
    svg.lines({left, below}, caption, {.size = 10, .fill = "#444444"});
  }
};

}  // namespace

std::string PositionPlots::over_time_svg(const drawing::Sheet& sheet) const {
  const PositionPlots* const self = this;
  const Panels panels({&self, 1});
  const std::string title = options_.title.empty() ? "Position over time" : options_.title;
  if (panels.empty()) return drawing::empty_picture(title, kNoPositions, sheet);
  const double width = sheet.plot_width(1120, kLeft + 20);
  const double height = sheet.on_paper() ? std::max(kLeastHeight, 0.5 * width) : 330;
  const Words words(title, panels.caption(), panels.legend(), width, sheet);
  const double top = words.top + 8 + kStrip;
  drawing::Svg svg(kLeft + width + 20, top + 2 * height + 28 + kBelow + words.caption_height(), title, sheet);
  words.draw(svg, top + 2 * height + 28 + 60);
  double y = top;
  for (const PositionView view : {PositionView::kXOverTime, PositionView::kYOverTime}) {
    const Extents e = panels.extents(view);
    const bool last = view == PositionView::kYOverTime;
    panels.draw(svg, drawing::PlotFrame({kLeft, y, width, height}, e.x, e.y), 0, view, last, !last, sheet);
    y += height + 28;
  }
  return svg.str();
}

std::string PositionPlots::plane_svg(const drawing::Sheet& sheet) const {
  const PositionPlots* const self = this;
  const std::vector<std::string> titles{""};
  return comparison_svg({&self, 1}, titles, PositionView::kPlane,
                        options_.title.empty() ? "Position in the plane" : options_.title, sheet);
}

std::string comparison_svg(std::span<const PositionPlots* const> plots, std::span<const std::string> titles,
                           PositionView view, std::string_view title, const drawing::Sheet& sheet) {
  TTF_CHECK(plots.size() == titles.size(), "{} panels and {} titles", plots.size(), titles.size());
  const Panels panels(plots);
  if (panels.empty()) return drawing::empty_picture(title.empty() ? "Positions" : title, kNoPositions, sheet);
  const Extents e = panels.extents(view);
  // On paper, panels that would be narrow stand below each other.
  std::size_t columns = plots.size();
  while (sheet.on_paper() && columns > 1 &&
         (sheet.width(0) - 16) / static_cast<double>(columns) < kLeft + 10 + kLeastBeside)
    --columns;
  const double n = static_cast<double>(columns);
  const double width = sheet.on_paper()    ? (sheet.plot_width(0, kLeft + 26) + kLeft + 10) / n - kLeft - 10
                       : plots.size() == 1 ? 1120
                                           : std::max(460.0, 1320 / n - 40);
  double height = sheet.on_paper() ? std::max(kLeastHeight, 0.6 * width) : plots.size() == 1 ? 560 : 430;
  if (!over_time(view)) {
    // Both axes have the same scale if that leaves room for the narrower one.
    const double equal = width * e.y.size() / e.x.size();
    if (equal >= 0.3 * width && equal <= 1.3 * width) height = equal;
  }
  const double panel = width + kLeft + 10, total = panel * n;
  std::string caption = panels.caption();
  if (!over_time(view)) caption += " " + scale_note(e, {0, 0, width, height});
  const Words words(std::string(title), caption, panels.legend(), total - kLeft, sheet);
  const bool headed = std::ranges::any_of(titles, [](const std::string& t) { return !t.empty(); });
  const double strip = over_time(view) ? kStrip : 0, head = (headed ? 30 : 8) + strip;
  const double row = head + height + 42;
  const double below = words.top + row * static_cast<double>((plots.size() + columns - 1) / columns);
  drawing::Svg svg(total + 16, below + kBelow - 42 + words.caption_height(), title.empty() ? "Comparison" : title,
                   sheet);
  words.draw(svg, below + 18);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const drawing::Area area{kLeft + static_cast<double>(i % columns) * panel,
                             words.top + row * static_cast<double>(i / columns) + head, width, height};
    if (!titles[i].empty())
      svg.text({area.x + width / 2, area.y - 8 - strip}, titles[i],
               {.size = 12.5, .anchor = drawing::Anchor::kMiddle, .bold = true});
    panels.draw(svg, drawing::PlotFrame(area, e.x, e.y), i, view, true, true, sheet);
  }
  return svg.str();
}

}  // namespace ttf::report::plots
