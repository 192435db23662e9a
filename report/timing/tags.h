// What a timing diagram in a page tells the page's script (report/page/timing_drawing.js) with each thing that stands
// in time:
//
//   data-a, data-b   from when to when it is, true time in ms; without data-b it is an instant, and only moves
//   data-id          the list it is of: things of one list belong together
//   data-since       when that list was measured, ms: from then on it ages
//   data-beyond      it lasts longer than the diagram: data-b is not its end
//   data-label       a text: its width; shown where there is room for it (between a and b, or beside its neighbours)
//
// In pictures there are none: each is empty.
#pragma once

#include <fmt/format.h>

#include <string>

#include "core/time.h"
#include "report/drawing/names.h"
#include "report/drawing/svg.h"
#include "report/timing/diagram.h"

namespace ttf::report::timing {

class TimingTags {
 public:
  explicit TimingTags(TimingUse use) : on_(use == TimingUse::kPage) {}

  bool on() const { return on_; }
  std::string at(TrueTime a) const { return on_ ? fmt::format(" data-a=\"{}\"", ms(a)) : ""; }
  std::string span(TrueTime a, TrueTime b) const {
    return on_ ? fmt::format(" data-a=\"{}\" data-b=\"{}\"", ms(a), ms(b)) : "";
  }
  std::string list(SensorId sensor, std::uint32_t sequence) const {
    return on_ ? fmt::format(" data-id=\"{}:{}\"", index_of(sensor), sequence) : "";
  }
  std::string since(TrueTime measured) const { return on_ ? fmt::format(" data-since=\"{}\"", ms(measured)) : ""; }
  std::string beyond() const { return on_ ? " data-beyond=\"\"" : ""; }
  // A text that there is no room for as yet is there all the same.
  std::string label(double width, bool shown) const {
    return on_ ? fmt::format(" data-label=\"{}\"{}", drawing::number(width), shown ? "" : " display=\"none\"") : "";
  }

 private:
  // To 0.1 us, without what follows from it.
  static std::string ms(TrueTime t) {
    std::string text = fmt::format("{:.4f}", in_ms(t));
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
  }
  bool on_;
};

}  // namespace ttf::report::timing
