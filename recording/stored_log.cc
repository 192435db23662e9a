#include "recording/stored_log.h"

#include <algorithm>
#include <utility>

#include "core/file_bytes.h"
#include "recording/record_place.h"

namespace ttf::recording {
namespace {

class ChunkTimes final : public Placing {
 public:
  explicit ChunkTimes(std::vector<StoredLog::Chunk>& chunks) : chunks_(chunks) {}

  void begin(std::size_t at, std::size_t size) { next_ = {at, size, {}, {}}; }
  void placed(const RecordPlace& place) override {
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

}  // namespace

StoredLog::StoredLog(const std::string& path) : StoredLog(read_file(path), path) {}

StoredLog::StoredLog(std::string bytes, std::string name) : name_(std::move(name)), bytes_(std::move(bytes)) {
  ChunkTimes times(chunks_);
  info_ = read_log_bytes(bytes_, name_, times, [&](std::string_view content) {
    times.begin(static_cast<std::size_t>(content.data() - bytes_.data()), content.size());
  });
}

}  // namespace ttf::recording
