#include "recording/mcap/metadata.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>

#include "recording/mcap/bytes.h"
#include "recording/mcap/chunk.h"

namespace ttf::recording::mcap {
namespace {

struct Candidate {
  std::size_t at = 0;
  std::size_t entries = 0, end = 0;  // where its entries begin and must end
};

std::optional<Candidate> candidate_at(std::string_view bytes, std::size_t at) {
  const auto record = record_at(bytes, at);
  if (!record) return std::nullopt;
  FieldReader fields(record->content);
  fields.text();
  const std::string_view entries = fields.text();
  if (!fields.done()) return std::nullopt;
  const std::size_t end = at + kRecordHead + record->content.size();
  return Candidate{at, end - entries.size(), end};
}

// Returns where the entry at `at` ends; no value if it does not fit into the file.
std::optional<std::size_t> entry_end(std::string_view bytes, std::size_t at) {
  FieldReader fields(bytes.substr(at));
  fields.text();
  fields.text();
  if (!fields.ok()) return std::nullopt;
  return bytes.size() - fields.rest().size();
}

// Follows the entries of all candidates, from the front of the file to its end.
class Followed {
 public:
  Followed(std::string_view bytes, std::vector<Candidate> candidates)
      : bytes_(bytes), candidates_(std::move(candidates)), group_(candidates_.size()), last_(candidates_.size()) {
    std::iota(group_.begin(), group_.end(), 0u);
    for (std::uint32_t c = 0; c < candidates_.size(); ++c) {
      last_[c] = candidates_[c].end;
      by_end_.push_back(c);
      waiting_.push({candidates_[c].entries, c});
    }
    std::sort(by_end_.begin(), by_end_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return candidates_[a].end < candidates_[b].end; });
  }

  std::vector<std::size_t> consistent(std::uint64_t& work) {
    std::vector<std::size_t> found;
    auto ending = by_end_.begin();
    while (!waiting_.empty()) {
      const std::size_t at = waiting_.top().first;
      const std::uint32_t group = all_at(at);
      ++work;
      while (ending != by_end_.end() && candidates_[*ending].end < at) ++ending;
      for (; ending != by_end_.end() && candidates_[*ending].end == at; ++ending)
        if (group_of(*ending) == group) found.push_back(candidates_[*ending].at);
      if (at >= last_[group]) continue;
      if (const auto next = entry_end(bytes_, at)) waiting_.push({*next, group});
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  // Joins all that have come to `at`, and takes them from the waiting ones.
  std::uint32_t all_at(std::size_t at) {
    const std::uint32_t group = group_of(waiting_.top().second);
    for (; !waiting_.empty() && waiting_.top().first == at; waiting_.pop()) {
      const std::uint32_t other = group_of(waiting_.top().second);
      group_[other] = group;
      last_[group] = std::max(last_[group], last_[other]);
    }
    return group;
  }
  std::uint32_t group_of(std::uint32_t candidate) {
    while (group_[candidate] != candidate) candidate = group_[candidate] = group_[group_[candidate]];
    return candidate;
  }

  std::string_view bytes_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> group_;  // a tree of candidates; its root is the group
  std::vector<std::size_t> last_;     // by group: the last end of its candidates
  std::vector<std::uint32_t> by_end_;
  using Waiting = std::pair<std::size_t, std::uint32_t>;  // where the next entry begins, and a candidate of the group
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
};

}  // namespace

bool read_metadata(std::string_view content, std::string_view& name,
                   std::vector<std::pair<std::string, std::string>>* entries) {
  FieldReader fields(content);
  name = fields.text();
  FieldReader map(fields.text());
  if (!fields.done()) return false;
  while (map.ok() && !map.rest().empty()) {
    const std::string_view key = map.text();
    const std::string_view value = map.text();
    if (map.ok() && entries != nullptr) entries->emplace_back(key, value);
  }
  return map.ok();
}

std::vector<std::size_t> consistent_metadata(std::string_view bytes, std::size_t from, std::uint64_t& work) {
  std::vector<Candidate> candidates;
  work += bytes.size() - std::min(from, bytes.size());
  for (std::size_t at = from; (at = bytes.find(static_cast<char>(Opcode::kMetadata), at)) != std::string_view::npos;
       ++at)
    if (const auto candidate = candidate_at(bytes, at)) candidates.push_back(*candidate);
  work += candidates.size();
  return Followed(bytes, std::move(candidates)).consistent(work);
}

}  // namespace ttf::recording::mcap
