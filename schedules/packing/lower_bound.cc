#include "schedules/packing/lower_bound.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace ttf::schedules::packing {
namespace {

using Cycles = std::uint64_t;  // a set: cycle c is bit c

std::int64_t quotient_up(std::int64_t dividend, std::int64_t divisor) { return (dividend + divisor - 1) / divisor; }

Cycles cycles_of(int repetition, Window window, int cycles) {
  Cycles set = 0;
  for (int cycle = 0; cycle < cycles; ++cycle)
    if (cycle % repetition >= window.earliest && cycle % repetition <= window.latest) set |= Cycles{1} << cycle;
  return set;
}

// Signals of one node with the same repetition, window and length.
struct Kind {
  Cycles cycles = 0;
  int bits = 0;
  int repetition = 1;
  std::int64_t signals = 0;
};

// Returns the kinds of each node, by ascending length.
std::vector<std::vector<Kind>> kinds_by_node(const Instance& instance, const Order& signals) {
  std::vector<std::map<std::array<int, 4>, std::int64_t>> counts(instance.nodes.size());
  for (const std::size_t index : signals) {
    const Signal& signal = instance.signals[index];
    ++counts[static_cast<std::size_t>(signal.node)]
            [{signal.bits, signal.repetition, signal.window.earliest, signal.window.latest}];
  }
  std::vector<std::vector<Kind>> kinds(counts.size());
  for (std::size_t node = 0; node < counts.size(); ++node)
    for (const auto& [kind, count] : counts[node])
      kinds[node].push_back({cycles_of(kind[1], {kind[2], kind[3]}, instance.cycles), kind[0], kind[1], count});
  return kinds;
}

// Returns all cycles, and for each repetition the cycles between the beginning of a signal's window and the end of one.
std::set<Cycles> sets_of(const Instance& instance, const Order& signals) {
  std::map<int, std::pair<std::set<int>, std::set<int>>> edges;
  for (const std::size_t index : signals) {
    const Signal& signal = instance.signals[index];
    edges[signal.repetition].first.insert(signal.window.earliest);
    edges[signal.repetition].second.insert(signal.window.latest);
  }
  std::set<Cycles> sets{cycles_of(1, {0, 0}, instance.cycles)};
  for (const auto& [repetition, of_windows] : edges)
    for (const int first : of_windows.first)
      for (const int last : of_windows.second)
        if (first <= last) sets.insert(cycles_of(repetition, {first, last}, instance.cycles));
  return sets;
}

// Sums of the kinds up to each length.
struct Sums {
  std::vector<int> bits{};
  std::vector<std::int64_t> sent{}, load{};  // over all lengths up to this one

  // Return the sums over lengths of low..high.
  std::int64_t sent_in(int low, int high) const { return at(sent, high) - at(sent, low - 1); }
  std::int64_t load_in(int low, int high) const { return at(load, high) - at(load, low - 1); }
  std::int64_t at(const std::vector<std::int64_t>& sums, int length) const {
    const auto past = std::upper_bound(bits.begin(), bits.end(), length) - bits.begin();
    return past == 0 ? 0 : sums[static_cast<std::size_t>(past - 1)];
  }
};

// The kinds that are sent in cycles of the set alone, and at least every `modulus` cycles; `sent` counts in classes of
// cycles.
Sums sums_within(const std::vector<Kind>& kinds, Cycles set, int modulus) {
  Sums sums;
  std::int64_t sent = 0, load = 0;
  for (const Kind& kind : kinds) {
    if ((kind.cycles & ~set) != 0 || kind.repetition > modulus) continue;
    const std::int64_t classes = kind.signals * (modulus / kind.repetition);
    sent += classes;
    load += classes * kind.bits;
    if (sums.bits.empty() || sums.bits.back() != kind.bits) {
      sums.bits.push_back(kind.bits);
      sums.sent.push_back(0);
      sums.load.push_back(0);
    }
    sums.sent.back() = sent;
    sums.load.back() = load;
  }
  return sums;
}

// Returns the classes of cycles that the sums need.
std::int64_t classes_needed(const Sums& sums, int payload) {
  const auto weight = [&](int threshold) {
    return payload * sums.sent_in(payload - threshold + 1, payload) + sums.load_in(threshold, payload - threshold);
  };
  std::int64_t most = sums.load_in(1, payload);
  for (const int bits : sums.bits)  // the thresholds at which the weight changes to the better
    if (const int threshold = 2 * bits > payload ? payload - bits + 1 : bits; 2 * threshold <= payload)
      most = std::max(most, weight(threshold));
  return quotient_up(most, payload);
}

// Returns the frames that the kinds of a node need in the set of cycles.
std::int64_t frames_within(const std::vector<Kind>& kinds, Cycles set, const Instance& instance) {
  std::int64_t frames = 0;
  for (int modulus = 1; modulus <= instance.cycles; modulus *= 2)
    frames = std::max(
        frames, classes_needed(sums_within(kinds, set, modulus), instance.payload_bits) * (instance.cycles / modulus));
  return frames;
}

}  // namespace

int least_bins(const Instance& instance, const Order& signals) {
  const auto kinds = kinds_by_node(instance, signals);
  std::int64_t bins = 0;
  for (const Cycles set : sets_of(instance, signals)) {
    std::int64_t frames = 0;
    for (const std::vector<Kind>& of_node : kinds) frames += frames_within(of_node, set, instance);
    bins = std::max(bins, quotient_up(frames, std::popcount(set)));
  }
  return static_cast<int>(bins);
}

double load(const Instance& instance, const Order& signals) {
  std::int64_t bits = 0;
  for (const std::size_t index : signals)
    bits += static_cast<std::int64_t>(instance.signals[index].bits) *
            (instance.cycles / instance.signals[index].repetition);
  return static_cast<double>(bits) / static_cast<double>(instance.cycles * instance.payload_bits);
}

}  // namespace ttf::schedules::packing
