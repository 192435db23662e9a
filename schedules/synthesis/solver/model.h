// A question as the search reads it: the ages of chains as sums of rests, windows narrowed by precedences, neighbours by activity.
//
// Between neighbours j, j + 1 of a chain, data rests from its being ready until its being read. Let T_j be the periods and S_j the
// least common multiple of T_j..T_k, the stride at which the outputs' instances of j follow each other. As long as each period
// divides the other (`harmonic`), the oldest output reads just before news arrive wherever the periods grow towards the source, and
//   age = base + sum rest_j,  base = sum (duration_j + gap_j) + duration_k + sum over T_j > S_j+1 of (T_j - S_j+1),
//   rest_j = (x_j+1 - offset_j - duration_j - gap_j) mod gcd(S_j+1, T_j),
// with x_k = offset_k, and x_j = offset_j where S_j = T_j, else the beginning of the one x_j+1 reads. Modulo m_j = gcd(T_j, T_j+1)
// every instance rests as long as another, so (offset_j+1 - offset_j - duration_j - gap_j) mod m_j bounds a rest from below
// without x_j+1, in chains that are not harmonic as well.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "schedules/synthesis/problem.h"
#include "schedules/synthesis/solver/prover.h"

namespace ttf::schedules::synthesis::solver {

inline constexpr Ticks kNoLimit = std::numeric_limits<Ticks>::max() / 4;

// Returns value modulo divisor, in 0..divisor - 1.
inline Ticks modulo(Ticks value, Ticks divisor) {
  const Ticks rest = value % divisor;
  return rest < 0 ? rest + divisor : rest;
}

struct ChainTerms {
  Ticks base = 0;
  std::vector<Ticks> ready;    // by activity but the last: duration + gap
  std::vector<Ticks> modulus;  // by link: m_j
  std::vector<Ticks> stride;   // by activity: S_j; 0 where it is not harmonic from there on to the end
  bool harmonic = true;
  bool pairwise = true;  // harmonic, and gcd(S_j+1, T_j) = m_j throughout: the sum needs no x
  Ticks limit = kNoLimit;
};

ChainTerms terms_of(const Problem& problem, const Chain& chain);

// Where an activity stands in a chain.
struct Membership {
  std::size_t chain = 0, at = 0;
};

// A precedence as seen from one of its activities: its offset lies in other's + least..most.
struct Distance {
  std::size_t other = 0;
  Ticks least = 0, most = 0;
};

struct Model {
  const Problem& problem;
  std::vector<ChainTerms> chains;
  std::vector<SumLimit> sums;
  std::vector<SpanLimit> spans;
  // By activity:
  std::vector<Window> windows;  // narrowed, on the grid; a fixed offset is a window of one
  std::vector<Grid> grids;      // every tick for a fixed one
  std::vector<std::vector<Membership>> memberships;
  std::vector<std::vector<Distance>> distances;
  std::vector<std::vector<std::size_t>> sums_of, spans_of;  // indices of limits that bind it
  bool contradictory = false;                               // windows and precedences alone allow nothing

  explicit Model(const Question& question);

  // Greatest common divisor of two activities' periods.
  Ticks common(std::size_t a, std::size_t b) const { return divisors_[classes_[a] * distinct_ + classes_[b]]; }
  // The next offset on the grid, upwards (or downwards).
  Ticks on_grid_from(std::size_t activity, Ticks offset) const;
  Ticks on_grid_to(std::size_t activity, Ticks offset) const;

 private:
  void read_chains(const Question& question);
  void read_places();
  void read_periods();
  bool precedences_contradict() const;
  void narrow();
  void fold();

  std::vector<std::size_t> classes_;  // by activity: which of the distinct periods
  std::vector<Ticks> divisors_;
  std::size_t distinct_ = 0;
};

}  // namespace ttf::schedules::synthesis::solver
