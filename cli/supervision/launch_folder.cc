#include "cli/supervision/launch_folder.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cctype>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "cli/output.h"
#include "core/check.h"
#include "core/errors.h"

namespace ttf::cli::supervision {
namespace {

Descriptor opened(const std::string& path) {
  Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file.open()) throw std::runtime_error(path + ": cannot be written: " + system_message(errno));
  return file;
}

nlohmann::ordered_json time_or_null(const std::optional<WallInstant>& instant) {
  return instant ? nlohmann::ordered_json(utc_text(*instant)) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string utc_text(WallInstant instant) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(instant.time_since_epoch()).count();
  const std::time_t seconds = static_cast<std::time_t>(ms / 1000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", utc, ms % 1000);
}

std::string file_stem(std::string_view node) {
  std::string stem;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto byte = static_cast<unsigned char>(node[i]);
    const bool plain = (byte < 0x80 && std::isalnum(byte) != 0) || byte == '_' || byte == '-' ||
                       (byte == '.' && i > 0 && i + 1 < node.size());
    stem += plain ? std::string(1, node[i]) : fmt::format("%{:02X}", byte);
  }
  return stem.empty() ? "%" : stem;
}

std::optional<EarlierLaunch> earlier_launch(const std::string& folder) {
  std::ifstream file(folder + "/manifest.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || !json.contains("nodes") || !json["nodes"].is_array()) return std::nullopt;
  const auto text = [](const nlohmann::json& of, const char* key) {
    return of.is_object() && of.contains(key) && of[key].is_string() ? of[key].get<std::string>() : std::string();
  };
  EarlierLaunch earlier{text(json, "strategy"), {}};
  // The strategy becomes part of file names, so it must not lead elsewhere.
  if (file_stem(earlier.strategy) != earlier.strategy) earlier.strategy.clear();
  for (const nlohmann::json& node : json["nodes"])
    if (std::string name = text(node, "name"); !name.empty()) earlier.nodes.push_back(std::move(name));
  return earlier;
}

LaunchFolder::LaunchFolder(std::string folder, nlohmann::ordered_json facts, WallInstant now)
    : folder_(std::move(folder)), facts_(std::move(facts)), began_(now) {
  cli::create_folder(folder_);
  lock_.emplace(folder_);
  write();
}

std::size_t LaunchFolder::add_node(const Entry& entry) {
  nodes_.push_back({entry, entry.external ? Descriptor() : opened(folder_ + "/" + file_stem(entry.name) + ".txt"), {}});
  return nodes_.size() - 1;
}

std::vector<std::string> LaunchFolder::logs_of(std::string_view node) const {
  std::vector<std::string> logs;
  std::string log = log_path(node);
  for (int n = 2; std::filesystem::exists(log); ++n) {
    logs.push_back(log);
    log = fmt::format("{}/{}.{}.mcap", folder_, file_stem(node), n);
  }
  return logs;
}

std::vector<std::string> LaunchFolder::logs() const {
  std::vector<std::string> all;
  for (const Node& node : nodes_)
    for (std::string& log : logs_of(node.entry.name)) all.push_back(std::move(log));
  return all;
}

void LaunchFolder::remove_logs(std::string_view node) const {
  for (const std::string& log : logs_of(node)) std::filesystem::remove(log);
}

void LaunchFolder::remove(const std::string& name) const {
  TTF_CHECK(name.find('/') == std::string::npos, "{} is not in the folder", name);
  const std::filesystem::path path(folder_ + "/" + name);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
}

Descriptor LaunchFolder::open_launch_log() const { return opened(folder_ + "/launch.log"); }

void LaunchFolder::output(std::size_t node, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(nodes_[node].text.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throw std::runtime_error(fmt::format("{}/{}.txt: cannot be written: {}", folder_,
                                           file_stem(nodes_[node].entry.name), system_message(errno)));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void LaunchFolder::process_began(std::size_t node, pid_t pid, WallInstant now) {
  nodes_[node].processes.push_back({pid, now, std::nullopt, std::nullopt, ""});
}

void LaunchFolder::process_ended(std::size_t node, const Ending& ending, WallInstant now, std::string_view why) {
  auto& processes = nodes_[node].processes;
  if (processes.empty() || processes.back().ended)
    processes.push_back({std::nullopt, now, std::nullopt, std::nullopt, ""});
  processes.back().ended = now;
  processes.back().ending = ending;
  processes.back().why = why;
}

void LaunchFolder::finish(int exit_code, std::string_view why, WallInstant now) {
  state_ = "ended";
  exit_code_ = exit_code;
  why_ = why;
  ended_ = now;
  write();
}

nlohmann::ordered_json LaunchFolder::json() const {
  nlohmann::ordered_json json = facts_;
  json["state"] = state_;
  json["began"] = utc_text(began_);
  json["ended"] = time_or_null(ended_);
  json["exit_code"] = exit_code_ ? nlohmann::ordered_json(*exit_code_) : nlohmann::ordered_json(nullptr);
  json["why"] = why_;
  json["nodes"] = nlohmann::ordered_json::array();
  for (const Node& node : nodes_) {
    if (node.entry.external) {
      json["nodes"].push_back({{"name", node.entry.name},
                               {"policy", node.entry.policy},
                               {"external", true},
                               {"processes", nlohmann::ordered_json::array()}});
      continue;
    }
    const std::string stem = file_stem(node.entry.name);
    nlohmann::ordered_json one{{"name", node.entry.name},
                               {"policy", node.entry.policy},
                               {"command", node.entry.command},
                               {"log", stem + ".mcap"},
                               {"output", stem + ".txt"}};
    one["processes"] = nlohmann::ordered_json::array();
    for (const Process& process : node.processes) {
      nlohmann::ordered_json p;
      p["pid"] = process.pid ? nlohmann::ordered_json(*process.pid) : nlohmann::ordered_json(nullptr);
      p["began"] = utc_text(process.began);
      p["ended"] = time_or_null(process.ended);
      const auto value_if = [&](bool by_signal) {
        const bool given = process.ending && process.ending->by_signal == by_signal;
        return given ? nlohmann::ordered_json(process.ending->value) : nlohmann::ordered_json(nullptr);
      };
      p["exit"] = value_if(false);
      p["signal"] = value_if(true);
      if (!process.why.empty()) p["why"] = process.why;
      one["processes"].push_back(std::move(p));
    }
    json["nodes"].push_back(std::move(one));
  }
  return json;
}

void LaunchFolder::write() const {
  const std::string path = folder_ + "/manifest.json", next = path + ".new";
  // Names and arguments may hold any bytes: invalid UTF-8 is replaced, not refused.
  cli::write_file(next, json().dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
  std::error_code failure;
  std::filesystem::rename(next, path, failure);
  if (failure) throw std::runtime_error(path + ": cannot be written: " + failure.message());
}

}  // namespace ttf::cli::supervision
