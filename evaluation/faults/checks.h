// The harms that a fault may do to fault-free nodes, and the checks that may notice it, in the records of a drive
// (fault_account.h) or of a trial with a single fault (judge.h).
//
// A fault-free node is one that the fault does not name (reach.h). From the beginning of the fault on, it is
// harmed when
//   H1  it leaves normal active
//   H2  it is not normal active at the end of the drive, and never was since the beginning (of a drive that begins with
//       start-up)
//   H3  the global times of the fault-free nodes are further apart than the assumed precision
//   H4  it is normal active and receives a frame of another fault-free, normal active node on none of the channels that
//       it shares with that frame
//   H5  it accepts as valid, in a slot of a fault-free node, a frame that this node did not send there in this cycle
// A frame of a fault-free node is owed to every fault-free node that is normal active when it leaves.
//
// Checks are those of the fault-free nodes' controllers and of the guardians; the faulty node's own are kept
// apart.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "recording/records/records.h"

namespace ttf::evaluation::faults {

enum class Check : std::uint8_t {
  kSyntax,
  kContent,
  kBoundary,
  kConflict,
  kNoFrame,
  kUnexpected,  // in a slot: recording::records::SlotStatus
  kMissingTerm,
  kLimit,  // in clock correction
  kPassive,
  kHalt,      // states
  kGuardian,  // blocked or cut a bus signal
};
inline constexpr std::array kAllChecks = {Check::kSyntax,  Check::kContent,    Check::kBoundary,    Check::kConflict,
                                          Check::kNoFrame, Check::kUnexpected, Check::kMissingTerm, Check::kLimit,
                                          Check::kPassive, Check::kHalt,       Check::kGuardian};
std::string_view name_of(Check check);

enum class Harm : std::uint8_t { kLeftActive, kNotStarted, kPrecision, kFrameLost, kFrameForged };
inline constexpr std::array kAllHarms = {Harm::kLeftActive, Harm::kNotStarted, Harm::kPrecision, Harm::kFrameLost,
                                         Harm::kFrameForged};
std::string_view name_of(Harm harm);

// Calls `seen` with every check of a controller in its record.
template <class Seen> void for_each_check(const recording::records::SlotProblem& problem, Seen seen) {
  using recording::records::SlotStatus;
  constexpr std::array<std::pair<SlotStatus, Check>, 6> kOfSlots{{{SlotStatus::kSyntaxError, Check::kSyntax},
                                                                  {SlotStatus::kContentError, Check::kContent},
                                                                  {SlotStatus::kBoundaryViolation, Check::kBoundary},
                                                                  {SlotStatus::kTransmissionConflict, Check::kConflict},
                                                                  {SlotStatus::kNoFrame, Check::kNoFrame},
                                                                  {SlotStatus::kUnexpectedFrame, Check::kUnexpected}}};
  for (const auto& [bit, check] : kOfSlots)
    if (has(problem.status, bit)) seen(check);
}
template <class Seen> void for_each_check(const recording::records::ClockCorrected& corrected, Seen seen) {
  if (corrected.offset_missing || corrected.rate_missing) seen(Check::kMissingTerm);
  if (corrected.offset_limited || corrected.rate_limited) seen(Check::kLimit);
}
template <class Seen> void for_each_check(const recording::records::StateChanged& change, Seen seen) {
  if (change.to == recording::records::PocKind::kNormalPassive) seen(Check::kPassive);
  if (change.to == recording::records::PocKind::kHalt) seen(Check::kHalt);
}

}  // namespace ttf::evaluation::faults
