#include "bus/dds/live/queue.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace ttf::bus::dds::live {
namespace {

int new_event() {
  const int event = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (event < 0) throw std::system_error(errno, std::generic_category(), "cannot make an eventfd");
  return event;
}

}  // namespace

LiveQueue::LiveQueue() : items_(std::make_unique<std::array<LiveItem, kRoom>>()), event_(new_event()) {}

LiveQueue::~LiveQueue() { close(event_); }

LiveItem* LiveQueue::room() {
  const std::size_t filled = filled_.load(std::memory_order_relaxed);  // only this thread changes it
  return filled - emptied_.load() == kRoom ? nullptr : &(*items_)[filled % kRoom];
}

void LiveQueue::push() {
  filled_.fetch_add(1);
  if (watched_.load()) call();
}

bool LiveQueue::pop(LiveItem& item) {
  if (empty()) {
    if (!watched_.load()) return false;
    // An item may come between the two looks: then it calls again, or is seen here.
    eventfd_t ignored = 0;
    eventfd_read(event_, &ignored);
    if (empty()) return false;
    call();
  }
  const std::size_t emptied = emptied_.load(std::memory_order_relaxed);
  const LiveItem& first = (*items_)[emptied % kRoom];
  item.arrival = first.arrival;
  item.malformed = first.malformed;
  item.size = first.size;
  std::copy_n(first.bytes.begin(), first.size, item.bytes.begin());
  emptied_.store(emptied + 1);
  return true;
}

void LiveQueue::watch(bool on) {
  watched_.store(on);
  eventfd_t ignored = 0;
  eventfd_read(event_, &ignored);
  if (on && !empty()) call();
}

void LiveQueue::call() const { eventfd_write(event_, 1); }

bool LiveQueue::empty() const { return filled_.load() == emptied_.load(); }

}  // namespace ttf::bus::dds::live
