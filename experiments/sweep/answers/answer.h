// The answer of an experiment's results, a pure function of the store. It has means with intervals by point,
// paradigm and measure, and differences between paradigms, or along an axis, of the same draws (paired, so that common
// effects cancel). It says where two paradigms cross, and whether interactions are certain and expectations hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/results/outcome.h"
#include "experiments/results/pairs.h"
#include "experiments/results/ratio.h"
#include "experiments/results/statistics.h"
#include "experiments/results/store.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep::answers {

struct PointAnswer {
  std::uint32_t point = 0;
  // By paradigm, then measure. Differences are from SweepFile::reference_of, replication by replication; the baseline
  // has none.
  std::vector<std::vector<results::Interval>> means, differences;
  // The means over those of the reference; none where a ratio of the measure has no meaning (is_ratio_scale).
  std::vector<std::vector<results::Ratio>> ratios;
  // By paradigm: the first measure's difference stays certain among all points' and paradigms' (Holm's method).
  std::vector<bool> stays;
};

// A change of sign of the first measure's difference between two neighbours on a numeric axis of the grid, all
// else equal. Points without any difference may lie between the two.
struct Crossing {
  std::size_t paradigm = 0;  // this one and the baseline
  std::string axis;
  std::string others;                   // the other axes' values, "" if there are none
  std::uint32_t before = 0, after = 0;  // points
  double at = 0.0;                      // interpolated: linear in the value, or in its logarithm on a logarithmic axis
  bool certain = false;                 // both differences stay certain by Holm's method
};

// One paradigm's change when an interaction's axis changes: the values after minus those before, in the measure's unit. With
// Scale::kRatio it has their ratio, too.
struct Change {
  results::Interval difference;
  results::Ratio ratio;
};
struct InteractionPoint {
  std::uint32_t point = 0;  // before the change
  Change first, second;     // by paradigm
  // The first paradigm's change against the second's, replication by replication: the logarithm of the ratio of their
  // ratios, or the difference of their differences. Below 0: the change lowers the first one more.
  results::Interval interaction;
  bool stays = false;  // certain among all interactions of the file (Holm's method)
};
struct InteractionAnswer {
  std::vector<InteractionPoint> points;  // by the other axes' values
};

using results::Outcome;

// A point at which an expectation is not certain, with a sentence about the reason.
struct Unmet {
  std::string point, why;
};

struct ExpectationAnswer {
  std::string text;
  Outcome outcome = Outcome::kHolds;  // fails if it fails at one point
  std::vector<Unmet> unmet;
  bool holds() const { return outcome == Outcome::kHolds; }
};

// Drives in which an object lost its track, by paradigm over all points. One such drive may be the largest part of a mean. So the
// points are there without each replication in which a paradigm lost one there.
struct LostTracks {
  std::vector<std::uint64_t> drives, lost;  // drives without tracks to judge do not count
  std::uint64_t left_out = 0;               // replications, over all points
  std::vector<PointAnswer> points;
};

struct SweepAnswer {
  std::uint64_t drives = 0, failed = 0;
  std::vector<PointAnswer> points;
  std::size_t comparisons = 0, certain = 0;  // the first measure's, at all points; those that stay certain
  results::Pairs pairs;  // the first measure's, of all paradigms at all points: a family of their own
  std::vector<Crossing> crossings;
  std::vector<InteractionAnswer> interactions;  // as in the file
  std::vector<ExpectationAnswer> expectations;
  std::optional<LostTracks> lost;  // if some drive lost one; always for a file that has the measure kTrackLost
  bool holds() const;
};

SweepAnswer answer_of(const SweepFile& sweep, const results::Store& store);

// Returns whether a point satisfies the stop rule with replications 0..to-1 of `rows`, which are in order.
bool sure_enough(const SweepFile& sweep, const std::vector<results::Row>& rows, std::uint32_t to);

}  // namespace ttf::experiments::sweep::answers
