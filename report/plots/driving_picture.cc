#include "report/plots/driving_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "recording/scene/geometry.h"
#include "report/drawing/axes.h"

namespace ttf::report::plots {
namespace {

constexpr double kNumbersRoom = 76, kPanelWidth = 860, kPanelHeight = 170, kBetween = 18;

double seconds(TrueTime at) { return 1e-9 * static_cast<double>(at.ns); }

// Truth comes some hundred times a second. A line does not cross a longer time without it.
constexpr double kUnseen_s = 0.1;

struct Series {
  const std::vector<drawing::Point>* points;
  std::string_view colour;
  bool marks;
  bool is_rare = false;  // a line that crosses any time
};
// How a warning's begin is drawn, by service.
struct WarningStyle {
  std::string_view words, colour, dash;
};
constexpr std::array<WarningStyle, recording::records::kWarningKinds> kWarningStyles{
    {{"collision warning begins", drawing::kPurple, "6 3"},
     {"emergency braking begins", drawing::kBlue, "2 2"},
     {"lane departure warning begins", drawing::kVermilion, "8 2 2 2"},
     {"blind spot warning begins, left", drawing::kGreen, "6 3"},
     {"blind spot warning begins, right", drawing::kOrange, "6 3"}}};

struct Panel {
  std::string_view label;
  std::vector<Series> series;
  bool from_zero = false;
  double least = 1.0;  // the axis shows at least so much
};

drawing::Extent extent_of(const Panel& panel) {
  drawing::Extent extent;
  if (panel.from_zero) extent.add(0.0);
  for (const Series& series : panel.series)
    for (const drawing::Point& p : *series.points) extent.add(p.y);
  return extent.padded(0.06, panel.least);
}

void draw(drawing::Svg& svg, const drawing::PlotFrame& frame, const Series& series) {
  if (series.marks) {
    for (const drawing::Point& p : *series.points)
      svg.marker(drawing::Marker::kCircle, frame.at(p.x, p.y), 2.5, {.fill = series.colour}, {}, "seen");
    return;
  }
  std::vector<drawing::Point> drawn;
  const auto draw_part = [&] {
    if (drawn.size() > 1) svg.polyline(drawn, {.stroke = series.colour, .width = 1.5}, false, {}, "truth");
    drawn.clear();
  };
  for (std::size_t i = 0; i < series.points->size(); ++i) {
    const drawing::Point& p = (*series.points)[i];
    if (i > 0 && !series.is_rare && p.x - (*series.points)[i - 1].x > kUnseen_s) draw_part();
    drawn.push_back(frame.at(p.x, p.y));
  }
  draw_part();
}

}  // namespace

void DrivingPicture::end_moment() {
  if (!ego_) return;
  const double at = seconds(ego_->at);
  speed_.push_back({at, ego_->vx});
  acceleration_.push_back({at, ego_->acceleration});
  if (options_.lane) {
    const PlaceInLane place = options_.lane(*ego_);
    offset_.push_back({at, place.offset});
    heading_.push_back({at, place.heading * 180.0 / std::numbers::pi});
  }
  if (ahead_ && ahead_->x <= 0.0 && !collided_at_) collided_at_ = at;
  if (ahead_ && !collided_at_) {
    gap_.push_back({at, ahead_->x});
    speed_ahead_.push_back({at, ahead_->y});
  }
  ego_.reset();
  ahead_.reset();
}

void DrivingPicture::on(const recording::records::EgoTruth& ego) {
  if (ego_ && ego_->at == ego.at) return;
  end_moment();
  if (shown(ego.at)) ego_ = ego;
}

void DrivingPicture::on(const recording::records::TruthState& object) {
  if (!ego_ || object.at != ego_->at) return;
  const std::optional<double> gap =
      recording::scene::gap_ahead(object, options_.front_m, options_.width_m, recording::scene::way_curvature(*ego_));
  if (gap && (!ahead_ || *gap < ahead_->x)) ahead_ = drawing::Point{*gap, object.speed * std::cos(object.heading)};
}

void DrivingPicture::on(const recording::records::CommandIssued& command) {
  const TrueTime at = command.stamp.true_time;
  // Emergency braking sees the same as cruise control, and lane keeping sees no gap.
  if (!shown(at) || !command.valid || command.reason == recording::records::CommandReason::kEmergency ||
      command.reason == recording::records::CommandReason::kLane)
    return;
  seen_speed_.push_back({seconds(at), command.own_speed});
  if (!std::isfinite(command.gap)) return;
  seen_gap_.push_back({seconds(at), command.gap});
  seen_ahead_.push_back({seconds(at), command.speed_ahead});
}

void DrivingPicture::on(const recording::records::CommandTaken& taken) {
  if (shown(taken.stamp.true_time) && taken.verdict == recording::records::CommandVerdict::kApplied)
    asked_.push_back({seconds(taken.from), taken.acceleration});
}

void DrivingPicture::on(const recording::records::PlanMade& plan) {
  const double at = seconds(plan.stamp.true_time);
  if (!shown(plan.stamp.true_time) || plan.track == kNoTrack) return;
  seen_gap_.push_back({at, plan.gap});
  seen_ahead_.push_back({at, plan.speed_ahead});
}

void DrivingPicture::on(const recording::records::SequencePlanned& planned) {
  const TrueTime at = planned.stamp.true_time;
  if (planned_at_ && shown(at)) sequence_.push_back({seconds(at), (at - *planned_at_).seconds()});
  if (shown(at)) bound_.push_back({seconds(at), planned.bound.seconds()});
  planned_at_ = at;
}

void DrivingPicture::on(const recording::records::Warning& warning) {
  if (warning.on && index_of(warning.service) < kWarningStyles.size() && shown(warning.stamp.true_time))
    warnings_.emplace_back(seconds(warning.stamp.true_time), index_of(warning.service));
}

std::string DrivingPicture::svg(const drawing::Sheet& sheet) const {
  if (speed_.empty()) return drawing::empty_picture(options_.title, "No commands drove the vehicle.", sheet);
  std::vector<Panel> panels{
      {"gap [m]", {{&seen_gap_, drawing::kSkyBlue, true}, {&gap_, drawing::kBlack, false}}, true},
      {"speed [m/s]",
       {{&seen_ahead_, drawing::kOrange, true},
        {&seen_speed_, drawing::kSkyBlue, true},
        {&speed_ahead_, drawing::kVermilion, false},
        {&speed_, drawing::kBlack, false}},
       true},
      {"acceleration [m/s^2]", {{&asked_, drawing::kGreen, true}, {&acceleration_, drawing::kBlack, false}}}};
  if (!offset_.empty()) {
    panels.push_back({"offset in lane [m]", {{&offset_, drawing::kBlack, false}}});
    panels.push_back({"heading in lane [deg]", {{&heading_, drawing::kBlack, false}}});
  }
  if (!sequence_.empty())
    panels.push_back(
        {"sequence [s]", {{&sequence_, drawing::kPurple, true}, {&bound_, drawing::kBlack, false, true}}, true, 0.1});
  using Kind = drawing::LegendEntry::Kind;
  std::vector<drawing::LegendEntry> legend{
      {Kind::kLine, "the vehicle, true", std::string(drawing::kBlack)},
      {Kind::kLine, "the object ahead, true", std::string(drawing::kVermilion)},
      {Kind::kMarker, "gap and own speed, as seen", std::string(drawing::kSkyBlue), drawing::Marker::kCircle, true},
      {Kind::kMarker, "object's speed, as seen", std::string(drawing::kOrange), drawing::Marker::kCircle, true},
      {Kind::kMarker, "acceleration asked for", std::string(drawing::kGreen), drawing::Marker::kCircle, true}};
  for (std::size_t service = 0; service < kWarningStyles.size(); ++service) {
    if (std::ranges::find(warnings_, service, &std::pair<double, std::size_t>::second) == warnings_.end()) continue;
    const WarningStyle& style = kWarningStyles[service];
    legend.push_back(
        {Kind::kLine, std::string(style.words), std::string(style.colour), {}, false, std::string(style.dash)});
  }
  if (collided_at_) legend.push_back({Kind::kLine, "collision", std::string(drawing::kVermilion)});
  if (!sequence_.empty()) {
    legend.push_back({Kind::kMarker, "length of a sequence of detections", std::string(drawing::kPurple),
                      drawing::Marker::kCircle, true});
    legend.push_back({Kind::kLine, "its bound", std::string(drawing::kBlack)});
  }
  const double width = sheet.plot_width(kPanelWidth, kNumbersRoom + 28), top = 34 + legend_height(legend, width) + 10;
  drawing::Extent time;
  time.add(seconds(options_.from));
  time.add(seconds(options_.to));
  drawing::Svg svg(kNumbersRoom + width + 28, top + static_cast<double>(panels.size()) * (kPanelHeight + kBetween) + 40,
                   options_.title, sheet);
  svg.text({24, 22}, options_.title, {.size = 14, .bold = true});
  draw_legend(svg, {24, 34}, width, legend);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const drawing::Area area{kNumbersRoom, top + static_cast<double>(i) * (kPanelHeight + kBetween), width,
                             kPanelHeight};
    const drawing::PlotFrame frame(area, time, extent_of(panels[i]));
    frame.draw(svg, i + 1 == panels.size() ? "true time [s]" : "", panels[i].label);
    svg.open_group("driving", area);
    for (const auto& [at, service] : warnings_) {
      const double x = frame.at(at, frame.y_extent().low).x;
      const WarningStyle& style = kWarningStyles[service];
      svg.line({x, area.y}, {x, area.y + area.height}, {.stroke = style.colour, .dash = style.dash}, "warning");
    }
    if (collided_at_) {
      const double x = frame.at(*collided_at_, frame.y_extent().low).x;
      svg.line({x, area.y}, {x, area.y + area.height}, {.stroke = drawing::kVermilion, .width = 2}, "collision");
    }
    for (const Series& series : panels[i].series) draw(svg, frame, series);
    svg.close_group();
  }
  return svg.str();
}

}  // namespace ttf::report::plots
