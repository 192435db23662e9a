// Always-on checks for our own bugs: they print the values and stop the process. Bad input is never checked this
// way (core/errors.h), nor is what a network does (an enum value, counted).
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
