#include "cli/tracking_outputs.h"

namespace ttf::cli {

nlohmann::ordered_json tracking_json(const evaluation::accuracy::TrackingMeasures& measures) {
  const auto& [c, p] = measures.cut_off;
  nlohmann::ordered_json json;
  json["gospa"] = {{"distance_m", measures.gospa.distance_m},
                   {"localisation", measures.gospa.localisation},
                   {"missed", measures.gospa.missed},
                   {"false", measures.gospa.false_estimates},
                   {"cut_off_m", c},
                   {"order", p},
                   {"alpha", 2},
                   {"instants", measures.instants}};
  json["ospa"] = {{"distance_m", measures.ospa.distance_m},
                  {"localisation", measures.ospa.localisation},
                  {"cardinality", measures.ospa.cardinality},
                  {"cut_off_m", c},
                  {"order", p}};
  const fusion::metrics::ClearMotCounts& mot = measures.mot;
  json["clear_mot"] = {{"mota", mot.mota()},       {"motp_m", mot.motp_m()},   {"objects", mot.objects},
                       {"matches", mot.matches},   {"misses", mot.misses},     {"false_positives", mot.false_positives},
                       {"switches", mot.switches}, {"gate_m", measures.gate_m}};
  const fusion::metrics::LifeSummary& lives = measures.lives;
  json["track_life"] = {{"objects", lives.objects},
                        {"confirmed", lives.confirmed},
                        {"mostly_tracked", lives.mostly_tracked},
                        {"partly_tracked", lives.partly_tracked},
                        {"mostly_lost", lives.mostly_lost},
                        {"fragmentations", lives.fragmentations},
                        {"mean_fraction_tracked", lives.mean_fraction_tracked},
                        {"mean_confirmed_after_s", lives.mean_confirmed_after_s}};
  return json;
}

}  // namespace ttf::cli
