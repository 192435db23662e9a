#include "core/errors.h"

#include <fmt/format.h>

namespace ttf {
namespace {

std::string all_sentences(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    if (!text.empty()) text += '\n';
    text += finding.sentence();
  }
  return text;
}

}  // namespace

std::string Finding::sentence() const {
  std::string text = file.empty() ? "input" : file;
  if (line > 0) text += fmt::format(":{}", line);
  text += ": ";
  if (!key.empty()) text += key;
  if (!value.empty()) text += fmt::format("{}{}", key.empty() ? "" : " = ", value);
  if (!key.empty() || !value.empty()) text += ": ";
  return text + expected;
}

InputError::InputError(std::vector<Finding> findings)
    : std::runtime_error(all_sentences(findings)), findings_(std::move(findings)) {}

void Findings::throw_if_any() const {
  if (!list_.empty()) throw InputError(list_);
}

}  // namespace ttf
