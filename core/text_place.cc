#include "core/text_place.h"

#include <fmt/format.h>

namespace ttf {

Finding TextOrigins::moved(Finding finding) const {
  TextPlace from = place(finding.file, finding.line);
  finding.file = std::move(from.file);
  finding.line = from.line;
  return with_heir(std::move(finding));
}

Finding TextOrigins::with_heir(Finding finding) const {
  if (!heir_.file.empty() && finding.file != heir_.file)
    finding.expected += fmt::format("; {}:{} leads to this file", heir_.file, heir_.line);
  return finding;
}

}  // namespace ttf
