#include "schedules/timing/chain/segment.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "schedules/timing/common_multiple.h"

namespace ttf::schedules::timing::chain {
namespace {

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

}  // namespace

Segment::Segment(Link first) : hyperperiod_(first.jobs.cycle()) { links_.push_back(std::move(first)); }

bool Segment::extend(std::span<const Stage> chain, const Link& link) {
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

void Segment::write_at_once() {
  if (links_.size() == 1 && links_.front().end == links_.front().first + 1) links_.front().jobs.write_at_once();
}

Segment::Way Segment::forwards(std::int64_t first_job) const {
  Way way{first_job};
  for (std::size_t l = 1; l < links_.size(); ++l)
    way.push_back(links_[l].jobs.first_reading_from(links_[l - 1].jobs.writes(way.back())));
  return way;
}

Segment::Way Segment::backwards(std::int64_t last_job) const {
  Way way(links_.size(), last_job);
  for (std::size_t l = links_.size() - 1; l > 0; --l)
    way[l - 1] = links_[l - 1].jobs.last_written_by(links_[l].jobs.reads(way[l]));
  return way;
}

Figure Segment::along(std::span<const Stage> chain, const Way& way) const {
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

Figure Segment::reduced_reaction(std::span<const Stage> chain) const {
  Way longest = forwards(0);
  for (std::int64_t job = 1; job < links_.front().jobs.jobs_in(hyperperiod_); ++job)
    if (Way way = forwards(job); written(way) - sampled(way) > written(longest) - sampled(longest))
      longest = std::move(way);
  return along(chain, longest);
}

Figure Segment::reaction(std::span<const Stage> chain) const {
  const Timetable& first = links_.front().jobs;
  const auto missed = [&](const Way& way) { return first.reads(way.front() - 1); };
  Way longest = forwards(0);
  for (std::int64_t job = 1; job < first.jobs_in(hyperperiod_); ++job)
    if (Way way = forwards(job); written(way) - missed(way) > written(longest) - missed(longest))
      longest = std::move(way);
  Figure figure = along(chain, longest);
  const Duration waits = sampled(longest) - missed(longest);
  figure.time += waits;
  figure.shares[links_.front().first].waits += waits;
  return figure;
}

Figure Segment::reduced_age(std::span<const Stage> chain) const {
  Way longest = backwards(0);
  for (std::int64_t job = 1; job < links_.back().jobs.jobs_in(hyperperiod_); ++job)
    if (Way way = backwards(job); written(way) - sampled(way) > written(longest) - sampled(longest))
      longest = std::move(way);
  return along(chain, longest);
}

Figure Segment::age(std::span<const Stage> chain) const {
  const Timetable& last = links_.back().jobs;
  const auto replaced = [&](const Way& way) { return last.writes(way.back() + 1); };
  Way longest = backwards(0);
  for (std::int64_t job = 1; job < last.jobs_in(hyperperiod_); ++job)
    if (Way way = backwards(job); replaced(way) - sampled(way) > replaced(longest) - sampled(longest))
      longest = std::move(way);
  Figure figure = along(chain, longest);
  const Duration stays = replaced(longest) - written(longest);
  figure.time += stays;
  figure.shares[links_.back().end - 1].stays += stays;
  return figure;
}

std::vector<Segment> segments_of(std::span<const Stage> chain, std::size_t first) {
  std::vector<Segment> segments;
  for (const Link& link : links_of(chain, first)) {
    if (!segments.empty() && segments.back().extend(chain, link)) continue;
    if (!segments.empty() && chain[link.first].behind_sender) segments.back().write_at_once();
    segments.emplace_back(link);
  }
  return segments;
}

}  // namespace ttf::schedules::timing::chain
