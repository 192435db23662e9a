#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace ttf {

void check_failed(const char* file, int line, const char* condition, std::string_view values) {
  const std::string message = fmt::format("{}:{}: check failed: {} ({})\n", file, line, condition, values);
  std::fputs(message.c_str(), stderr);
  std::abort();
}

}  // namespace ttf
