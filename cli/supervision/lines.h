// Makes a child's output fit for a shared screen: whole lines without cursor movement, each prefixed by
// speaker and time. The functions are pure; the text file keeps the child's original bytes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"

namespace ttf::cli::supervision {

// A longer line is shown in pieces, so that a flood without a newline needs bounded memory.
inline constexpr std::size_t kLongestLine = 4096;  // bytes

// Cuts a stream into lines. A partial line waits until it is complete, too long, or the stream ends.
class LineCutter {
 public:
  // Returns the lines that `bytes` complete, without their ends ("\n" or "\r\n"). A piece of a long line ends
  // in kGoesOn.
  std::vector<std::string> feed(std::string_view bytes);
  // Returns the waiting rest, once; empty if the stream ended with a newline.
  std::vector<std::string> finish();

  static constexpr std::string_view kGoesOn = " [...]";

 private:
  std::string held_;
};

// Writes control characters (except tabs) and bytes that are no UTF-8 as \xNN; the rest is unchanged.
std::string printable(std::string_view line);

// Distinguishes a speaker's lines on a screen.
struct Speaker {
  std::string name;
  std::size_t index = 0;  // chooses the colour
};

// Returns "   1.234 fusion      | text": seconds since the launch began, the name padded to `width`
// characters (UTF-8), the text. With colour, everything except the text has the speaker's.
std::string prefixed(Duration since_launch, const Speaker& speaker, std::size_t width, bool colour,
                     std::string_view text);

// Counts characters of UTF-8, not bytes.
std::size_t shown_width(std::string_view text);

}  // namespace ttf::cli::supervision
