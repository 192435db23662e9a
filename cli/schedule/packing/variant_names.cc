#include "cli/schedule/packing/variant_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;

constexpr std::size_t kLongestVariantName = 40;

// A variant's name becomes part of a file's name.
bool is_variant_name(std::string_view name) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !name.empty() && name.size() <= kLongestVariantName &&
         name.find_first_not_of(kAllowed) == std::string_view::npos;
}

}  // namespace

table::VariantSet VariantNames::read(const Rows& rows, Findings& findings) {
  const std::string_view field = rows.text(kVariants);
  if (field.empty()) return table::kAllVariants;
  table::VariantSet variants = 0;
  for (std::size_t begin = 0; begin <= field.size();) {
    const std::size_t end = std::min(field.find('|', begin), field.size());
    const std::string_view name = field.substr(begin, end - begin);
    begin = end + 1;
    if (!is_variant_name(name)) {
      findings.add(
          rows.finding(kVariants, fmt::format("must be names as in base|sport, each of 1..{} letters, digits, _, - "
                                              "or .; blank for all variants",
                                              kLongestVariantName)));
      return table::kAllVariants;
    }
    const auto known = std::find(names_.begin(), names_.end(), name);
    if (known == names_.end() && names_.size() == static_cast<std::size_t>(table::kMostVariants)) {
      findings.add(rows.finding(
          kVariants, fmt::format("must not name another variant: there are at most {}", table::kMostVariants)));
      return table::kAllVariants;
    }
    const table::VariantSet one = table::VariantSet{1} << (known - names_.begin());
    if (known == names_.end()) names_.emplace_back(name);
    if ((variants & one) != 0) findings.add(rows.finding(kVariants, fmt::format("must name {} once", name)));
    variants |= one;
  }
  return variants;
}

std::string variants_text(table::VariantSet variants, const std::vector<std::string>& names) {
  if (variants == table::kAllVariants) return {};
  std::string text;
  table::each_variant(variants, [&](int variant) {
    if (static_cast<std::size_t>(variant) >= names.size()) return;
    text += (text.empty() ? "" : "|") + names[static_cast<std::size_t>(variant)];
  });
  return text;
}

}  // namespace ttf::cli::schedule::packing
