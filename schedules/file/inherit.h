// A cluster file that begins from another one: `extends: OTHER.yaml`, relative to its own folder. Its keys change those of
// the other file (core/yaml_merge.h), which may extend a third one.
#pragma once

#include <string>

#include "core/text_place.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// The text of a whole cluster, with nothing left to inherit.
struct ClusterText {
  std::string text;
  std::string name;     // the file that was asked for
  TextOrigins origins;  // none where the text is one file's own
};

// Reads a file and all that it extends. A file that extends nothing keeps its text, byte by byte. Throws InputError: for
// files that are no cluster files, a base that cannot be read or extends its own heir, and the errors of merge_yaml().
ClusterText inherited(const std::string& path);

// Reads the cluster from its text. Findings name the file and line from which a value came. Throws InputError.
model::Cluster parse_cluster(ClusterText text);

}  // namespace ttf::schedules::file
