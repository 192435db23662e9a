// Checks of arguments for CLI11. Each says what an argument must be, in the words of a Finding.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"

namespace ttf::cli {

// Checks names of files and folders: an empty name does not mean the default, and `--out=` does not swallow an option.
CLI::Validator named();

// Checks a word among several; --help lists them.
CLI::Validator one_of(std::vector<std::string> words);

// Checks a whole number in plain decimal digits; --help shows the range.
CLI::Validator whole_number(Range<std::int64_t> allowed);

// The usual ends of a format's file names: ".csv".
struct FormatEnds {
  std::string_view format;
  std::vector<std::string_view> ends;
};
// Throws InputError if `path` ends as files of another format than `format` do. Other ends are free.
void refuse_other_format(const std::string& path, std::string_view format, const std::vector<FormatEnds>& formats);

}  // namespace ttf::cli
