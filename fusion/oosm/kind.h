// The methods by name, for selection by users.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ttf::fusion::oosm {

enum class Kind : std::uint8_t { kRewind, kAugmented, kClone, kAdjoint, kAl1, kBl1, kA, kB, kC };

struct NamedKind {
  std::string_view name;
  Kind kind;
};
inline constexpr std::array<NamedKind, 9> kKinds{{{"rewind", Kind::kRewind},
                                                  {"augmented", Kind::kAugmented},
                                                  {"clone", Kind::kClone},
                                                  {"adjoint", Kind::kAdjoint},
                                                  {"al1", Kind::kAl1},
                                                  {"bl1", Kind::kBl1},
                                                  {"a", Kind::kA},
                                                  {"b", Kind::kB},
                                                  {"c", Kind::kC}}};

constexpr std::string_view name_of(Kind kind) {
  for (const NamedKind& named : kKinds)
    if (named.kind == kind) return named.name;
  return {};
}

}  // namespace ttf::fusion::oosm
