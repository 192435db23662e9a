// Objectives that lie above schedules: an estimator's error, or a control loop's cost.
//
// The synthesis sees a number alone. Its caller hands the judge in. A judge sees the end of chains: when it reads, and
// the measurements that it has by then. Times are the schedule's own, without differences of clocks. Each list takes
// its longest way.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::instants::judging {

// A measurement in each round, and the first use that rests on it. It rests on all older ones as well.
struct FirstUse {
  std::size_t chain = 0;  // a chain's number in the plan
  Duration measured{};    // within the round
  Duration used{};        // not before `measured`, in any round
};

// One task that ends chains of sensors that observe objects.
struct ChainEnd {
  Duration round{};
  std::vector<Duration> uses;        // within the round, rising
  std::vector<FirstUse> first_uses;  // rising in `measured`
};

// The same while no instant is known.
struct Coming {
  std::size_t chain = 0;
  Duration period{};     // between measurements
  Duration least_age{};  // no instants have a smaller age at the first use
};
struct Prospect {
  Duration every{};  // between uses
  std::vector<Coming> coming;
  Duration least_worst_age{};  // no instants have a smaller age of the oldest of these
  // Returns false if no instants have ages at first use between these, both included, by `coming`. It does so only
  // where all of a chain has one period, and so one age.
  std::function<bool(const std::vector<Duration>& youngest, const std::vector<Duration>& oldest)> attainable;
};

// A value has one part or several. Several are weighed against each other: each part is divided by the least one that
// was found. The value is the largest ratio (minimax regret).
class Judge {
 public:
  virtual ~Judge() = default;
  virtual std::size_t parts() const { return 1; }
  // Returns max(weight * part), each part above zero and the less the better. Parts of weight 0 need not be counted.
  // The same meetings have the same value.
  virtual double of(const std::vector<ChainEnd>& chain_ends, const std::vector<double>& weights) const = 0;
  // Returns a bound of this from below, whatever the instants. The search for it may end at `enough`. It has `effort`
  // steps, and more of them may find a larger bound.
  virtual double bound(const std::vector<Prospect>& prospects, const std::vector<double>& weights, double enough,
                       int effort) const = 0;
  // Returns a condition of the bound without a proof; empty: the bound holds without any.
  virtual std::string supposes() const { return ""; }
};

using Judges = std::map<plan::Goal, const Judge*>;

// Returns what the ends of chains meet in a cluster that a synthesis of the plan has made.
std::vector<ChainEnd> chain_ends(const plan::Plan& plan, const model::Cluster& cluster);

// Returns max(weight * part) of such a cluster, with a weight for each part.
double judged(const Judge& judge, const std::vector<double>& weights, const plan::Plan& plan,
              const model::Cluster& cluster);

}  // namespace ttf::schedules::synthesis::instants::judging
