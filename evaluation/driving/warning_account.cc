#include "evaluation/driving/warning_account.h"

#include <algorithm>

namespace ttf::evaluation::driving {

using recording::records::WarningKind;

WarningFindings together(const WarningFindings& a, const WarningFindings& b) {
  return {a.hazards + b.hazards,
          a.given + b.given,
          a.right + b.right,
          a.wrong + b.wrong,
          a.missed + b.missed,
          a.late + b.late,
          a.lateness_sum + b.lateness_sum,
          std::max(a.latest, b.latest)};
}

void WarningAccount::judge(WarningKind service, TrueTime at, bool hazard) {
  Service& one = services_[index_of(service)];
  if (hazard && !one.hazard) one.hazards.push_back({at, at});
  if (hazard) one.hazards.back().to = at;
  one.hazard = hazard;
}

void WarningAccount::note_alive(NodeId node, TrueTime at) {
  for (Service& one : services_) {
    if (!one.warns || node != one.warner) continue;
    note_silence(one, at);
    one.alive = at;
  }
}

void WarningAccount::note_power(NodeId node, TrueTime at) {
  for (Service& one : services_) {
    if (!one.warns || node != one.warner) continue;
    note_silence(one, at);
    if (one.warns) one.warned.back().to = at;
    one.warns = false;
  }
}

void WarningAccount::note_silence(Service& service, TrueTime until) {
  if (!service.warns || until - service.alive <= kSilent) return;
  service.warned.back().to = service.alive;
  service.warns = false;
}

void WarningAccount::warn(const recording::records::Warning& warning) {
  if (index_of(warning.service) >= services_.size()) return;
  const TrueTime at = warning.stamp.true_time;
  Service& one = services_[index_of(warning.service)];
  note_silence(one, at);
  one.warner = warning.stamp.node;
  one.alive = at;
  if (warning.on && !one.warns) one.warned.push_back({at, kNever<TrueTime>});
  if (!warning.on && one.warns) one.warned.back().to = at;
  one.warns = warning.on;
}

WarningFindings WarningAccount::finish(WarningKind service, TrueTime end) {
  Service& of = services_[index_of(service)];
  note_silence(of, end);
  // A truth that leaves the hazard for a moment does not end it.
  std::vector<Span> hazards;
  for (const Span& one : of.hazards)
    if (!hazards.empty() && one.from - hazards.back().to < kTolerance)
      hazards.back().to = one.to;
    else
      hazards.push_back(one);
  WarningFindings found;
  const auto overlap = [](const Span& warning, const Span& hazard) {
    return warning.from <= hazard.to + kTolerance && warning.to >= hazard.from - kTolerance;
  };
  for (const Span& warning : of.warned) {
    if (warning.to < from_) continue;
    ++found.given;
    const bool right =
        std::any_of(hazards.begin(), hazards.end(), [&](const Span& hazard) { return overlap(warning, hazard); });
    ++(right ? found.right : found.wrong);
  }
  for (const Span& hazard : hazards) {
    if (hazard.to - hazard.from < kNoticed) continue;
    ++found.hazards;
    const auto first =
        std::find_if(of.warned.begin(), of.warned.end(), [&](const Span& warning) { return overlap(warning, hazard); });
    if (first == of.warned.end()) {
      ++found.missed;
    } else if (first->from > hazard.from) {
      ++found.late;
      found.lateness_sum += first->from - hazard.from;
      found.latest = std::max(found.latest, first->from - hazard.from);
    }
  }
  return found;
}

}  // namespace ttf::evaluation::driving
