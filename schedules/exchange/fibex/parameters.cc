#include "schedules/exchange/fibex/parameters.h"

#include <fmt/format.h>

#include <span>

#include "core/check.h"
#include "core/decimal.h"
#include "schedules/file/parameter_table.h"

namespace ttf::schedules::exchange::fibex {
namespace {

constexpr std::int64_t kPicosecondsPerMicrosecond = 1'000'000;

template <class Struct> struct Tables {
  std::span<const file::IntegerParameter<Struct>> integers;
  std::span<const file::ScaledParameter<Struct>> scaled;
  std::span<const file::FlagParameter<Struct>> flags;
};

Tables<file::Global> tables_of(const file::Global&) { return {file::kGlobalIntegers, file::kGlobalScaled, {}}; }
Tables<file::Local> tables_of(const file::Local&) { return {file::kNodeIntegers, file::kNodeScaled, file::kNodeFlags}; }

// FIBEX has times in microseconds only.
std::int64_t fibex_scale(std::string_view unit) { return unit == "bit/s" ? 1 : kPicosecondsPerMicrosecond; }

template <class Struct> std::string value_text(const Struct& parameters, std::string_view name, bool fibex) {
  const auto tables = tables_of(parameters);
  for (const auto& p : tables.integers)
    if (p.name == name) return std::to_string(parameters.*p.member);
  for (const auto& p : tables.scaled)
    if (p.name == name) return scaled_text(parameters.*p.member, fibex ? fibex_scale(p.unit) : p.scale);
  for (const auto& p : tables.flags)
    if (p.name == name) return parameters.*p.member ? "true" : "false";
  TTF_CHECK(false, "{} is no parameter", name);
}

template <class Struct>
std::optional<std::string> set_value(Struct& parameters, std::string_view name, std::string_view text) {
  const auto tables = tables_of(parameters);
  for (const auto& p : tables.integers) {
    if (p.name != name) continue;
    const auto value = parse_scaled(text, 1);
    if (!value || *value < p.low || *value > p.high)
      return fmt::format("must be {}..{}{}{}", p.low, p.high, p.unit.empty() ? "" : " ", p.unit);
    parameters.*p.member = static_cast<int>(*value);
    return std::nullopt;
  }
  for (const auto& p : tables.scaled) {
    if (p.name != name) continue;
    const std::int64_t scale = fibex_scale(p.unit);
    const auto value = parse_scaled(text, scale);
    if (!value || *value < p.low || *value > p.high)
      return fmt::format("must be {}..{} {}, exact to {}", scaled_text(p.low, scale), scaled_text(p.high, scale),
                         scale == 1 ? "bit/s" : "us", scale == 1 ? "1 bit/s" : "1 ps");
    parameters.*p.member = *value;
    return std::nullopt;
  }
  for (const auto& p : tables.flags) {
    if (p.name != name) continue;
    if (text != "true" && text != "false" && text != "1" && text != "0") return "must be true or false";
    parameters.*p.member = text == "true" || text == "1";
    return std::nullopt;
  }
  TTF_CHECK(false, "{} is no parameter", name);
}

}  // namespace

std::string fibex_value(const model::GlobalParameters& parameters, std::string_view name) {
  return value_text(parameters, name, true);
}
std::string fibex_value(const model::NodeParameters& parameters, std::string_view name) {
  return value_text(parameters, name, true);
}
std::string yaml_value(const model::GlobalParameters& parameters, std::string_view name) {
  return value_text(parameters, name, false);
}
std::string yaml_value(const model::NodeParameters& parameters, std::string_view name) {
  return value_text(parameters, name, false);
}
std::optional<std::string> set_fibex_value(model::GlobalParameters& parameters, std::string_view name,
                                           std::string_view text) {
  return set_value(parameters, name, text);
}
std::optional<std::string> set_fibex_value(model::NodeParameters& parameters, std::string_view name,
                                           std::string_view text) {
  return set_value(parameters, name, text);
}

}  // namespace ttf::schedules::exchange::fibex
