#include "cli/version.h"

#include <fmt/format.h>
#include <ttf_built.h>
#include <ttf_commit.h>

#include <string_view>

namespace ttf::cli {

std::string version_text() {
  constexpr std::string_view kArchitecture = TTF_ARCHITECTURE, kBuildType = TTF_BUILD_TYPE;
  return fmt::format(
      "ttfusion {}, commit {}\n"
      "compiled by {} as {} for {}\n"
      "with {}, SocketCAN, {}, pictures (librsvg {})",
      TTF_VERSION, TTF_COMMIT, TTF_COMPILER, kBuildType.empty() ? "no fixed type" : kBuildType,
      kArchitecture.empty() ? "the compiler's default processor" : kArchitecture, TTF_DDS, TTF_MPI, TTF_LIBRSVG);
}

}  // namespace ttf::cli
