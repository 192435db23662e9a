// An empty scene, for steps of a cluster whose sensors need a scene.
#pragma once

#include <memory>
#include <vector>

#include "sensors/scene.h"

namespace ttf::fuzz {

class NothingThere final : public sensors::Scene {
 public:
  void states_at(TrueTime, std::vector<sim::world::ObjectState>& out) const override { out.clear(); }
  std::size_t objects() const override { return 0; }
};

inline std::shared_ptr<const sensors::Scene> nothing_there() { return std::make_shared<const NothingThere>(); }

}  // namespace ttf::fuzz
