// A scene's still: one instant, seen from above.
#pragma once

#include <string>
#include <string_view>

#include "report/drawing/names.h"
#include "report/drawing/sheet.h"
#include "report/scene/scene.h"

namespace ttf::report::scene {

// Draws true objects, observations, tracks with ids, ellipses and trails, sensors' fields and warnings. Both axes have the
// same scale, and show all but the fields. Without anything at that instant, the picture says so.
std::string scene_svg(const Scene& scene, TrueTime at, const drawing::Names& names, std::string_view title,
                      const drawing::Sheet& sheet = {});

}  // namespace ttf::report::scene
