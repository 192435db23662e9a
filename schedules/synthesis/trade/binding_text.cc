#include <fmt/format.h>

#include "schedules/synthesis/trade/binding.h"

namespace ttf::schedules::synthesis::trade {
namespace {

// Returns a gain with its sign, as people read an age's change.
std::string change_text(Duration gain) { return fmt::format("{:.3f}", gain.ns == 0 ? 0.0 : -in_ms(gain)); }

}  // namespace

std::string binding_text(const std::vector<BindingWay>& ways) {
  std::string text = fmt::format("{:<68}{:>8}{:>8}{:>8}{:>8}\n", "what binds [ms]", "", "shorter", "own age", "worst");
  for (const BindingWay& way : ways) {
    text += fmt::format("{:<68}{:>8.3f}\n", way.chain, in_ms(way.worst_age));
    for (const WayPiece& piece : way.pieces) {
      const bool rests = piece.kind == WayPiece::Kind::kRests;
      text += fmt::format("    {:<64}{:>8.3f}", (rests ? "  rests: " : "") + piece.name, in_ms(piece.time));
      if (piece.shorter)
        text += fmt::format("{:>8}{:>8}{:>8}{}", change_text(piece.shorter->by), change_text(piece.shorter->own_age),
                            change_text(piece.shorter->worst_age), piece.shorter->proven ? "" : "  (search was cut)");
      text += '\n';
    }
  }
  return text;
}

}  // namespace ttf::schedules::synthesis::trade
