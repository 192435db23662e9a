// Any text as a task set. Laws: it is refused in lines, or its verdict is finite. Then MRT = MDA, and shares add up.
// Reduced times are no longer than full ones. Texts have no control characters.
#include <algorithm>

#include "core/check.h"
#include "schedules/timing/task_set/reader.h"
#include "schedules/timing/task_set/verdict.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using schedules::timing::chain::EndToEnd;
using schedules::timing::chain::Figure;
using schedules::timing::chain::Share;

void check_figure(const Figure& figure) {
  Duration sum{};
  for (const Share& share : figure.shares) {
    TTF_CHECK(share.waits.ns >= 0 && share.runs.ns >= 0 && share.stays.ns >= 0, "a share of {}, {}, {} ns",
              share.waits.ns, share.runs.ns, share.stays.ns);
    sum += share.waits + share.runs + share.stays;
  }
  TTF_CHECK(sum == figure.time, "shares of {} ns make {} ns", sum.ns, figure.time.ns);
}

void check_times(const EndToEnd& times) {
  check_figure(times.reaction);
  check_figure(times.reduced_reaction);
  TTF_CHECK(times.reduced_reaction.time <= times.reaction.time, "reduced {} ns of {} ns",
            times.reduced_reaction.time.ns, times.reaction.time.ns);
  if (times.reduced_age) check_figure(*times.reduced_age);
  if (!times.age) return;
  check_figure(*times.age);
  TTF_CHECK(times.age->time == times.reaction.time, "age {} ns, reaction {} ns", times.age->time.ns,
            times.reaction.time.ns);
  TTF_CHECK(times.reduced_age->time <= times.age->time, "reduced {} ns of {} ns", times.reduced_age->time.ns,
            times.age->time.ns);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace sets = schedules::timing::task_set;
  constexpr char kFile[] = "set.csv";
  sets::TaskSet set;
  if (!fuzz::accepted(kFile, [&] { set = sets::parse_task_set(fuzz::text_of(data, size), kFile); })) return 0;
  const sets::Verdict verdict = sets::verdict_on(set);
  for (const sets::ChainTiming& timing : verdict.chains)
    if (timing.times) check_times(*timing.times);
  for (const char c : verdict_text(set, verdict)) TTF_CHECK(c == '\n' || (c >= ' ' && c <= '~'), "a control character");
  return 0;
}
