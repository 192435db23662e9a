// Time stamps as text: decimal seconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace ttf::recording::rows {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000, kLatest = 4'000'000'000 * kNsPerSecond;

// Returns nanoseconds: exact for a plain decimal with at most nine decimals, else the nearest to the nearest
// double. Returns no value for other text, and beyond kLatest.
std::optional<std::int64_t> nanoseconds_of(std::string_view text);

}  // namespace ttf::recording::rows
