#include "cli/supervision/preflight.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/supervision/lines.h"

namespace ttf::cli::supervision {
bool all_good(const std::vector<PreflightItem>& items) {
  return std::ranges::all_of(items, [](const PreflightItem& item) { return item.good; });
}

std::string text_of(const std::vector<PreflightItem>& items) {
  std::string text;
  for (const PreflightItem& item : items) {
    text += fmt::format("{}: {} {}{}\n", item.good ? "ok" : "not ready", printable(item.what), printable(item.how),
                        item.commands.empty() ? "" : "; as root:");
    for (const std::string& command : item.commands) text += fmt::format("    {}\n", printable(command));
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<PreflightItem>& items) {
  auto list = nlohmann::ordered_json::array();
  for (const PreflightItem& item : items)
    list.push_back({{"what", item.what}, {"good", item.good}, {"how", item.how}, {"commands", item.commands}});
  return list;
}

}  // namespace ttf::cli::supervision
