// What a child prints, made fit for a screen that many share: whole lines, nothing that moves the cursor, and in front
// of each who said it and when. Pure; the child's own bytes go to its text file unchanged.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"

namespace ttf::cli::supervision {

// A line that grows beyond this is shown in pieces, so that a flood without a newline costs no more than this.
inline constexpr std::size_t kLongestLine = 4096;  // bytes

// Cuts a stream into lines. Partial lines are held back until they are complete, too long, or the stream ends.
class LineCutter {
 public:
  // The lines that `bytes` complete, without their ends ("\n" or "\r\n"). A piece of too long a line ends in kGoesOn.
  std::vector<std::string> feed(std::string_view bytes);
  // What is held back, once; nothing where the stream ended with a newline.
  std::vector<std::string> finish();

  static constexpr std::string_view kGoesOn = " [...]";

 private:
  std::string held_;
};

// Control characters (but tabs) and bytes that are no UTF-8 are written as \xNN. Everything else stays as it is.
std::string printable(std::string_view line);

// How lines are told apart on a screen.
struct Speaker {
  std::string name;
  std::size_t index = 0;  // chooses the colour
};

// "   1.234 fusion      | text": seconds since the launch began, the name filled up to `width` characters (UTF-8), the
// text. With colour, all but the text is in the speaker's.
std::string prefixed(Duration since_launch, const Speaker& speaker, std::size_t width, bool colour,
                     std::string_view text);

// Characters (not bytes) of UTF-8.
std::size_t shown_width(std::string_view text);

}  // namespace ttf::cli::supervision
