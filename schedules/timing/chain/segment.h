// A part of a chain whose stages know each other's phases: exact walks over its hyperperiod.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/time.h"
#include "schedules/timing/chain/end_to_end.h"
#include "schedules/timing/chain/stage.h"
#include "schedules/timing/chain/timetable.h"

namespace ttf::schedules::timing::chain {

// A periodic stage of a chain, with those that it activates: the stages [first, end).
struct Link {
  std::size_t first;
  std::size_t end;
  Timetable jobs;
};

class Segment {
 public:
  explicit Segment(Link first);

  // Adds the link if its phase is known here and the hyperperiod stays within kMostJobs; else returns false.
  bool extend(std::span<const Stage> chain, const Link& link);
  // Has a single job write as it reads, if no activated stage follows it: the next segment stands behind its sender.
  void write_at_once();

  // The figures have shares for all stages of the chain, zero outside.
  Figure reaction(std::span<const Stage> chain) const;
  Figure reduced_reaction(std::span<const Stage> chain) const;
  Figure age(std::span<const Stage> chain) const;
  Figure reduced_age(std::span<const Stage> chain) const;

 private:
  using Way = std::vector<std::int64_t>;  // the job of each link

  Way forwards(std::int64_t first_job) const;
  Way backwards(std::int64_t last_job) const;
  Duration sampled(const Way& way) const { return links_.front().jobs.reads(way.front()); }
  Duration written(const Way& way) const { return links_.back().jobs.writes(way.back()); }
  Figure along(std::span<const Stage> chain, const Way& way) const;

  std::vector<Link> links_;
  Duration hyperperiod_;
};

// Returns the segments of the stages from `first` on, which is periodic.
std::vector<Segment> segments_of(std::span<const Stage> chain, std::size_t first);

}  // namespace ttf::schedules::timing::chain
