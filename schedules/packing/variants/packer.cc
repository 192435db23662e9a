#include "schedules/packing/variants/packer.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/check.h"
#include "schedules/packing/first_fit.h"
#include "schedules/packing/instance.h"
#include "schedules/packing/lower_bound.h"
#include "schedules/packing/variants/candidates.h"
#include "schedules/packing/variants/columns.h"
#include "schedules/packing/variants/lower_bound.h"
#include "schedules/packing/variants/pieces.h"
#include "schedules/packing/variants/projection.h"

namespace ttf::schedules::packing::variants {
namespace {

// The columns of places that stand, and their owners in each variant.
class StandingColumns {
 public:
  // `fixed` is empty, or has an entry for each signal. Both must outlive the object.
  StandingColumns(const Instance& instance, const Places& fixed) : instance_(instance), fixed_(fixed) {
    for (std::size_t signal = 0; signal < fixed.size(); ++signal) {
      if (!fixed[signal]) continue;
      const Signal& of = instance.signals[signal];
      count_ = std::max(count_, fixed[signal]->bin + 1);
      owned_[fixed[signal]->bin][instance.shared_slots ? 0 : of.node] |= of.variants & instance.all_variants();
    }
  }

  int count() const { return count_; }

  // Returns the places of these signals that stand, in bins of their own, and adds the columns of the bins to
  // `columns`. The signals are those of the node; where slots are shared, they are all signals and the node is 0. A bin
  // is blocked in the variants of other owners. The owner of the lowest number also has the variants without an owner.
  Packed bins_of(const Order& signals, int node, std::vector<int>& columns) const {
    Places places(instance_.signals.size());
    std::map<int, int> bin_of;  // by column
    for (const auto& [column, owners] : owned_)
      if (owners.contains(node)) {
        bin_of.emplace(column, static_cast<int>(columns.size()));
        columns.push_back(column);
      }
    for (const std::size_t signal : signals)
      if (signal < fixed_.size() && fixed_[signal]) {
        places[signal] = fixed_[signal];
        places[signal]->bin = bin_of.at(fixed_[signal]->bin);
      }
    Packed packed = with_fixed(instance_, places);
    for (const auto& [column, bin] : bin_of)
      packed.bins[static_cast<std::size_t>(bin)].block(blocked(owned_.at(column), node));
    return packed;
  }

 private:
  using Owners = std::map<int, VariantSet>;  // the variants of each node

  VariantSet blocked(const Owners& owners, int node) const {
    VariantSet others = 0;
    for (const auto& [owner, variants] : owners)
      if (owner != node) others |= variants;
    return owners.begin()->first == node ? others : instance_.all_variants() & ~owners.at(node);
  }

  const Instance& instance_;
  const Places& fixed_;
  int count_ = 0;
  std::map<int, Owners> owned_;  // by column
};

// A part of the signals, with bins of its own: those of one node, or all where slots are shared.
struct Share {
  std::vector<int> standing;                                                // the columns of its first bins
  std::vector<Candidate> candidates;                                        // packings of its signals
  std::vector<std::array<std::vector<std::vector<Piece>>, 2>> divisions{};  // by candidate
  std::size_t chosen = 0;

  const Packed& packed() const { return candidates[chosen].packed; }
};

class Packer {
 public:
  Packer(const Instance& instance, const Places& fixed, const Effort& effort)
      : instance_(instance), fixed_(fixed), effort_(effort), standing_(instance, fixed),
        signals_(possible_signals(instance)) {}

  Solution pack() {
    Part all{std::vector<int>(instance_.nodes.size()), signals_.size(), 0.0, 0, 0, 0, {}};
    std::iota(all.nodes.begin(), all.nodes.end(), 0);
    all.bound = least_slots(instance_, signals_, fixed_);
    for (int variant = 0; variant < instance_.variant_count(); ++variant)
      all.load = std::max(all.load, load(instance_, of_variant(instance_, signals_, variant)));
    if (instance_.shared_slots) {
      add_share(signals_, 0);
    } else {
      for (int node = 0; node < static_cast<int>(instance_.nodes.size()); ++node)
        add_share(of_node(instance_, signals_, node), node);
    }
    Columns columns = chosen_columns(all.bound);
    all.bins = columns.count;
    all.how = shares_.size() == 1 ? shares_.front().candidates[shares_.front().chosen].how : "of each node its own";
    Solution solution = placed(columns);
    for (const Share& share : shares_)
      for (const Bin& bin : share.packed().bins) all.used_bits += bin.used_bits();
    solution.parts.push_back(std::move(all));
    return solution;
  }

