// The account of a real node at the end of a drive: in a table, in words and for summary.json.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/drive/launch_findings.h"
#include "cli/launch/external/judge.h"
#include "core/time.h"

namespace ttf::cli::launch::external {

struct Account {
  std::string node;
  Counts counts;
  std::optional<Duration> first;                 // the first frame, from the begin of the drive
  std::optional<Duration> silent;                // for how long, if for too long
  std::vector<std::string> never_received = {};  // lists and lines of a node that was received
};

// Returns "waiting", "sending", "silent for 1.2 s".
std::string state_text(const Account& account);
// Returns the state and all that was counted, without zeros: "sending, 812 in window, 3 late".
std::string status_text(const Account& account);

// Returns one table, and below it lines for nodes with malformed frames or lists that never came. Empty without
// accounts.
std::string table_text(const std::vector<Account>& accounts);
// Returns what was not as it should be, for the verdict: "camera_pre: 3 early, 1 late; camera: 2 missing". Empty if
// nothing.
std::string wrongs_text(const std::vector<Account>& accounts);
std::vector<drive::ExternalNode> reported(const std::vector<Account>& accounts);

}  // namespace ttf::cli::launch::external
