#include "fusion/association/near_places.h"

#include <bit>

namespace ttf::fusion::association {
namespace {

// So many buckets for each place.
constexpr std::size_t kBuckets = 4;
// At least so many buckets, so that those of one search are apart.
constexpr std::size_t kFewest = 64;
// The bucket of places in no cell.
constexpr std::uint32_t kNone = 0xffffffff;

std::size_t buckets_for(std::size_t places) { return std::bit_ceil(std::max(kFewest, kBuckets * places)); }

// Columns are a golden section of all buckets apart. So those of few columns are as far from each other as possible.
std::size_t step_among(std::size_t buckets) {
  constexpr double kGolden = 0.6180339887498949;
  return static_cast<std::size_t>(kGolden * static_cast<double>(buckets));
}

}  // namespace

NearPlaces::NearPlaces(std::size_t most)
    : bucket_(most), begin_(buckets_for(most) + kAcross), spots_(kAcross * most), found_(most) {
  places_.reserve(most);
  reaches_.reserve(most);
}

void NearPlaces::begin(double gate) {
  gate_ = gate;
  places_.clear();
  reaches_.clear();
  sum_ = 0.0;
}

void NearPlaces::arrange(double variance_x, double variance_y) {
  constexpr double kSmallest = 1e-3;         // [m]
  constexpr double kRoundedUp = 1.0 + 1e-6;  // cells are never too small by rounding
  choose_common();
  const double reach = common_ + std::max(reach_of(variance_x), reach_of(variance_y));
  cells_per_metre_ = 1.0 / std::max(kSmallest, 2.0 * kRoundedUp * reach);
  count_by_bucket();
  wide_ = 0;
  for (std::size_t t = 0; t < places_.size(); ++t)
    if (bucket_[t] == kNone) spots_[wide_++] = spot_of(t);
  // Each bucket begins where it ends, and its places come in from there.
  std::uint32_t end = wide_;
  const std::size_t buckets = mask_ + 1;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) begin_[bucket] = end += begin_[bucket];
  for (std::size_t t = places_.size(); t > 0;)
    if (const std::uint32_t bucket = bucket_[--t]; bucket != kNone) spots_[--begin_[bucket]] = spot_of(t);
  begin_[buckets] = end;
  for (std::uint32_t i = begin_[0]; i < begin_[1]; ++i) spots_[end++] = spots_[i];
  begin_[buckets + 1] = end;
}

// A little more than the mean, if that leaves out few places.
void NearPlaces::choose_common() {
  constexpr double kMore = 1.2;
  constexpr std::ptrdiff_t kAlways = 4, kOneIn = 64;
  const auto count = static_cast<std::ptrdiff_t>(places_.size());
  common_ = count > 0 ? kMore * sum_ / static_cast<double>(count) : 0.0;
  const auto is_wide = [&](const Reach& reach) { return reach.beyond(common_); };
  while (std::count_if(reaches_.begin(), reaches_.end(), is_wide) > kAlways + count / kOneIn) common_ *= kMore;
}

void NearPlaces::count_by_bucket() {
  mask_ = buckets_for(places_.size()) - 1;
  step_ = step_among(mask_ + 1);
  std::fill_n(begin_.begin(), mask_ + 1, 0);
  for (std::size_t t = 0; t < places_.size(); ++t) {
    bucket_[t] = kNone;
    if (reaches_[t].beyond(common_)) continue;
    const std::size_t bucket = bucket_of(cell_of(places_[t].x), cell_of(places_[t].y));
    bucket_[t] = static_cast<std::uint32_t>(bucket);
    ++begin_[bucket];
  }
}

NearPlaces::Spot NearPlaces::spot_of(std::size_t track) const {
  return {places_[track].x, places_[track].y, reaches_[track], static_cast<std::uint32_t>(track)};
}

}  // namespace ttf::fusion::association
