#include "cli/launch/external/account.h"

#include <fmt/format.h>

#include <utility>

#include "core/counted.h"
#include "report/drawing/tables.h"

namespace ttf::cli::launch::external {
namespace {

using Part = std::pair<std::uint64_t, const char*>;

// Returns the counts that are not zero: "3 late, 1 malformed".
std::string parts_text(const std::vector<Part>& parts) {
  std::vector<std::string> texts;
  for (const auto& [count, what] : parts)
    if (count > 0) texts.push_back(fmt::format("{} {}", count, what));
  return joined(texts);
}

std::vector<Part> wrongs_of(const Counts& counts) {
  return {{counts.early, "early"},
          {counts.late, "late"},
          {counts.all_malformed(), "malformed"},
          {counts.missing, "missing"}};
}

// Returns "2 wrong frame CRC, 1 repeated"; empty without any.
std::string kinds_text(const Counts& counts) {
  std::vector<std::string> texts;
  for (std::size_t kind = 0; kind < kMalformedKinds; ++kind)
    if (counts.malformed[kind] > 0)
      texts.push_back(fmt::format("{} {}", counts.malformed[kind], text_of(static_cast<Malformed>(kind))));
  return joined(texts);
}

}  // namespace

std::string state_text(const Account& account) {
  if (!account.counts.first) return "waiting";
  return account.silent ? fmt::format("silent for {:.1f} s", account.silent->seconds()) : "sending";
}

std::string status_text(const Account& account) {
  std::vector<Part> parts = wrongs_of(account.counts);
  parts.insert(parts.begin(), {account.counts.in_window, "in window"});
  const std::string counted = parts_text(parts);
  return counted.empty() ? state_text(account) : state_text(account) + ", " + counted;
}

std::string table_text(const std::vector<Account>& accounts) {
  if (accounts.empty()) return "";
  report::drawing::Table table({"real node", "frames in\nwindow", "\nearly", "\nlate", "\nmalformed", "\nmissing",
                                "first after\n[s]", "at the\nend"});
  std::string below;
  for (const Account& account : accounts) {
    const Counts& counts = account.counts;
    table.add({account.node, fmt::to_string(counts.in_window), fmt::to_string(counts.early),
               fmt::to_string(counts.late), fmt::to_string(counts.all_malformed()), fmt::to_string(counts.missing),
               account.first ? fmt::format("{:.3f}", account.first->seconds()) : "-", state_text(account)});
    if (const std::string these = kinds_text(counts); !these.empty())
      below += fmt::format("malformed frames of {}: {}\n", account.node, these);
    if (!account.never_received.empty())
      below += fmt::format("never heard of {}: {}\n", account.node, joined(account.never_received));
  }
  return table.text() + below;
}

std::string wrongs_text(const std::vector<Account>& accounts) {
  std::string text;
  for (const Account& account : accounts) {
    std::vector<std::string> wrongs;
    if (const std::string counted = parts_text(wrongs_of(account.counts)); !counted.empty()) wrongs.push_back(counted);
    for (const std::string& name : account.never_received) wrongs.push_back(name + " never heard");
    if (!wrongs.empty()) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", account.node, joined(wrongs));
  }
  return text;
}

std::vector<drive::ExternalNode> reported(const std::vector<Account>& accounts) {
  std::vector<drive::ExternalNode> all;
  for (const Account& account : accounts) {
    const Counts& counts = account.counts;
    drive::ExternalNode& one = all.emplace_back();
    one = {account.node,           counts.in_window,
           counts.early,           counts.late,
           counts.missing,         {{"all", counts.all_malformed()}},
           account.never_received, std::nullopt,
           state_text(account)};
    for (std::size_t kind = 0; kind < kMalformedKinds; ++kind)
      one.malformed.emplace_back(text_of(static_cast<Malformed>(kind)), counts.malformed[kind]);
    if (account.first) one.first_after_s = account.first->seconds();
  }
  return all;
}

}  // namespace ttf::cli::launch::external
