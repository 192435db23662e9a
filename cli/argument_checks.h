// Checks of arguments for CLI11. Each says what an argument must be, in the words of a Finding.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "core/strict_yaml.h"

namespace ttf::cli {

// Checks names of files and folders: an empty name does not mean the default, and `--out=` does not swallow an option.
CLI::Validator named();

// Checks a word among several; --help lists them.
CLI::Validator one_of(std::vector<std::string> words);

// Checks a whole number in plain decimal digits; --help shows the range.
CLI::Validator whole_number(Range<std::int64_t> allowed);

}  // namespace ttf::cli
