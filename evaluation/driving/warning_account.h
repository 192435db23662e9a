// Warnings of services against the truth: right, wrong, missed or late. The caller says when the truth is a hazard.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/time.h"
#include "recording/records/records.h"

namespace ttf::evaluation::driving {

// Hazards shorter than kNoticed need no warning.
struct WarningFindings {
  std::uint64_t hazards = 0, given = 0;
  std::uint64_t right = 0, wrong = 0;  // warnings within kTolerance of a hazard, and all others
  std::uint64_t missed = 0;            // hazards without a warning
  std::uint64_t late = 0;              // hazards whose warning began after them
  Duration lateness_sum{}, latest{};   // of those
};
// Returns the findings of two services as those of one.
WarningFindings together(const WarningFindings& a, const WarningFindings& b);

class WarningAccount {
 public:
  static constexpr Duration kTolerance = Duration::milliseconds(300), kNoticed = Duration::milliseconds(100);
  // A warning ends, too, when its node has said nothing for this long: it may be dead.
  static constexpr Duration kSilent = Duration::milliseconds(500);

  // Ignores warnings that end before `from`.
  explicit WarningAccount(TrueTime from) : from_(from) {}

  // Notes whether the truth is a hazard of the service at `at`, which is not before the last one.
  void judge(recording::records::WarningKind service, TrueTime at, bool hazard);
  // Notes that a node is alive.
  void note_alive(NodeId node, TrueTime at);
  // Notes that a node's supply was switched: it has lost its warnings, and takes none back.
  void note_power(NodeId node, TrueTime at);
  void warn(const recording::records::Warning& warning);
  // Returns a service's findings at the drive's end.
  WarningFindings finish(recording::records::WarningKind service, TrueTime end);

 private:
  struct Span {
    TrueTime from{}, to{};
  };
  struct Service {
    std::vector<Span> hazards, warned;  // the last one may go on
    bool hazard = false, warns = false;
    NodeId warner{};   // the node that warned last
    TrueTime alive{};  // when it was last seen to be alive
  };
  static void note_silence(Service& service, TrueTime until);

  TrueTime from_;
  std::array<Service, recording::records::kWarningKinds> services_;
};

}  // namespace ttf::evaluation::driving
