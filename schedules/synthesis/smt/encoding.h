// A question as constraints of Z3.
#pragma once

#include <z3++.h>

#include <set>
#include <vector>

#include "schedules/synthesis/smt/z3_prover.h"

namespace ttf::schedules::synthesis::smt {

class Encoding {
 public:
  Encoding(const solver::Question& question, Logic logic);

  // False where the question is too long to write down; then it has no answer.
  bool whole() const { return whole_; }
  // Returns how it ended, and the offsets if it is satisfiable. `steps` loses what was used.
  z3::check_result check(std::uint32_t& steps, std::vector<Ticks>& offsets);
  // Adds the pairs of a resource that overlap at these offsets. Returns whether there are any.
  bool add_overlaps(const std::vector<Ticks>& offsets);

 private:
  // A whole number with bounds: what it stands for is `term`.
  struct Number {
    z3::expr term;
    Ticks first, last;
  };

  Number offset(std::size_t activity) const {
    return {offsets_[activity], windows_[activity].first, windows_[activity].last};
  }
  Number fresh(Ticks first, Ticks last);
  // For a whole k: least <= to - from - unit k <= most.
  z3::expr apart(const Number& from, const Number& to, Ticks unit, Ticks least, Ticks most);
  void add_place(std::size_t activity);
  void add_precedences();
  void add_chains();
  // Returns the age of a chain whose periods divide each other: one path of instances says it.
  // Fills `path` with these instances.
  Number add_path(const Chain& chain, std::vector<Number>& path);
  // Bounds the age of every output, and returns a number that is, if the chain is `summed`, at least as large.
  Number add_outputs(const Chain& chain, bool summed);
  // Returns the instance whose data `reader` reads, `ready` ticks after its beginning and less than `unit` later.
  Number read_by(const Number& reader, std::size_t activity, Ticks ready, Ticks unit);
  void add_orders();
  void add_sums();
  void add_spans();
  z3::expr value(Ticks ticks) { return context_.int_val(ticks); }

  const solver::Question& question_;
  Logic logic_;
  bool whole_ = true;
  int numbers_ = 0;
  z3::context context_;
  z3::solver solver_;
  std::vector<z3::expr> offsets_;
  std::vector<Window> windows_;
  std::vector<Number> ages_;                // by chain
  std::vector<std::vector<Number>> paths_;  // by chain and activity: the instances that one output rests on; or none
  std::set<std::pair<std::size_t, std::size_t>> apart_;
};

}  // namespace ttf::schedules::synthesis::smt
