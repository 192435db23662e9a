#include "cli/argument_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/errors.h"

namespace ttf::cli {

CLI::Validator named() {
  return CLI::Validator(
      [](const std::string& text) {
        return text.empty() || text.front() == '-' ? "must not be empty or begin with a '-' (write ./-NAME instead)"
                                                   : "";
      },
      "");
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string shown = fmt::format("{{{}}}", fmt::join(words, ","));
  return CLI::Validator(
      [words = std::move(words)](const std::string& text) {
        return std::find(words.begin(), words.end(), text) != words.end()
                   ? std::string()
                   : fmt::format("must be one of {}", fmt::join(words, ", "));
      },
      shown);
}

CLI::Validator whole_number(Range<std::int64_t> allowed) {
  const std::string range = fmt::format("{}..{}", allowed.low, allowed.high);
  return CLI::Validator(
      [allowed, range](const std::string& text) {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc{} && fmt::to_string(value) == text;  // CLI11 takes 010 for 8
        return whole && allowed.contains(value) ? "" : "must be a whole number " + range;
      },
      range);
}

void refuse_other_format(const std::string& path, std::string_view format, const std::vector<FormatEnds>& formats) {
  const auto has = [&](const FormatEnds& one) {
    return std::ranges::any_of(one.ends, [&](std::string_view end) { return path.ends_with(end); });
  };
  for (const FormatEnds& one : formats)
    if (one.format == format && has(one)) return;  // another format's files may end so, too
  for (const FormatEnds& one : formats)
    for (const std::string_view end : one.ends)
      if (one.format != format && path.ends_with(end))
        throw InputError(Finding{"command line", 0, "--out", path,
                                 fmt::format("must not end in {} with --format {}: that is a file of --format {}", end,
                                             format, one.format)});
}

}  // namespace ttf::cli
