// The attributes by which a timing diagram informs its page's script (report/page/timing_drawing.js) about
// each timed part:
//
//   data-a, data-b   its begin and end, true time in ms; a part without data-b is an instant, and only moves
//   data-id          its list: parts of one list belong together
//   data-since       when that list was measured, ms: it ages from then on
//   data-beyond      it lasts longer than the diagram: data-b is not its end
//   data-label       the width of a text, which is shown if it has room (between a and b, or beside its neighbours)
//
// Pictures outside a page have no attributes: every function returns "".
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
  // A text that has no room yet is present but hidden.
  std::string label(double width, bool shown) const {
    return on_ ? fmt::format(" data-label=\"{}\"{}", drawing::number(width), shown ? "" : " display=\"none\"") : "";
  }

 private:
  // Returns ms rounded to 0.1 us, without trailing zeros.
  static std::string ms(TrueTime t) {
    std::string text = fmt::format("{:.4f}", in_ms(t));
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
  }
  bool on_;
};

}  // namespace ttf::report::timing
