// The protocol of one CAN controller, bit by bit (ISO 11898-1:2015, clauses 10 and 12; Bosch CAN Specification 2.0,
// part B, chapters 3, 6 and 8). It sends and receives frames, error frames and overload frames. It keeps the
// intermission, and it goes bus off and returns.
//
// A pure machine: at the end of each of its bits it takes the level that it saw, and says which level it drives in
// the next. bus/can/line.h puts several on one line. A true level is recessive.
#pragma once

#include <cstdint>

#include "bus/can/confinement.h"
#include "bus/can/decoder.h"
#include "bus/can/frame_bits.h"

namespace ttf::bus::can {

class Protocol {
 public:
  enum class Phase : std::uint8_t {
    kOff,           // without supply, or held off the bus
    kIntegrating,   // it waits for eleven recessive bits
    kIdle,          // it may send
    kFrame,         // it sends or receives
    kActiveFlag,    // an active error flag, or an overload flag
    kPassiveFlag,   // a passive error flag
    kBehindFlag,    // it waits for a recessive bit
    kDelimiter,     // it ends an error or overload frame, from that bit on
    kIntermission,  //
    kSuspend,       // an error-passive transmitter waits for eight bits more
    kBusOff
  };
  // The outcome of a bit.
  struct Brought {
    CanError error = CanError::kNone;  // it begins an error flag, or leaves the bus
    bool as_transmitter = false;       // when the error came
    bool accepted = false;             // the present frame is good for the receivers, as this controller saw it
    bool sent = false;                 // its own frame has left without an error
  };

  explicit Protocol(bool flexible_data_rate) : flexible_data_rate_(flexible_data_rate) {}

  // Power-on: error active, integrating. At the start of a run it may be idle at once.
  void power_on(bool integrated);
  void power_off() { become(Phase::kOff); }
  // Takes it off the bus, as bus off; it stays so until release(). Then it recovers as from bus off.
  void hold_off();
  void release();
  void set_acknowledging(bool does) { acknowledging_ = does; }

  // Begins a frame with the coming bit, its start of frame. Precondition: it is idle.
  void start(const FrameBits& frame);
  Brought end_of_bit(bool recessive);
  // A frame of other nodes begins, which this controller does not make out. It ends with eleven recessive bits: a
  // controller that waits for them to take part is idle behind it, and one that is bus off counts from them on.
  void pass_by();

  Phase phase() const { return phase_; }
  bool drives() const { return drives_; }  // recessive?
  // Returns whether the present bit has the data rate.
  bool data_rate() const { return phase_ == Phase::kFrame && decoder_.data_rate(); }
  bool transmits() const { return phase_ == Phase::kFrame && transmitter_; }
  // Returns whether it waits for a start of frame, and takes up the time of its edge.
  bool waits() const;
  // Returns whether more dominant bits, in eights, change nothing but its count of them.
  bool endures_dominance() const;
  std::size_t bit() const { return bit_; }  // in its own frame, while it transmits
  const Confinement& confinement() const { return confinement_; }
  const Decoder& decoder() const { return decoder_; }  // it has the present frame

 private:
  void become(Phase phase);
  void receive_start();
  Brought frame_bit(bool recessive);
  Brought transmitted(bool recessive, const Decoder::Taken& taken);
  Brought received(bool recessive, const Decoder::Taken& taken);
  Brought fail(CanError error, bool stuff_bit_overwritten = false);
  void raise_flag(bool active, bool of_error);
  void active_flag_bit(bool recessive);
  void passive_flag_bit(bool recessive);
  void behind_flag_bit(bool recessive);
  Brought delimiter_bit(bool recessive);
  void intermission_bit(bool recessive);
  void bus_off_bit(bool recessive);
  void count(ConfinementEvent of_transmitter, ConfinementEvent of_receiver);
  void drive_next();

  const bool flexible_data_rate_;
  Phase phase_ = Phase::kOff;
  bool drives_ = true;
  bool transmitter_ = false;  // it sends or sent the present or the last frame
  bool acknowledging_ = true;
  bool error_flag_ = false;  // the present flag is one of an error, not of an overload
  bool lone_ = false;        // a passive flag for want of an acknowledgement, not counted yet
  bool last_ = true;         // the last bit of a passive flag
  int count_ = 0;            // bits in the present phase
  std::size_t bit_ = 0;      // the next bit in the own frame
  Confinement confinement_;
  Decoder decoder_;
  FrameBits frame_;
};

}  // namespace ttf::bus::can
