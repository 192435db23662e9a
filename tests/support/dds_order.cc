// Declares to the thread sanitizer the order that Cyclone DDS guarantees, since DDS is not compiled for it (tools/tsan.supp):
//
//   dds_create_listener  ->  first call of a reader's listener  ->  next call  ->  return of dds_delete(reader)
//
// These functions stand before those of DDS, and call them.
#include <dds/dds.h>
#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "core/check.h"

namespace {

template <class Function> Function* of_dds(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// An address for a reader.
void* order_of(dds_entity_t reader) {
  static std::array<char, 4096> addresses;
  return &addresses[static_cast<std::uint32_t>(reader) % addresses.size()];
}

std::atomic<dds_on_data_available_fn> listens{nullptr};  // all listeners of a program have one function

void listen_in_order(dds_entity_t reader, void* argument) {
  __tsan_acquire(argument);
  __tsan_acquire(order_of(reader));
  listens.load()(reader, argument);
  __tsan_release(order_of(reader));
}

}  // namespace

extern "C" {

dds_listener_t* dds_create_listener(void* argument) {
  __tsan_release(argument);
  return of_dds<decltype(dds_create_listener)>("dds_create_listener")(argument);
}

void dds_lset_data_available(dds_listener_t* listener, dds_on_data_available_fn function) {
  dds_on_data_available_fn before = nullptr;
  TTF_CHECK(listens.compare_exchange_strong(before, function) || before == function, "another listener");
  of_dds<decltype(dds_lset_data_available)>("dds_lset_data_available")(listener, listen_in_order);
}

dds_return_t dds_delete(dds_entity_t entity) {
  const dds_return_t result = of_dds<decltype(dds_delete)>("dds_delete")(entity);
  __tsan_acquire(order_of(entity));
  return result;
}

}  // extern "C"
