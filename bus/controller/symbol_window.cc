// The symbol window: sends media access test symbols, and judges all activity there (FlexRay 2.1A, chapters
// 5.1.4 and 6).
#include "bus/controller/state.h"

namespace ttf::bus::controller {

using schedules::model::Channel;
using schedules::model::Channels;

bool FlexRayController::State::request_media_test_symbol(Channels channels) {
  if (mac_mode(poc) != poc::MacMode::kAll || symbol_request || g.gdSymbolWindow == 0) return false;
  symbol_request = channels;
  return true;
}

// After the dynamic segment; its action point has the same offset as that of a static slot.
Macroticks FlexRayController::State::window_start() const {
  return minislots.count() > 0 ? minislots.start_of(minislots.count() + 1) : static_end();
}

void FlexRayController::State::plan_symbol_window() {
  window_from = clock->start_of(window_start());
  window_to = clock->start_of(window_start() + Macroticks{g.gdSymbolWindow});
  symbol_point = clock->start_of(window_start() + Macroticks{g.gdActionPointOffset});
  window_seen = {};
  window_element = {};
}

void FlexRayController::State::send_media_test_symbol(Microticks at) {
  symbol_point = kNever<Microticks>;
  if (!symbol_request) return;
  const Channels channels = *symbol_request;
  symbol_request.reset();
  // The permission at the host's request may have gone since.
  if (mac_mode(poc) != poc::MacMode::kAll) return;
  for (const Channel channel : schedules::model::kBothChannels)
    if (includes(channels, channel) && includes(p.pChannels, channel))
      send_symbol(ports::Signal::kCas, channel, at, at + cas_length());
}

// A symbol in the window is a media access test symbol, which has the bits of a collision avoidance symbol.
void FlexRayController::State::judge_symbol_window(const ports::Reception& reception, bool conflict) {
  if (reception.end <= window_from || reception.start >= window_to) return;
  const auto c = index_of(reception.channel);
  // A symbol that outlasts the window is judged after the window has been closed.
  SymbolWindowSeen& status = (segment == Segment::kRest ? window_last : window_seen)[c];
  const bool begins = reception.start >= window_from, ends = reception.end <= window_to;
  if (!begins || !ends) status.boundary_violation = true;
  if (conflict) status.transmission_conflict = true;
  if (!begins) return;
  if (!is_cas(reception) || conflict || window_element[c])  // another signal, or a second symbol
    status.syntax_error = true;
  else if (ends)
    status.valid_mts = true;
  window_element[c] = true;
}

void FlexRayController::State::close_symbol_window() {
  window_last = poc::in_startup(poc.kind) ? decltype(window_last){} : window_seen;
  segment = Segment::kRest;
}

}  // namespace ttf::bus::controller
