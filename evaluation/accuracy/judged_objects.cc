#include "evaluation/accuracy/judged_objects.h"

#include "core/check.h"

namespace ttf::evaluation::accuracy {

JudgedObjects judged_objects(std::span<const fusion::metrics::Point> truths, const std::vector<bool>& in_view,
                             std::span<const fusion::metrics::Point> shown, double gate_m) {
  TTF_CHECK(in_view.size() == truths.size(), "{} of {} truths", in_view.size(), truths.size());
  JudgedObjects judged;
  judged.pairs = fusion::metrics::object_pairs(truths, shown, gate_m);
  std::vector<bool> counts(shown.size(), true);
  for (const fusion::metrics::ObjectPair& pair : judged.pairs)
    if (!in_view[pair.truth]) counts[pair.estimate] = false;
  std::erase_if(judged.pairs, [&](const fusion::metrics::ObjectPair& pair) { return !in_view[pair.truth]; });
  for (std::size_t i = 0; i < truths.size(); ++i)
    if (in_view[i]) judged.truths.push_back(i);
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (counts[i]) judged.shown.push_back(i);
  return judged;
}

}  // namespace ttf::evaluation::accuracy
