#include "schedules/timing/chain/end_to_end.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/time.h"
#include "schedules/timing/chain/stage.h"
#include "schedules/timing/chain/timetable.h"
#include "schedules/timing/common_multiple.h"

namespace ttf::schedules::timing::chain {
namespace {

// A periodic stage of a chain, with those that it activates: the stages [first, end).
struct Link {
  std::size_t first;
  std::size_t end;
  Timetable jobs;
};

constexpr std::int64_t kLongestHyperperiod = kLongest.ns * 100;

std::vector<Link> links_of(std::span<const Stage> chain, std::size_t first) {
  std::vector<Link> links;
  while (first < chain.size()) {
    std::size_t end = first + 1;
    Duration behind{};
    for (; end < chain.size() && chain[end].activated; ++end) behind += chain[end].longest;
    links.push_back({.first = first, .end = end, .jobs = Timetable(chain[first], behind)});
    first = end;
  }
  return links;
}

// A part of a chain whose stages have known phases: exact walks over its hyperperiod.
class Segment {
 public:
  explicit Segment(Link first) : hyperperiod_(first.jobs.cycle()) { links_.push_back(std::move(first)); }

  // Adds the link if its phase is known here and the hyperperiod stays within kMostJobs; else returns false.
  bool extend(std::span<const Stage> chain, const Link& link) {
    const std::optional<std::size_t> origin = chain[links_.back().first].origin;
    if (!origin || chain[link.first].origin != origin) return false;
    const auto common = common_multiple(hyperperiod_.ns, link.jobs.cycle().ns, kLongestHyperperiod);
    if (!common) return false;
    const Duration hyperperiod{*common};
    if (link.jobs.jobs_in(hyperperiod) > kMostJobs) return false;
    for (const Link& other : links_)
      if (other.jobs.jobs_in(hyperperiod) > kMostJobs) return false;
    hyperperiod_ = hyperperiod;
    links_.push_back(link);
    return true;
  }
  // Has a single job write as it reads, if no activated stage follows it: the next segment stands behind its sender.
  void write_at_once() {
    if (links_.size() == 1 && links_.front().end == links_.front().first + 1) links_.front().jobs.write_at_once();
  }

  // The figures have shares for all stages of the chain, zero outside.
  Figure reaction(std::span<const Stage> chain) const {
    const Timetable& first = links_.front().jobs;
    const auto missed = [&](const Way& way) { return first.reads(way.front() - 1); };
    const Way longest =
        longest_of(first, &Segment::forwards, [&](const Way& way) { return written(way) - missed(way); });
    Figure figure = along(chain, longest);
    const Duration waits = sampled(longest) - missed(longest);
    figure.time += waits;
    figure.shares[links_.front().first].waits += waits;
    return figure;
  }
  Figure reduced_reaction(std::span<const Stage> chain) const {
    return along(chain, longest_of(links_.front().jobs, &Segment::forwards,
                                   [this](const Way& way) { return written(way) - sampled(way); }));
  }
  Figure age(std::span<const Stage> chain) const {
    const Timetable& last = links_.back().jobs;
    const auto replaced = [&](const Way& way) { return last.writes(way.back() + 1); };
    const Way longest =
        longest_of(last, &Segment::backwards, [&](const Way& way) { return replaced(way) - sampled(way); });
    Figure figure = along(chain, longest);
    const Duration stays = replaced(longest) - written(longest);
    figure.time += stays;
    figure.shares[links_.back().end - 1].stays += stays;
    return figure;
  }
  Figure reduced_age(std::span<const Stage> chain) const {
    return along(chain, longest_of(links_.back().jobs, &Segment::backwards,
                                   [this](const Way& way) { return written(way) - sampled(way); }));
  }

 private:
  using Way = std::vector<std::int64_t>;  // the job of each link

