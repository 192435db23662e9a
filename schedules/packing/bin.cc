#include "schedules/packing/bin.h"

#include <algorithm>
#include <bit>

#include "core/check.h"

namespace ttf::schedules::packing {
namespace {

constexpr int kWordBits = 64;

// Returns the first bit at or after `from` that has the value, or `end`.
int next_bit(const std::uint64_t* words, int from, int end, bool value) {
  while (from < end) {
    std::uint64_t word = words[from / kWordBits];
    if (!value) word = ~word;
    word >>= from % kWordBits;
    if (word != 0) return std::min(end, from + std::countr_zero(word));
    from += kWordBits - from % kWordBits;
  }
  return end;
}

// Calls on(first, bits) for each run of free bits, until it returns true.
template <class On> void each_free_run(const std::uint64_t* words, int end, On&& on) {
  for (int from = next_bit(words, 0, end, false); from < end;) {
    const int past = next_bit(words, from, end, true);
    if (on(from, past - from)) return;
    from = next_bit(words, past, end, false);
  }
}

}  // namespace

Bin::Bin(const Instance& instance)
    : cycles_(instance.cycles), payload_bits_(instance.payload_bits), shared_slots_(instance.shared_slots),
      all_variants_(instance.all_variants()),
      words_(static_cast<std::size_t>((payload_bits_ + kWordBits - 1) / kWordBits)),
      used_(index(instance.variant_count(), 0) * words_), owner_(index(instance.variant_count(), 0), kFree) {
  TTF_CHECK(cycles_ >= 1 && cycles_ <= kMostCycles && std::has_single_bit(static_cast<unsigned>(cycles_)), "{} cycles",
            cycles_);
  TTF_CHECK(payload_bits_ >= 1 && payload_bits_ <= kMostPayloadBits, "{} bits", payload_bits_);
  TTF_CHECK(instance.variant_count() <= kMostVariants, "{} variants", instance.variant_count());
}

std::optional<int> Bin::free_offset(const Signal& signal, int first_cycle) const {
  const VariantSet variants = signal.variants & all_variants_;
  const std::size_t of = union_of(signal.repetition, first_cycle);
  if (!may_own(signal.node, variants, of)) return std::nullopt;
  Several several;
  std::optional<int> offset;
  each_free_run(used_in(variants, of, several), payload_bits_, [&](int first, int run) {
    if (run >= signal.bits) offset = first;
    return offset.has_value();
  });
  return offset;
}

std::optional<BitPlace> Bin::first_place(const Signal& signal, Fit fit) const {
  std::optional<BitPlace> first;
  for (int cycle = signal.window.earliest; cycle <= signal.window.latest; ++cycle) {
    const auto offset = free_offset(signal, cycle);
    if (!offset || (first && first->offset <= *offset)) continue;
    first = BitPlace{0, cycle, *offset};
    if (fit == Fit::kLowestCycle || *offset == 0) break;
  }
  return first;
}

void Bin::occupy(const Signal& signal, const BitPlace& place) {
  const VariantSet variants = signal.variants & all_variants_;
  TTF_CHECK(variants != 0, "signal {} is in no variant", signal.name);
  const int repetition = signal.repetition, first = place.first_cycle;
  for (int level = repetition; level <= cycles_; level *= 2)  // all unions of some of these cycles
    for (int cycle = first; cycle < level; cycle += repetition)
      use(variants, union_of(level, cycle), signal, place.offset);
  for (int level = repetition / 2; level >= 1; level /= 2)  // all unions that contain these cycles
    use(variants, union_of(level, first % level), signal, place.offset);
  used_bits_ += std::int64_t{signal.bits} * (cycles_ / repetition) * std::popcount(variants);
}

void Bin::use(VariantSet variants, std::size_t of, const Signal& signal, int offset) {
  each_variant(variants, [&](int variant) {
    const std::size_t at = index(variant, of);
    for (int bit = offset; bit < offset + signal.bits; ++bit)
      used_[at * words_ + static_cast<std::size_t>(bit / kWordBits)] |= Word{1} << (bit % kWordBits);
    owner_[at] = owner_[at] == kFree || owner_[at] == signal.node ? signal.node : kMixed;
  });
}

void Bin::block(VariantSet variants) {
  each_variant(variants & all_variants_, [&](int variant) {
    const auto first = owner_.begin() + static_cast<std::ptrdiff_t>(index(variant, 0));
    std::fill(first, first + 2 * cycles_, kBlocked);
  });
}

VariantSet Bin::used_variants() const {
  VariantSet used = 0;
  each_variant(all_variants_, [&](int variant) {
    const int owner = owner_[index(variant, union_of(1, 0))];
    if (owner != kFree && owner != kBlocked) used |= VariantSet{1} << variant;
  });
  return used;
}

bool Bin::may_own(int node, VariantSet variants, std::size_t of) const {
  bool may = true;
  each_variant(variants, [&](int variant) {
    const int owner = owner_[index(variant, shared_slots_ ? of : union_of(1, 0))];
    may = may && (owner == kFree || owner == node);
  });
  return may;
}

const Bin::Word* Bin::used_in(VariantSet variants, std::size_t of, Several& several) const {
  if (std::has_single_bit(variants)) return &used_[index(std::countr_zero(variants), of) * words_];
  std::fill_n(several.begin(), words_, Word{0});
  each_variant(variants, [&](int variant) {
    const Word* used = &used_[index(variant, of) * words_];
    for (std::size_t i = 0; i < words_; ++i) several[i] |= used[i];
  });
  return several.data();
}

int Bin::room_for(int node, int repetition, int bits) const {
  int room = 0;
  Several several;
  for (int cycle = 0; cycle < repetition; ++cycle) {
    const std::size_t of = union_of(repetition, cycle);
    if (!may_own(node, all_variants_, of)) continue;
    each_free_run(used_in(all_variants_, of, several), payload_bits_, [&](int, int run) {
      room += run / bits;
      return false;
    });
  }
  return room;
}

}  // namespace ttf::schedules::packing
