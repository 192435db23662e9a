#include "report/timing/windows/packed.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/check.h"
#include "report/drawing/base64.h"

namespace ttf::report::timing::windows {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kMark = '\1';                                // no text of a picture has it
constexpr std::size_t kMostDigits = 10, kMostDecimals = 4;  // a script's numbers hold them exactly

// A number of the text: value / 10^decimals.
struct Number {
  std::int64_t value = 0;
  std::size_t decimals = 0;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Reads a number at the text's begin, and returns its length. Returns 0 if a script would write it otherwise, as "007"
// or "1.50".
std::size_t read_number(std::string_view text, Number& number) {
  const bool negative = text.starts_with('-');
  const std::size_t first = negative ? 1 : 0;
  std::size_t at = first;
  std::int64_t value = 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    for (; at < text.size() && is_digit(text[at]) && at - begin <= kMostDigits; ++at)
      value = value * 10 + (text[at] - '0');
    return at - begin;
  };
  const std::size_t whole = digits();
  if (whole == 0 || whole > kMostDigits || (whole > 1 && text[first] == '0')) return 0;
  number.decimals = 0;
  if (at + 1 < text.size() && text[at] == '.' && is_digit(text[at + 1])) {
    ++at;
    number.decimals = digits();
    if (number.decimals > kMostDecimals || text[at - 1] == '0') return 0;
  }
  if (negative && value == 0) return 0;
  number.value = negative ? -value : value;
  return at;
}

// Returns whether a number may begin behind this character. Others have it within a colour, a name or another number.
bool begins_behind(char before) {
  return before != '#' && before != '_' && before != '.' && before != '-' && !is_digit(before) &&
         !(before >= 'a' && before <= 'z');
}

// Takes the numbers out of a line, and leaves marks.
std::string without_numbers(std::string_view line, std::vector<Number>& numbers) {
  std::string out;
  out.reserve(line.size());
  for (std::size_t at = 0; at < line.size();) {
    Number number;
    std::size_t length = 0;
    if ((is_digit(line[at]) || line[at] == '-') && (at == 0 || begins_behind(line[at - 1])))
      length = read_number(line.substr(at), number);
    // A mark must end where the number does.
    if (length == 0 || (at + length < line.size() && is_digit(line[at + length]))) {
      out += line[at++];
      continue;
    }
    numbers.push_back(number);
    out += kMark;
    at += length;
  }
  return out;
}

std::int64_t scaled(const Number& number, std::size_t decimals) {
  std::int64_t value = number.value;
  for (std::size_t d = number.decimals; d < decimals; ++d) value *= 10;
  return value;
}

// Adds the column as JSON. It has most of a chunk's values: text by text is three times as quick as a tree of values.
void add_column(const std::vector<Number>& column, std::string& out) {
  std::size_t decimals = 0;
  for (const Number& number : column) decimals = std::max(decimals, number.decimals);
  out += fmt::format("{}[{}", out.back() == '[' ? "" : ",", decimals);
  std::int64_t before = 0;
  for (const Number& number : column) {
    const std::int64_t value = scaled(number, decimals);
    out += ',';
    out += fmt::format_int(value - before).c_str();
    before = value;
  }
  out += ']';
}

std::string deflated(const std::string& text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  std::string out(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                               static_cast<uLong>(text.size()), Z_DEFAULT_COMPRESSION);
  TTF_CHECK(result == Z_OK, "zlib says {}", result);
  out.resize(size);
  return out;
}

}  // namespace

std::string packed_chunk(const std::vector<std::string>& svgs) {
  std::unordered_map<std::string, std::size_t> known;
  std::vector<std::vector<std::vector<Number>>> columns;  // by line, then mark
  Json lines = Json::array();
  std::string order;
  std::vector<Number> numbers;
  for (const std::string& svg : svgs) {
    order += order.empty() ? "[" : ",[";
    for (std::string_view rest = svg;;) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      numbers.clear();
      const auto [line, added] = known.try_emplace(without_numbers(rest.substr(0, end), numbers), known.size());
      if (added) {
        lines.push_back(line->first);
        columns.emplace_back(numbers.size());
      }
      if (order.back() != '[') order += ',';
      order += fmt::format_int(line->second).c_str();
      for (std::size_t n = 0; n < numbers.size(); ++n) columns[line->second][n].push_back(numbers[n]);
      if (end == rest.size()) break;
      rest.remove_prefix(end + 1);
    }
    order += ']';
  }
  std::string json = fmt::format("{{\"lines\":{},\"order\":[{}],\"columns\":[",
                                 lines.dump(-1, ' ', false, Json::error_handler_t::replace), order);
  for (const auto& of_line : columns)
    for (const std::vector<Number>& column : of_line) add_column(column, json);
  return drawing::base64(deflated(json + "]}"));
}

bool WindowPacker::add(TrueTime from, TrueTime to, const std::string& svg) {
  windows_.push_back({in_ms(from), in_ms(to)});
  pending_.push_back(svg);
  if (pending_.size() == kEach) close_chunk();
  if (bytes_ >= most_bytes_) full_at_ = to;
  return !full_at_;
}

void WindowPacker::close_chunk() {
  chunks_.push_back(packed_chunk(pending_));
  bytes_ += chunks_.back().get_ref<const std::string&>().size();
  pending_.clear();
}

Json WindowPacker::finish() {
  if (!pending_.empty()) close_chunk();
  if (windows_.empty()) return nullptr;
  return {{"windows", std::move(windows_)}, {"each", kEach}, {"chunks", std::move(chunks_)}};
}

}  // namespace ttf::report::timing::windows
