// A bell wakes a thread that sleeps until the next call. Calling never waits; calls during the thread's work are kept.
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
  void ring() { sem_post(&semaphore_); }  // fails only beyond INT_MAX calls, when no thread sleeps
  void wait() {
    while (sem_wait(&semaphore_) != 0) continue;  // interrupted by a process signal
  }

 private:
  sem_t semaphore_;
};

}  // namespace ttf::bus::dds::ros
