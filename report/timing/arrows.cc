#include <fmt/format.h>

#include "report/drawing/axes.h"
#include "report/timing/canvas.h"

namespace ttf::report::timing {

double lane_height(const Lane& lane) {
  switch (lane.key.kind) {
    case LaneKey::Kind::kSensor: return 28;
    case LaneKey::Kind::kChannel: return 40;
    case LaneKey::Kind::kCan:
    case LaneKey::Kind::kTask: break;
  }
  return 30;
}

std::string TimingCanvas::times(TrueTime start, TrueTime end) const {
  return tags.on() ? "" : fmt::format(", {} ms to {} ms", drawing::number(in_ms(start)), drawing::number(in_ms(end)));
}

void draw_way(drawing::Svg& svg, const TimingCanvas& canvas, const Way& way) {
  constexpr double kBox = TimingCanvas::kBox;
  const bool image = way.id.sensor == kNoSensor;
  const std::string colour = image ? std::string(drawing::kBlack) : sensor_colour(canvas.names, way.id.sensor);
  const std::string hover = image ? fmt::format("image #{}", way.id.sequence)
                                  : fmt::format("{} #{}{}", canvas.names.sensor(way.id.sensor), way.id.sequence,
                                                way.out_of_sequence ? ", out of sequence" : "");
  for (const Leg& leg : way.legs) {
    if (!canvas.visible(leg.from.at, leg.to.at)) continue;
    svg.tag_next(canvas.tags.span(leg.from.at, leg.to.at) + canvas.tags.list(way.id.sensor, way.id.sequence) +
                 canvas.tags.since(way.legs.front().from.at));
    if (leg.kind == Leg::Kind::kStored) {
      svg.arrow({canvas.x(leg.from.at), canvas.y(leg.from.lane)}, {canvas.x(leg.to.at), canvas.y(leg.to.lane)},
                {.stroke = colour}, hover, "arrow image");
      continue;
    }
    const bool same = leg.from.lane == leg.to.lane;
    const double a = canvas.y(leg.from.lane), b = canvas.y(leg.to.lane), down = same ? 0 : b > a ? 1 : -1;
    const auto edge = [&](const LaneKey& lane) { return lane.kind == LaneKey::Kind::kSensor ? 5.0 : kBox / 2; };
    const auto shift = [](const LaneKey& lane) { return lane.kind == LaneKey::Kind::kChannel ? 4.0 : 0.0; };
    const drawing::Point p{canvas.x(leg.from.at),
                           a + shift(leg.from.lane) + (same ? kBox / 2 + 3 : down * edge(leg.from.lane))};
    const drawing::Point q{canvas.x(leg.to.at),
                           b + shift(leg.to.lane) + (same ? kBox / 2 + 3 : -down * edge(leg.to.lane))};
    svg.arrow(p, q,
              {.stroke = colour,
               .width = way.out_of_sequence ? 2.0
                        : image             ? 1.0
                                            : 1.2,
               .dash = leg.kind == Leg::Kind::kHeld ? "1.5 2.5"
                       : way.out_of_sequence        ? "5 3"
                                                    : ""},
              hover,
              image                 ? "arrow image"
              : way.out_of_sequence ? "arrow late"
                                    : "arrow");
  }
}

}  // namespace ttf::report::timing
