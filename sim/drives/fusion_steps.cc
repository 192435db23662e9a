// The steps from lists of objects to the image and its first user, and the detector's before them.
#include "nodes/fusion/fusion_host.h"
#include "nodes/service/feature_service.h"
#include "nodes/service/gateway.h"
#include "nodes/vision/adaptive_camera.h"
#include "nodes/vision/mode_camera.h"
#include "sim/drives/detectors.h"
#include "sim/drives/known_fields.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using nodes::host::Step;

std::shared_ptr<Step> adaptive_camera(const StepSite& site) {
  const Scenario& scenario = site.scenario();
  const auto make = [&]<class Camera>() -> std::shared_ptr<Step> {
    return std::make_shared<Camera>(site.cluster(), site.task, scenario.adaptive_camera,
                                    pictures_of(scenario, site.cluster(), site.task),
                                    nodes::vision::DetectionKey{site.set.seed, site.set.replication});
  };
  return site.task.modes.empty() ? make.template operator()<nodes::vision::AdaptiveCamera>()
                                 : make.template operator()<nodes::vision::ModeCamera>();
}

std::shared_ptr<Step> gateway(const StepSite&) { return std::make_shared<nodes::service::Gateway>(); }

template <class Made> std::shared_ptr<Step> at_fusion_host(const StepSite& site) {
  if (!site.fusion_host)
    site.fusion_host = std::make_shared<nodes::fusion::FusionHost>(site.cluster(), site.set.strategy,
                                                                   tracker_of(site.scenario(), site.cluster()));
  return std::make_shared<Made>(site.cluster(), site.task, site.fusion_host);
}

std::shared_ptr<Step> feature_service(const StepSite& site) {
  return std::make_shared<nodes::service::FeatureService>(site.cluster(), site.task, site.scenario().feature);
}

constexpr StepRow kFusionSteps[] = {
    {{.step = "adaptive_camera", .any_reads = true, .may_read = {"regions"}, .any_writes = true},
     StepRole::kDetector,
     &adaptive_camera,
     &check_detection},
    {{.step = "gateway", .reads = {"in"}, .writes = {"out"}}, StepRole::kGateway, &gateway},
    {{.step = nodes::fusion::FusionStep::kName, .any_reads = true},
     StepRole::kFusion,
     &at_fusion_host<nodes::fusion::FusionStep>},
    {{.step = "image_output", .writes = {"image"}},
     StepRole::kImageOutput,
     &at_fusion_host<nodes::fusion::ImageOutput>},
    {{.step = "feature_service", .reads = {"image"}, .may_read = {"odometry"}},
     StepRole::kFeatureService,
     &feature_service},
};
static_assert(complete(kFusionSteps));

}  // namespace

std::span<const StepRow> fusion_steps() { return kFusionSteps; }

}  // namespace ttf::sim::drives