  // The longest way of the jobs in a hyperperiod.
  template <class Length>
  Way longest_of(const Timetable& jobs, Way (Segment::*way_of)(std::int64_t) const, const Length& length) const {
    Way longest = (this->*way_of)(0);
    for (std::int64_t job = 1; job < jobs.jobs_in(hyperperiod_); ++job)
      if (Way way = (this->*way_of)(job); length(way) > length(longest)) longest = std::move(way);
    return longest;
  }
  Way forwards(std::int64_t first_job) const {
    Way way{first_job};
    for (std::size_t l = 1; l < links_.size(); ++l)
      way.push_back(links_[l].jobs.first_reading_from(links_[l - 1].jobs.writes(way.back())));
    return way;
  }
  Way backwards(std::int64_t last_job) const {
    Way way(links_.size(), last_job);
    for (std::size_t l = links_.size() - 1; l > 0; --l)
      way[l - 1] = links_[l - 1].jobs.last_written_by(links_[l].jobs.reads(way[l]));
    return way;
  }
  Duration sampled(const Way& way) const { return links_.front().jobs.reads(way.front()); }
  Duration written(const Way& way) const { return links_.back().jobs.writes(way.back()); }
  Figure along(std::span<const Stage> chain, const Way& way) const {
    Figure figure{.time = written(way) - sampled(way), .shares = std::vector<Share>(chain.size())};
    for (std::size_t l = 0; l < links_.size(); ++l) {
      const Link& link = links_[l];
      if (l > 0) figure.shares[link.first].waits = link.jobs.reads(way[l]) - links_[l - 1].jobs.writes(way[l - 1]);
      Duration runs = link.jobs.writes(way[l]) - link.jobs.reads(way[l]);
      for (std::size_t s = link.first + 1; s < link.end; ++s) {
        figure.shares[s].runs = chain[s].longest;
        runs -= chain[s].longest;
      }
      figure.shares[link.first].runs = runs;
    }
    return figure;
  }

  std::vector<Link> links_;
  Duration hyperperiod_;
};

// Returns the segments of the stages from `first` on, which is periodic.
std::vector<Segment> segments_of(std::span<const Stage> chain, std::size_t first) {
  std::vector<Segment> segments;
  for (const Link& link : links_of(chain, first)) {
    if (!segments.empty() && segments.back().extend(chain, link)) continue;
    if (!segments.empty() && chain[link.first].behind_sender) segments.back().write_at_once();
    segments.emplace_back(link);
  }
  return segments;
}

void add(Figure& sum, const Figure& part) {
  sum.time += part.time;
  for (std::size_t s = 0; s < sum.shares.size(); ++s) {
    sum.shares[s].waits += part.shares[s].waits;
    sum.shares[s].runs += part.shares[s].runs;
    sum.shares[s].stays += part.shares[s].stays;
  }
}

// The stages [0, end), which are activated.
Figure activated_part(std::span<const Stage> stages, std::size_t end) {
  Figure figure{.time = {}, .shares = std::vector<Share>(stages.size())};
  for (std::size_t s = 0; s < end; ++s) {
    TTF_CHECK(stages[s].longest >= Duration{} && stages[s].longest <= kLongest, "{}: takes {} ns", stages[s].name,
              stages[s].longest.ns);
    figure.time += stages[s].longest;
    figure.shares[s].runs = stages[s].longest;
  }
  return figure;
}

}  // namespace

EndToEnd end_to_end(std::span<const Stage> stages) {
  TTF_CHECK(!stages.empty(), "a chain of {} stages", stages.size());
  std::size_t first = 0;
  while (first < stages.size() && stages[first].activated) ++first;
  const Figure before = activated_part(stages, first);
  EndToEnd times{.reaction = before, .reduced_reaction = before, .age = {}, .reduced_age = {}, .exact = false};
  const std::vector<Segment> segments = segments_of(stages, first);
  const std::size_t parts = segments.size() + (first > 0 ? 1 : 0);
  times.exact = parts == 1 && std::ranges::all_of(stages, &Stage::exact);
  if (segments.empty()) times.reduced_age = before;
  if (first == 0) times.age = times.reduced_age = before;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Figure reaction = segments[s].reaction(stages);
    add(times.reaction, reaction);
    add(times.reduced_reaction, s == 0 && first == 0 ? segments[s].reduced_reaction(stages) : reaction);
    if (first > 0) continue;
    const Figure age = segments[s].age(stages);
    add(*times.age, age);
    add(*times.reduced_age, s + 1 == segments.size() ? segments[s].reduced_age(stages) : age);
  }
  return times;
}

}  // namespace ttf::schedules::timing::chain
