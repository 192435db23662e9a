// The folder of one launch: what every node writes, what it prints, all words in one text, and manifest.json, which
// says what was started, with which input, and how it ended.
//
//   manifest.json      from the start on; completed at the end, also when the launch was stopped. It is replaced whole,
//                      so a reader, or a kill at any instant, finds a complete one
//   launch.log         all words of the launch, as on the screen, without colour
//   NODE.mcap          the node's own log: the node writes it, the supervisor only names it
//   launch.lock        whose folder it is (cli/supervision/folder_lock.h)
//   NODE.txt           what the node's processes printed, byte for byte, one after the other
//
// A node's name becomes a file's with every character but letters, digits, '_', '-' and inner '.' as %XX: no name leads
// elsewhere, no two are the same.
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

// What the manifest of a folder says of the launch that was in it.
struct EarlierLaunch {
  std::string strategy;  // empty where it says none, or what could not be part of a file's name
  std::vector<std::string> nodes;
};
// Nothing where there has been none, or what is there cannot be read.
std::optional<EarlierLaunch> earlier_launch(const std::string& folder);

class LaunchFolder {
 public:
  // Makes the folder, which is this launch's alone from then on, and writes the manifest: `facts` (an object: command
  // line, scenario, seed, hashes) first, then state and nodes. Throws InputError where another launch has it,
  // std::runtime_error where the folder or a file cannot be written.
  LaunchFolder(std::string folder, nlohmann::ordered_json facts, WallInstant now);

  struct Entry {
    std::string name;
    std::string policy;
    std::vector<std::string> command;
  };
  // In the order of the launch. Throws std::runtime_error where its text file cannot be written.
  std::size_t add_node(const Entry& entry);

  const std::string& folder() const { return folder_; }
  std::string log_path(std::string_view node) const { return folder_ + "/" + file_stem(node) + ".mcap"; }
  // What is there of a node's logs: NODE.mcap and, of processes that took its place, NODE.2.mcap, NODE.3.mcap and so
  // on.
  std::vector<std::string> logs_of(std::string_view node) const;
  std::vector<std::string> logs() const;  // of all nodes, in the order of the launch
  void remove_logs(std::string_view node) const;
  // Of a file that launches leave here; one that is not there, or no plain file, is left alone.
  void remove(const std::string& name) const;
  Descriptor open_launch_log() const;

  // A node's text file gets what its process printed.
  void output(std::size_t node, std::string_view bytes);
  void process_began(std::size_t node, pid_t pid, WallInstant now);
  // Without pid where it could not even be started.
  void process_ended(std::size_t node, const Ending& ending, WallInstant now, std::string_view why = "");
  void set(std::string_view key, nlohmann::ordered_json value) { facts_[std::string(key)] = std::move(value); }
  // "starting", "running", "stopping", "ended"
  void state(std::string_view word) { state_ = word; }
  void finish(int exit_code, std::string_view why, WallInstant now);

  // Writes manifest.json anew. What cannot be written throws std::runtime_error.
  void write() const;
  // What it says.
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
