// Any bytes as a log. Laws: only InputError ends the reading. Every warning is a line that names the file.
// Counts are those of the records handed on. Records written again are read the same, without a warning.
// Merging the log alone gives the same records, in an order that merging again keeps.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/check.h"
#include "recording/log/reader.h"
#include "recording/log/writer.h"
#include "recording/merge/merge.h"
#include "tests/fuzz/harness.h"
#include "tests/recording/record_text.h"

namespace {

using namespace ttf;

constexpr char kFile[] = "drive.mcap";

// A file in memory, by a path that can be opened.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("log", MFD_CLOEXEC)) { TTF_CHECK(descriptor_ >= 0, "no memory file"); }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void check_written_again(std::string_view bytes, const recording::log::LogInfo& info, const recording::TextSink& read) {
  const MemoryFile file;
  recording::log::LogWriter writer(file.path(), info.manifest);
  recording::log::read_log_bytes(bytes, kFile, writer);
  writer.close();
  recording::TextSink again;
  const recording::log::LogInfo info_again = recording::log::read_log(file.path(), again);
  TTF_CHECK(again.lines == read.lines, "{} records are {}", read.lines.size(), again.lines.size());
  TTF_CHECK(info_again.manifest == info.manifest, "the manifest changed");
  TTF_CHECK(info_again.warning.empty() && !info_again.truncated, "{}", info_again.warning);
  TTF_CHECK(info_again.content_hash == writer.content_hash(), "the content hash changed");
}

std::vector<std::string> lines_of(const recording::merge::MergedLogs& merged) {
  recording::TextSink sink;
  merged.read(sink);
  return std::move(sink.lines);
}
std::vector<recording::merge::StoredLog> written(const recording::merge::MergedLogs& merged) {
  const MemoryFile file;
  recording::log::LogWriter writer(file.path(), merged.manifest());
  merged.read(writer);
  writer.close();
  std::vector<recording::merge::StoredLog> logs;
  logs.emplace_back(file.path());
  return logs;
}

void check_merged(std::string_view bytes, recording::TextSink read) {
  std::vector<recording::merge::StoredLog> logs;
  logs.emplace_back(std::string(bytes), kFile);
  const recording::merge::MergedLogs merged(std::move(logs));
  std::vector<std::string> lines = lines_of(merged);
  // Only logs written by us are compared bytewise: other writers may encode the same number differently.
  const recording::merge::MergedLogs once(written(merged));
  const recording::merge::MergedLogs twice(written(once));
  TTF_CHECK(lines_of(once) == lines_of(twice), "{} records are in another order", lines.size());
  std::sort(lines.begin(), lines.end());
  std::sort(read.lines.begin(), read.lines.end());
  TTF_CHECK(lines == read.lines, "{} records merged are {}", read.lines.size(), lines.size());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  recording::TextSink read;
  recording::log::LogInfo info;
  if (!fuzz::accepted(kFile, [&] { info = recording::log::read_log_bytes(bytes, kFile, read); })) return 0;
  fuzz::check_lines(info.warning, kFile);
  const auto counted = std::accumulate(info.counts.begin(), info.counts.end(), std::uint64_t{0});
  TTF_CHECK(counted == read.lines.size(), "{} records counted, {} handed on", counted, read.lines.size());
  TTF_CHECK(!info.truncated || !info.warning.empty(), "a torn log without a word");
  check_written_again(bytes, info, read);
  check_merged(bytes, std::move(read));
  return 0;
}
