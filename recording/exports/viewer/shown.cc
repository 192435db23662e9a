#include "recording/exports/viewer/shown.h"

#include <utility>

#include "recording/exports/viewer/foxglove.pb.h"
#include "recording/exports/viewer/scene.h"

namespace ttf::recording::exports::viewer {

void Shown::replace_by(::foxglove::SceneUpdate& update, TrueTime at) {
  std::set<std::string> now;
  for (const ::foxglove::SceneEntity& entity : update.entities()) now.insert(entity.id());
  for (const std::string& id : ids_) {
    if (now.contains(id)) continue;
    ::foxglove::SceneEntityDeletion& gone = *update.add_deletions();
    set_stamp(*gone.mutable_timestamp(), at);
    gone.set_type(::foxglove::SceneEntityDeletion::MATCHING_ID);
    gone.set_id(id);
  }
  ids_ = std::move(now);
}

}  // namespace ttf::recording::exports::viewer
