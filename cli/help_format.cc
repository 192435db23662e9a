#include "cli/help_format.h"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace ttf::cli {
namespace {

constexpr std::size_t kWidest = 100;

// Breaks at blanks; lines of the text stay lines.
std::string broken(std::string_view text, std::size_t width) {
  std::string out;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    if (used > 0 && used + 1 + end > width) {
      out += '\n';
      used = 0;
    } else if (used > 0) {
      out += ' ';
      ++used;
    }
    out += text.substr(0, end);
    used += end;
    if (end < text.size() && text[end] == '\n') {
      out += '\n';
      used = 0;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

std::string HelpFormat::make_option_desc(const CLI::Option* option) const {
  return broken(Formatter::make_option_desc(option), kWidest - get_column_width());
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  std::stringstream out;
  CLI::detail::format_help(out, command->get_name(), broken(command->get_description(), kWidest - get_column_width()),
                           get_column_width());
  return out.str();
}

std::string HelpFormat::make_description(const CLI::App* command) const {
  return broken(Formatter::make_description(command), kWidest);
}

}  // namespace ttf::cli
