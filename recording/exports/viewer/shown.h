// The entities that a topic of a scene shows.
#pragma once

#include <set>
#include <string>

#include "core/time.h"

namespace foxglove {
class SceneUpdate;
}  // namespace foxglove

namespace ttf::recording::exports::viewer {

class Shown {
 public:
  // Deletes the topic's entities that `update` no longer has.
  void replace_by(::foxglove::SceneUpdate& update, TrueTime at);

 private:
  std::set<std::string> ids_;
};

}  // namespace ttf::recording::exports::viewer
