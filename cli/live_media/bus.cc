#include "cli/live_media/bus.h"

#include <fmt/format.h>
#include <net/if.h>

#include <algorithm>
#include <cctype>

#include "core/errors.h"

namespace ttf::cli::live_media {
namespace {

InputError refused(const std::string& text) {
  std::vector<std::string_view> expectations;
  for (const LiveMediumRow* const medium : kLiveMedia) expectations.push_back(medium->expectation);
  return InputError({"command line", 0, "--bus", text,
                     fmt::format("must be {} (each {})", fmt::join(expectations, ", or "), kInterfaceNames)});
}

// Returns the parts between commas; an empty text has one part, which is empty.
std::vector<std::string> parts_of(std::string_view list) {
  std::vector<std::string> parts;
  for (std::size_t comma = 0; comma != std::string_view::npos; list.remove_prefix(comma + 1)) {
    comma = list.find(',');
    parts.emplace_back(list.substr(0, comma));
    if (comma == std::string_view::npos) break;
  }
  return parts;
}

bool are_different(const std::vector<std::string>& texts) {
  for (auto one = texts.begin(); one != texts.end(); ++one)
    if (std::find(texts.begin(), one, *one) != one) return false;
  return true;
}

}  // namespace

bool is_interface_name(std::string_view name) {
  return !name.empty() && name.size() < IFNAMSIZ && name != "." && name != ".." &&
         std::ranges::none_of(name, [](char c) {
           return c == '/' || c == ':' || c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0 ||
                  static_cast<unsigned char>(c) < 0x20;
         });
}

Bus Bus::parse(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto named = std::ranges::find(kLiveMedia, text.substr(0, colon), &LiveMediumRow::name);
  if (named == kLiveMedia.end()) throw refused(text);
  Bus bus{*named, {}};
  if (colon != std::string::npos) bus.interfaces = parts_of(std::string_view(text).substr(colon + 1));
  const std::size_t count = bus.interfaces.size();
  if (count < bus.medium->least_interfaces || count > bus.medium->most_interfaces ||
      !std::ranges::all_of(bus.interfaces, is_interface_name) || !are_different(bus.interfaces))
    throw refused(text);
  return bus;
}

std::string Bus::text() const {
  return fmt::format("{}{}{}", medium->name, interfaces.empty() ? "" : ":", fmt::join(interfaces, ","));
}

bool Bus::carries(schedules::model::Channel channel) const {
  return !medium->has_interfaces() || index_of(channel) < interfaces.size();
}

std::string bus_help() {
  std::string help;
  for (const LiveMediumRow* const medium : kLiveMedia)
    help += fmt::format("{}{}{}", help.empty() ? "" : ", or ", medium->form,
                        medium == kLiveMedia.front() ? " (default)" : medium->form_help);
  return help;
}

std::string forms_with_interfaces() {
  std::string forms;
  for (const LiveMediumRow* const medium : kLiveMedia)
    if (medium->has_interfaces()) forms += fmt::format("{}{}", forms.empty() ? "" : " or ", medium->form);
  return forms;
}

std::vector<supervision::PreflightItem> look_at(const Bus& bus, const std::vector<PrivateCan>& cans) {
  return bus.medium->look_at(bus.interfaces, cans);
}

}  // namespace ttf::cli::live_media
