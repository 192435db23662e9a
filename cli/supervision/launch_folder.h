// The folder of one launch: every node's log and output, all output in one text, and manifest.json with the
// processes and their ends.
//
//   manifest.json      from the start on; completed at the end, also of a stopped launch. It is replaced whole, so a
//                      reader, or a kill at any instant, finds a complete one
//   launch.log         all words of the launch, as on the screen, without colour
//   NODE.mcap          the node's own log: the node writes it, the supervisor only names it
//   launch.lock        marks the owner of the folder (cli/supervision/folder_lock.h)
//   NODE.txt           the output of the node's processes, byte for byte, one after the other
//
// A file name is the node's name with %XX for every character except letters, digits, '_', '-' and inner '.'.
// So no name leads elsewhere, and no two are the same.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/supervision/child.h"
#include "cli/supervision/descriptor.h"
#include "cli/supervision/folder_lock.h"

namespace ttf::cli::supervision {

using WallInstant = std::chrono::system_clock::time_point;

// "2026-01-31T23:59:59.123Z"
std::string utc_text(WallInstant instant);
std::string file_stem(std::string_view node);

// The facts about an earlier launch from its folder's manifest.
struct EarlierLaunch {
  std::string strategy;  // empty if missing, or unfit for a file name
  std::vector<std::string> nodes;
};
// Returns no value without a readable manifest.
std::optional<EarlierLaunch> earlier_launch(const std::string& folder);

class LaunchFolder {
 public:
  // Makes the folder, locks it for this launch and writes the manifest: first `facts` (an object: command
  // line, scenario, seed, hashes), then state and nodes. Throws InputError if another launch holds the
  // folder, std::runtime_error if the folder or a file cannot be written.
  LaunchFolder(std::string folder, nlohmann::ordered_json facts, WallInstant now);

  struct Entry {
    std::string name;
    std::string policy;
    std::vector<std::string> command;
    bool external = false;  // a device: it has no processes, no output and no log
  };
  // Adds a node, in the order of the launch. Throws std::runtime_error if its text file cannot be written; an external node
  // has none.
  std::size_t add_node(const Entry& entry);

  const std::string& folder() const { return folder_; }
  std::string log_path(std::string_view node) const { return folder_ + "/" + file_stem(node) + ".mcap"; }
  // Returns a node's existing logs: NODE.mcap, and NODE.2.mcap, NODE.3.mcap and so on of later processes.
  std::vector<std::string> logs_of(std::string_view node) const;
  std::vector<std::string> logs() const;  // for all nodes, in the order of the launch
  void remove_logs(std::string_view node) const;
  // Removes a file of a launch; a missing file, or one that is no plain file, stays as it is.
  void remove(const std::string& name) const;
  Descriptor open_launch_log() const;

  // Appends a process' output to its node's text file.
  void output(std::size_t node, std::string_view bytes);
  void process_began(std::size_t node, pid_t pid, WallInstant now);
  // Called without process_began() if the process could not even start.
  void process_ended(std::size_t node, const Ending& ending, WallInstant now, std::string_view why = "");
  void set(std::string_view key, nlohmann::ordered_json value) { facts_[std::string(key)] = std::move(value); }
  // "starting", "running", "stopping", "ended"
  void state(std::string_view word) { state_ = word; }
  void finish(int exit_code, std::string_view why, WallInstant now);

  // Writes manifest.json anew. Throws std::runtime_error on failure.
  void write() const;
  // Returns the manifest's content.
  nlohmann::ordered_json json() const;

 private:
  struct Process {
    std::optional<pid_t> pid;
    WallInstant began;
    std::optional<WallInstant> ended;
    std::optional<Ending> ending;
    std::string why;
  };
  struct Node {
    Entry entry;
    Descriptor text;
    std::vector<Process> processes;
  };
  std::string folder_;
  std::optional<FolderLock> lock_;
  nlohmann::ordered_json facts_;
  std::string state_ = "starting";
  WallInstant began_;
  std::optional<WallInstant> ended_;
  std::optional<int> exit_code_;
  std::string why_;
  std::vector<Node> nodes_;
};

}  // namespace ttf::cli::supervision
