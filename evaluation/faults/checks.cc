#include "evaluation/faults/checks.h"

#include "core/check.h"

namespace ttf::evaluation::faults {

std::string_view name_of(Check check) {
  switch (check) {
    case Check::kSyntax: return "syntax";
    case Check::kContent: return "content";
    case Check::kBoundary: return "boundary";
    case Check::kConflict: return "conflict";
    case Check::kNoFrame: return "no_frame";
    case Check::kUnexpected: return "unexpected";
    case Check::kMissingTerm: return "missing_term";
    case Check::kLimit: return "limit";
    case Check::kPassive: return "passive";
    case Check::kHalt: return "halt";
    case Check::kGuardian: return "guardian";
  }
  TTF_CHECK(false, "check {}", static_cast<int>(check));
}

std::string_view name_of(Harm harm) {
  switch (harm) {
    case Harm::kLeftActive: return "left_active";
    case Harm::kNotStarted: return "not_started";
    case Harm::kPrecision: return "precision";
    case Harm::kFrameLost: return "frame_lost";
    case Harm::kFrameForged: return "frame_forged";
  }
  TTF_CHECK(false, "harm {}", static_cast<int>(harm));
}

}  // namespace ttf::evaluation::faults
