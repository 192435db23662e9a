#include "fusion/loading/cut_off.h"

namespace ttf::fusion::loading {

metrics::CutOff load_cut_off(YamlMap& yaml) {
  metrics::CutOff cut_off;
  cut_off.distance_m = yaml.number_or("cut_off", cut_off.distance_m, {0.1, 1000.0}, "m");
  cut_off.order = yaml.number_or("order", cut_off.order, {1.0, 16.0}, "");
  return cut_off;
}

}  // namespace ttf::fusion::loading
