// The sheet that a picture is drawn on: a screen, or paper.
//
// On a screen each picture has a size of its own, and texts have several. On paper the width is given, and so is the size of
// all text. A picture is laid out in units of which kPaperText are the size of text. So a narrow picture with large text has
// few units, and every distance and marker keeps its proportion to the text.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::report::drawing {

class Sheet {
 public:
  static constexpr double kPaperText = 11;  // units
  static constexpr double kNarrowest_mm = 30, kWidest_mm = 1000, kSmallest_pt = 4, kLargest_pt = 72;
  static constexpr double kFewestUnits = 220;  // twenty times the size of text

  Sheet() = default;  // a screen
  // Paper. Throws InputError outside 30..1000 mm and 4..72 pt, and if the width is less than twenty times the font's size.
  Sheet(double width_mm, double font_pt);

  bool on_paper() const { return width_ > 0; }
  // Returns a length of the picture on paper.
  double mm(double units) const { return units * mm_per_unit_; }
  // Returns the size of text in units.
  double text(double on_screen) const { return on_paper() ? kPaperText : on_screen; }
  // Returns the width of the picture in units.
  double width(double on_screen) const { return on_paper() ? width_ : on_screen; }
  // Returns the width of a plot with `beside` units left and right of it. Throws InputError if names leave too little of the
  // paper.
  double plot_width(double on_screen, double beside) const;
  // Returns the room for a line of text. On a screen text is not broken.
  double line(double units) const { return on_paper() ? units : std::numeric_limits<double>::infinity(); }

 private:
  double width_ = 0, mm_per_unit_ = 0;
};

// Breaks text at blanks into lines of at most `width` in DejaVu Sans at `size`. A longer word has a line of its own.
std::vector<std::string> broken(std::string_view text, double size, double width, bool bold = false);

}  // namespace ttf::report::drawing
