#include <algorithm>

#include "core/counted.h"
#include "experiments/sweep/file.h"

namespace ttf::experiments::sweep {

std::vector<const Axis*> SweepFile::grid() const {
  std::vector<const Axis*> some;
  for (const Axis& axis : axes)
    if (!axis.random()) some.push_back(&axis);
  return some;
}

std::vector<const Axis*> SweepFile::drawn() const {
  std::vector<const Axis*> some;
  for (const Axis& axis : axes)
    if (axis.random()) some.push_back(&axis);
  return some;
}

std::size_t SweepFile::points() const {
  std::size_t count = 1;
  for (const Axis* axis : grid()) count = std::min(count * axis->settings.size(), kMostPoints + 1);
  return count;
}

std::uint64_t SweepFile::drives() const { return std::uint64_t{replications} * paradigms.size() * points(); }

std::vector<const Setting*> SweepFile::settings_of(std::uint32_t point) const {
  const std::vector<const Axis*> axes_here = grid();
  std::vector<const Setting*> settings(axes_here.size());
  for (std::size_t a = axes_here.size(); a-- > 0;) {
    const std::size_t count = axes_here[a]->settings.size();
    settings[a] = &axes_here[a]->settings[point % count];
    point /= static_cast<std::uint32_t>(count);
  }
  return settings;
}

std::string SweepFile::label_of(std::uint32_t point) const {
  std::vector<std::string> parts;
  const auto settings = settings_of(point);
  const auto axes_here = grid();
  for (std::size_t a = 0; a < settings.size(); ++a) parts.push_back(axes_here[a]->name + " " + settings[a]->label);
  return parts.empty() ? "the one point" : joined(parts);
}

std::string SweepFile::label_without(std::uint32_t point, std::size_t axis) const {
  std::vector<std::string> parts;
  const auto settings = settings_of(point);
  const auto axes_here = grid();
  for (std::size_t a = 0; a < settings.size(); ++a)
    if (a != axis && axes_here[a]->settings.size() > 1) parts.push_back(axes_here[a]->name + " " + settings[a]->label);
  return joined(parts);
}

std::uint32_t SweepFile::moved(std::uint32_t point, std::size_t axis, std::size_t setting) const {
  const std::vector<const Axis*> axes_here = grid();
  std::uint32_t stride = 1;
  for (std::size_t a = axis + 1; a < axes_here.size(); ++a)
    stride *= static_cast<std::uint32_t>(axes_here[a]->settings.size());
  const auto count = static_cast<std::uint32_t>(axes_here[axis]->settings.size());
  return point + (static_cast<std::uint32_t>(setting) - point / stride % count) * stride;
}

std::optional<Reference> SweepFile::reference_of(std::uint32_t point, std::size_t paradigm) const {
  const Reference reference = compared_axis
                                  ? Reference{moved(point, compared_axis->axis, compared_axis->baseline), paradigm}
                                  : Reference{point, baseline};
  if (reference.point == point && reference.paradigm == paradigm) return std::nullopt;
  return reference;
}

}  // namespace ttf::experiments::sweep