 private:
  void add_share(const Order& signals, int node) {
    Share share;
    const Packed fixed = standing_.bins_of(signals, node, share.standing);
    Order added;
    std::copy_if(signals.begin(), signals.end(), std::back_inserter(added),
                 [&](std::size_t signal) { return !fixed.places[signal]; });
    std::vector<int> bounds = bins_by_variant(instance_, fixed.bins);
    for (int variant = 0; variant < instance_.variant_count(); ++variant) {
      int& bound = bounds[static_cast<std::size_t>(variant)];
      bound = std::max(bound, least_bins(instance_, of_variant(instance_, signals, variant)));
    }
    share.candidates = candidates(instance_, added, fixed, bounds, effort_, static_cast<int>(shares_.size()));
    shares_.push_back(std::move(share));
  }

  // Both divisions of the bins of each candidate: whole, and into pieces.
  void divide() {
    for (Share& share : shares_)
      for (const Candidate& candidate : share.candidates) {
        auto pieces = pieces_of(instance_, candidate.packed.places, fixed_);
        share.divisions.push_back({whole_bins(pieces), std::move(pieces)});
      }
  }

  // The columns of all pieces that do not stand: share by share, bin by bin.
  Columns columns() const {
    std::vector<VariantSet> standing(static_cast<std::size_t>(standing_.count())), added;
    for (const Share& share : shares_)
      each_piece(share, [&](std::size_t bin, const Piece& piece) {
        if (piece.stands)
          standing[static_cast<std::size_t>(share.standing[bin])] |= piece.variants;
        else
          added.push_back(piece.variants);
      });
    return columns_of(standing, added);
  }

  template <class On> void each_piece(const Share& share, On&& on) const {
    const auto& bins = share.divisions[share.chosen][in_pieces_ ? 1 : 0];
    for (std::size_t bin = 0; bin < bins.size(); ++bin)
      for (const Piece& piece : bins[bin]) on(bin, piece);
  }

  // Exchanges the candidate of one share after the other, as long as that saves a column. Then the same with pieces.
  Columns chosen_columns(int bound) {
    divide();
    Columns best = columns();
    exchange_candidates(bound, best);
    if (best.count <= bound) return best;
    in_pieces_ = true;
    Columns divided = columns();
    exchange_candidates(bound, divided);
    if (divided.count < best.count) return divided;
    in_pieces_ = false;
    return columns();
  }

  void exchange_candidates(int bound, Columns& best) {
    for (bool better = true; better && best.count > bound;) {
      better = false;
      for (Share& share : shares_)
        for (std::size_t candidate = 0; candidate < share.candidates.size(); ++candidate) {
          const std::size_t before = std::exchange(share.chosen, candidate);
          Columns tried = columns();
          if (tried.count < best.count) {
            best = std::move(tried);
            better = true;
          } else {
            share.chosen = before;
          }
        }
    }
  }

  Solution placed(const Columns& columns) const {
    Solution solution;
    solution.places.resize(instance_.signals.size());
    solution.bins = columns.count;
    std::size_t next = 0;
    for (const Share& share : shares_) {
      std::vector<std::vector<std::pair<VariantSet, int>>> columns_of_bin(share.packed().bins.size());
      each_piece(share, [&](std::size_t bin, const Piece& piece) {
        columns_of_bin[bin].emplace_back(piece.variants, piece.stands ? share.standing[bin] : columns.of_bin[next++]);
      });
      for (std::size_t signal = 0; signal < solution.places.size(); ++signal) {
        if (!share.packed().places[signal]) continue;
        BitPlace place = *share.packed().places[signal];
        for (const auto& [variants, column] : columns_of_bin[static_cast<std::size_t>(place.bin)])
          if ((variants & instance_.signals[signal].variants) != 0) {
            solution.places[signal] = BitPlace{column, place.first_cycle, place.offset};
            break;
          }
      }
    }
    return solution;
  }

  const Instance& instance_;
  const Places& fixed_;
  Effort effort_;
  StandingColumns standing_;
  Order signals_;
  std::vector<Share> shares_;
  bool in_pieces_ = false;
};

}  // namespace

Solution pack_variants(const Instance& instance, const Places& fixed, const Effort& effort) {
  TTF_CHECK(instance.variants.size() <= static_cast<std::size_t>(kMostVariants), "{} variants",
            instance.variants.size());
  Solution solution = Packer(instance, fixed, effort).pack();
  const bool some_stand = std::any_of(fixed.begin(), fixed.end(), [](const auto& place) { return place.has_value(); });
  if (some_stand || solution.proven()) return solution;
  // Schedules of narrower rules are among those of wider ones, and a greedy search may well find a better one there.
  const auto take = [&](Solution other) {
    if (other.bins >= solution.bins) return;
    Part part = solution.parts.front();
    part.bins = other.bins;
    part.how = "as one vehicle, or without shared slots";
    solution = {std::move(other.places), other.bins, {std::move(part)}};
  };
  take(packing::pack(one_vehicle(instance), {}, effort));
  if (!instance.shared_slots) return solution;
  Instance own_slots = instance;
  own_slots.shared_slots = false;
  take(Packer(own_slots, fixed, {0, effort.seed}).pack());
  return solution;
}

}  // namespace ttf::schedules::packing::variants
