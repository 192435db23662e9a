// Any text as a cluster file. Law: a file is one document; text behind its end is refused, never skipped.
#include "core/check.h"
#include "schedules/file/loader.h"
#include "tests/fuzz/cluster_laws.h"
#include "tests/fuzz/harness.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ttf;
  const std::string text = fuzz::text_of(data, size);
  fuzz::check_cluster(text);
  const bool alone = fuzz::accepted("c.yaml", [&] { schedules::file::parse_cluster(text, "c.yaml"); });
  if (!alone) return 0;
  const std::string more = text + "\n...\n---\nunknown: 1\n";
  TTF_CHECK(!fuzz::accepted("c.yaml", [&] { schedules::file::parse_cluster(more, "c.yaml"); }),
            "a second document is passed over");
  return 0;
}
