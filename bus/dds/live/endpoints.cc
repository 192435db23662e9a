#include "bus/dds/live/endpoints.h"

namespace ttf::bus::dds::live {

common::Qos live_qualities(Delivery delivery, NodeId owner) {
  common::Qos qos = common::new_qos();
  dds_qset_reliability(qos.get(),
                       delivery == Delivery::kReliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, LiveLine::kHistory);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  if (owner != kNoNode) dds_qset_userdata(qos.get(), &owner, sizeof owner);
  return qos;
}

std::vector<NodeId> owners(common::Handle entity, const std::vector<dds_instance_handle_t>& matched,
                           dds_builtintopic_endpoint_t* (*data)(dds_entity_t, dds_instance_handle_t)) {
  std::vector<NodeId> nodes;
  for (const dds_instance_handle_t handle : matched) {
    dds_builtintopic_endpoint_t* const endpoint = data(entity, handle);
    if (endpoint == nullptr) continue;  // it has just gone
    void* said = nullptr;
    std::size_t size = 0;
    if (dds_qget_userdata(endpoint->qos, &said, &size) && size == sizeof(NodeId))
      nodes.push_back(*static_cast<const NodeId*>(said));
    dds_free(said);
    dds_builtintopic_free_endpoint(endpoint);
  }
  return nodes;
}

}  // namespace ttf::bus::dds::live
