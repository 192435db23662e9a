// Changes in per cent, as people read them: one wording for answers, pages and Markdown.
#pragma once

#include <string>
#include <string_view>

namespace ttf::experiments::results {

// Returns a number; `sign` marks a difference. 0 has no sign.
std::string plain_number(double value, int decimals, bool sign);

// Returns a change in per cent with its interval, "-12 % (-16 to -7)"; without an interval "-12 %"; "-" without a value.
// Decimals suffice to separate an end from 0. `sign` marks a difference.
std::string percent_words(double value, double low, double high, bool sign);

// Says what the columns of a table of interactions are.
std::string_view interaction_columns(bool by_ratio);

}  // namespace ttf::experiments::results
