#include "experiments/mpi/ranks.h"

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>

namespace ttf::experiments::mpi {
namespace {

using results::Row;
using results::RowKey;

constexpr int kRows = 1;                       // to rank 0: results, perhaps none; the sender is idle
constexpr int kKeys = 2;                       // from rank 0: keys to drive; empty: the end
constexpr std::chrono::milliseconds kLook{1};  // between two looks for a message; MPI itself would wait spinning

using Bytes = std::vector<char>;

template <class Number> void put(Bytes& bytes, Number number) {
  static_assert(std::is_arithmetic_v<Number>);
  const auto* from = reinterpret_cast<const char*>(&number);
  bytes.insert(bytes.end(), from, from + sizeof number);
}

// Reads a message that another rank of this program has written.
class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}
  bool at_end() const { return at_ == bytes_.size(); }
  template <class Number> Number get() {
    Number number;
    std::memcpy(&number, take(sizeof number), sizeof number);
    return number;
  }
  std::string text(std::size_t size) { return {take(size), size}; }

 private:
  const char* take(std::size_t size) {
    if (bytes_.size() - at_ < size) throw std::runtime_error("a message of another rank ends too early");
    const char* const from = bytes_.data() + at_;
    at_ += size;
    return from;
  }
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

void put(Bytes& bytes, const RowKey& key) {
  put(bytes, key.point);
  put(bytes, key.replication);
  put(bytes, key.paradigm);
}
RowKey get_key(Reader& reader) {
  RowKey key;
  key.point = reader.get<std::uint32_t>();
  key.replication = reader.get<std::uint32_t>();
  key.paradigm = reader.get<std::uint32_t>();
  return key;
}

Bytes bytes_of(const std::vector<Row>& rows) {
  Bytes bytes;
  for (const Row& row : rows) {
    put(bytes, row.key);
    put(bytes, static_cast<std::uint64_t>(row.status.size()));
    bytes.insert(bytes.end(), row.status.begin(), row.status.end());
    put(bytes, static_cast<std::uint64_t>(row.values.size()));
    for (const double value : row.values) put(bytes, value);
  }
  return bytes;
}
std::vector<Row> rows_of(const Bytes& bytes) {
  std::vector<Row> rows;
  for (Reader reader(bytes); !reader.at_end();) {
    Row& row = rows.emplace_back();
    row.key = get_key(reader);
    row.status = reader.text(reader.get<std::uint64_t>());
    row.values.resize(reader.get<std::uint64_t>());
    for (double& value : row.values) value = reader.get<double>();
  }
  return rows;
}

void send(const Bytes& bytes, int to, int tag) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD);
}

// Receives a message that has arrived.
Bytes receive(const MPI_Status& status) {
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  Bytes bytes(static_cast<std::size_t>(size));
  MPI_Recv(bytes.data(), size, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return bytes;
}

bool is_there(int from, int tag, MPI_Status& status) {
  int there = 0;
  MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status);
  return there != 0;
}

std::string broadcast(std::string text, int from) {
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, from, MPI_COMM_WORLD);
  text.resize(size);
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_CHAR, from, MPI_COMM_WORLD);
  return text;
}

}  // namespace

Ranks::Ranks() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  under_way_.resize(static_cast<std::size_t>(size_));
  if (provided < MPI_THREAD_FUNNELED) throw std::runtime_error("this MPI does not support threads");
}

Ranks::~Ranks() {
  int begun = 0;
  MPI_Initialized(&begun);
  if (begun == 0) return;
  // A rank that still drives reports its end; its results are dropped.
  while (served_ && idle_.size() + 1 < static_cast<std::size_t>(size_)) {
    MPI_Status status;
    while (!is_there(MPI_ANY_SOURCE, kRows, status)) std::this_thread::sleep_for(kLook);
    (void)receive(status);
    idle_.push_back(status.MPI_SOURCE);
  }
  for (const int rank : idle_) hand_out(rank, {});
  MPI_Finalize();
}

std::string Ranks::first_problem(const std::string& mine) const {
  if (size_ == 1) return mine;
  const int here = mine.empty() ? size_ : rank_;
  int first = size_;
  MPI_Allreduce(&here, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return first == size_ ? "" : broadcast(mine, first);
}

bool Ranks::same_as_first(const std::string& text) const { return size_ == 1 || broadcast(text, 0) == text; }

void Ranks::serve(const sweep::SweepDrives& drives) {
  std::vector<Row> done;
  sweep::Driver driver(drives);
  while (true) {
    send(bytes_of(done), 0, kRows);
    MPI_Status status;
    while (!is_there(0, kKeys, status)) std::this_thread::sleep_for(kLook);
    const Bytes keys = receive(status);
    if (keys.empty()) return;
    std::vector<RowKey> wanted;
    for (Reader reader(keys); !reader.at_end();) wanted.push_back(get_key(reader));
    done.clear();
    driver.drive(wanted, [&](Row row) { done.push_back(std::move(row)); });
  }
}

void Ranks::hand_out(int rank, std::span<const RowKey> keys) {
  Bytes bytes;
  for (const RowKey& key : keys) put(bytes, key);
  send(bytes, rank, kKeys);
  under_way_[static_cast<std::size_t>(rank)] = keys.size();
}

std::size_t Ranks::turn(const Grab& grab, const Deposit& deposit) {
  for (MPI_Status status; is_there(MPI_ANY_SOURCE, kRows, status);) {
    deposit(rows_of(receive(status)));
    under_way_[static_cast<std::size_t>(status.MPI_SOURCE)] = 0;
    idle_.push_back(status.MPI_SOURCE);
  }
  while (!idle_.empty()) {
    const std::span<const RowKey> keys = grab();
    if (keys.empty()) break;
    hand_out(idle_.back(), keys);
    idle_.pop_back();
  }
  return std::accumulate(under_way_.begin(), under_way_.end(), std::size_t{0});
}

}  // namespace ttf::experiments::mpi
