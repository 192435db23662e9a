// The parts of the FIBEX export for PDUs, signals and codings (schedules/exchange/fibex/lists.h), and helpers of
// all parts.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange::fibex {

// Each appends one child and returns it.
pugi::xml_node put(pugi::xml_node to, std::string_view name, const std::string& text);
pugi::xml_node put_reference(pugi::xml_node to, std::string_view name, const std::string& id);
pugi::xml_node put_named(pugi::xml_node to, std::string_view name, const std::string& id, const std::string& short_name,
                         const char* type = nullptr);

std::string fibex_pdu_id(PduId pdu);
void put_fibex_pdus(pugi::xml_node pdus, const model::Cluster& cluster);
void put_fibex_signals(pugi::xml_node signals, const model::Cluster& cluster);
void put_fibex_codings(pugi::xml_node processing, const model::Cluster& cluster);

}  // namespace ttf::schedules::exchange::fibex
