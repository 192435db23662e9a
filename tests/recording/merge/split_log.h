// Splits one process' log into those of several processes. Each record goes to the log of its node's process,
// records without a node to the first.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "recording/log/reader.h"
#include "recording/log/writer.h"
#include "recording/records/every.h"

namespace ttf::recording::merge {

// Node n is in process n modulo their number.
class ByNode final : public records::Every<ByNode> {
 public:
  explicit ByNode(std::vector<records::Sink*> processes) : processes_(std::move(processes)) {}
  template <class Record> void each(const Record& record) {
    std::size_t node = 0;
    if constexpr (requires { record.stamp; })
      node = index_of(record.stamp.node);
    else if constexpr (requires { record.end.node; })  // a CAN frame or a task's run
      node = index_of(record.end.node);
    else if constexpr (std::is_same_v<Record, records::TruthState> || std::is_same_v<Record, records::EgoTruth>)
      node = index_of(record.node);
    processes_[node % processes_.size()]->on(record);
  }

 private:
  std::vector<records::Sink*> processes_;
};

// The logs of `count` processes, in `folder`: node0.mcap and so on.
inline std::vector<std::string> split_log(const std::string& path, const std::string& folder, std::size_t count) {
  records::Sink nobody;
  const log::LogInfo info = log::read_log(path, nobody);
  std::vector<std::string> paths;
  std::vector<std::unique_ptr<log::LogWriter>> writers;
  std::vector<records::Sink*> sinks;
  for (std::size_t i = 0; i < count; ++i) {
    paths.push_back(folder + "/node" + std::to_string(i) + ".mcap");
    writers.push_back(std::make_unique<log::LogWriter>(paths.back(), info.manifest));
    for (const log::Attachment& one : info.attachments) writers.back()->attach(one.name, one.media_type, one.bytes);
    sinks.push_back(writers.back().get());
  }
  ByNode by_node(sinks);
  log::read_log(path, by_node);
  for (auto& writer : writers) writer->close();
  return paths;
}

}  // namespace ttf::recording::merge
