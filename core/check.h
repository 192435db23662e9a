// Always-on checks for our own bugs: a failed one prints its values and stops the process. Bad input throws
// instead (core/errors.h); the faults of a network are enum values and counted.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace ttf {

[[noreturn]] void check_failed(const char* file, int line, const char* condition, std::string_view values);

}  // namespace ttf

// TTF_CHECK(slot < slots, "slot {} of {}", slot, slots)
#define TTF_CHECK(condition, ...)                                                         \
  do {                                                                                    \
    if (!(condition)) [[unlikely]]                                                        \
      ::ttf::check_failed(__FILE__, __LINE__, #condition, ::fmt::format("" __VA_ARGS__)); \
  } while (false)
