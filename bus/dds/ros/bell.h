// Calls a thread, and lets it sleep until it is called. Calling never waits; calls of one that is awake are kept.
#pragma once

#include <semaphore.h>

#include "core/check.h"

namespace ttf::bus::dds::ros {

class Bell {
 public:
  Bell() { TTF_CHECK(sem_init(&semaphore_, 0, 0) == 0); }
  ~Bell() { sem_destroy(&semaphore_); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;
  void ring() { sem_post(&semaphore_); }  // fails beyond INT_MAX calls only: then nobody sleeps anyway
  void wait() {
    while (sem_wait(&semaphore_) != 0) continue;  // a signal came
  }

 private:
  sem_t semaphore_;
};

}  // namespace ttf::bus::dds::ros
