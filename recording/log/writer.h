// The log of a run: every record as one MCAP message with a protobuf payload (recording/log/log.proto).
//
// docs/log_format.md describes the file. One thread at a time, no dates, no addresses: the same records give the same
// bytes. log_time is the record's true time (Stamp::true_time, else the end or the instant the record names),
// publish_time the node's global time where there is one; times before the start of the run count as 0 there,
// the payload has them exactly.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "recording/log/manifest.h"
#include "recording/records/records.h"

namespace ttf::recording::log {

class LogWriter final : public records::Sink {
 public:
  enum class Writing : std::uint8_t {
    kAtOnce,  // by the thread that records
    kBehind,  // by a thread of its own, so that who records in real time never waits for a disk or for compression
  };
  // Opens `path` and writes manifest, schemas and channels. Throws std::runtime_error when the file
  // cannot be created.
  LogWriter(const std::string& path, const LogManifest& manifest, Writing writing = Writing::kAtOnce);
  ~LogWriter() override;  // closes; a failure then is lost: call close() to hear of it
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Puts a file into the log (schedule, scenario), before anything is recorded. Names should be unique.
  void attach(std::string_view name, std::string_view media_type, std::string_view bytes);

  // Writes the last chunk and the summary. Throws std::runtime_error if anything could not be written (disk
  // full). Calling it again does nothing; nothing may be recorded afterwards.
  void close();

  // Hash over all records so far in canonical order; recording/log/content_hash.h defines it. Of a log that is written
  // behind: once it is closed.
  std::uint64_t content_hash() const;
  // The hash as the program prints it: 16 hex digits.
  std::string content_hash_text() const;

  void on(const records::Measured&) override;
  void on(const records::CanFrameSent&) override;
  void on(const records::SlotFrameSent&) override;
  void on(const records::SlotProblem&) override;
  void on(const records::ListHop&) override;
  void on(const records::TaskRun&) override;
  void on(const records::ClockCorrected&) override;
  void on(const records::PrecisionSample&) override;
  void on(const records::FusionInput&) override;
  void on(const records::ListFused&) override;
  void on(const records::FusionStep&) override;
  void on(const records::TrackState&) override;
  void on(const records::ObservationSeen&) override;
  void on(const records::ImageWritten&) override;
  void on(const records::FeatureUsed&) override;
  void on(const records::ReferenceFix&) override;
  void on(const records::TruthState&) override;
  void on(const records::StateChanged&) override;
  void on(const records::SymbolSent&) override;
  void on(const records::PowerChanged&) override;
  void on(const records::FaultActivity&) override;
  void on(const records::GuardianIntervention&) override;
  void on(const records::ChannelFrame&) override;
  void on(const records::TimingProblem&) override;
  void on(const records::LatenessHistogram&) override;
  void on(const records::MediumCounts&) override;

 private:
  struct Impl;
  template <class Record> void write(const Record& record);

  std::unique_ptr<Impl> impl_;
};

}  // namespace ttf::recording::log
