#include "recording/merge/stored_log.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "core/file_bytes.h"
#include "recording/merge/record_place.h"
#include "recording/records/tee.h"

namespace ttf::recording::merge {
namespace {

// Collects the first and last time of each chunk's records.
class ChunkTimes {
 public:
  explicit ChunkTimes(std::vector<StoredLog::Chunk>& chunks) : chunks_(chunks) {}

  void begin(std::size_t at, std::size_t size) { next_ = {at, size, {}, {}}; }
  void placed(const RecordPlace& place) {
    if (chunks_.empty() || chunks_.back().begin != next_.begin) {
      next_.first = next_.last = place.at;
      chunks_.push_back(next_);
    }
    chunks_.back().first = std::min(chunks_.back().first, place.at);
    chunks_.back().last = std::max(chunks_.back().last, place.at);
  }

 private:
  std::vector<StoredLog::Chunk>& chunks_;
  StoredLog::Chunk next_;
};

class SyncStamps final : public records::Sink {
 public:
  explicit SyncStamps(std::vector<SyncStamp>& stamps) : stamps_(stamps) {}

  using Sink::on;
  void on(const records::ClockCorrected& r) override {
    const bool by_the_cluster = r.stamp.global.ns != r.stamp.local.ns;  // else it has no global time (records::Stamp)
    if (by_the_cluster && possible(r.stamp.true_time.ns) && possible(r.stamp.global.ns))
      stamps_.push_back({r.stamp.node, r.stamp.true_time, r.stamp.global});
  }

 private:
  // Within 36 years of the drive's start: other times, from damaged logs, could overflow.
  static bool possible(std::int64_t ns) {
    constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 60;
    return ns >= -kFarthest_ns && ns <= kFarthest_ns;
  }

  std::vector<SyncStamp>& stamps_;
};

}  // namespace

std::vector<std::string> logs_in(const std::string& folder) {
  std::vector<std::string> logs;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().extension() == ".mcap") logs.push_back(entry.path().string());
  std::sort(logs.begin(), logs.end());
  return logs;
}

StoredLog::StoredLog(const std::string& path) : StoredLog(read_file(path), path) {}

StoredLog::StoredLog(std::string bytes, std::string name) : name_(std::move(name)), bytes_(std::move(bytes)) {
  ChunkTimes times(chunks_);
  const std::unique_ptr<records::Sink> places = placing([&times](const RecordPlace& place) { times.placed(place); });
  SyncStamps stamps(sync_stamps_);
  records::Tee both({places.get(), &stamps});
  info_ = log::read_log_bytes(bytes_, name_, both, [&](std::string_view content) {
    times.begin(static_cast<std::size_t>(content.data() - bytes_.data()), content.size());
  });
  if (info_.manifest.clock != log::kWallClock) sync_stamps_ = {};
}

}  // namespace ttf::recording::merge
