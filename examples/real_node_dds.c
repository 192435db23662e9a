// A real node for a launched cluster over DDS, with Cyclone DDS and the type of a sample alone: it takes the place of
// camera_pre in schedules/paper_synchronised.yaml (docs/media/own_code.md), as real_node.c does on CANs.
//   idlc bus/dds/live/live_sample.idl
//   cc -O2 -I . -o real_node_dds examples/real_node_dds.c live_sample.c -lddsc
//   CYCLONEDDS_URI=file://$PWD/bus/dds/loopback.xml ./real_node_dds SESSION [TIME_SCALE [FAULT...]]
// A FAULT is as in real_node.c.
#include <dds/dds.h>
#include <live_sample.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { kSlot = 84000, kActionPoint = 7000, kCycle = 5000000, kOwn = 2, kTrigger = 900000, kFrame = 64 };  // ns, bytes
enum { kSelf = 3, kOnSlot = 0, kClassicCan = 4, kFastCan = 5 };

static int64_t now(void) {
  struct timespec at;
  clock_gettime(CLOCK_MONOTONIC, &at);
  return at.tv_sec * 1000000000LL + at.tv_nsec;
}

static void sleep_until(int64_t at) {
  struct timespec until = {at / 1000000000, at % 1000000000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
}

// A line: its writer, and the number of its next sample.
struct line {
  dds_entity_t topic, writer;
  uint64_t number;
};

static struct line line_of(dds_entity_t participant, dds_entity_t publisher, const char *topic) {
  struct line line = {dds_create_topic(participant, &ttf_LiveSample_desc, topic, NULL, NULL), 0, 0};
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  line.writer = dds_create_writer(publisher, line.topic, qos, NULL);
  if (line.writer < 0) {
    fprintf(stderr, "%s: %s\n", topic, dds_strretcode(-line.writer));
    exit(1);
  }
  return line;
}

static void put(struct line *line, ttf_LiveSample sample, uint8_t *bytes, uint32_t count) {
  static int64_t begun = 0;
  if (begun == 0) begun = now();
  sample.sender = kSelf, sample.incarnation = (uint64_t)begun, sample.number = line->number++, sample.host = 1;
  sample.bytes._buffer = bytes, sample.bytes._length = sample.bytes._maximum = count;
  sample.sent = now();
  dds_write(line->writer, &sample);
}

static uint32_t crc24(uint32_t crc, const uint8_t *bytes, int count) {
  for (int bit = 0; bit < 8 * count; ++bit) {
    uint32_t next = (crc >> 23 ^ bytes[bit / 8] >> (7 - bit % 8)) & 1;
    crc = (crc << 1 ^ (next ? 0x5D6DCB : 0)) & 0xFFFFFF;
  }
  return crc;
}

// A status frame of 28 words: the header as the launch says it, the cycle count, zeros, the channel's CRC.
static void send_status(struct line *line, uint32_t initial_crc, int cycle, int spoil) {
  uint8_t frame[kFrame] = {0x38, 0x02, 0x39, 0xF6, 0xC0 | (uint8_t)(cycle % 64)};
  uint32_t crc = crc24(initial_crc, frame, kFrame - 3) ^ (uint32_t)spoil;
  for (int i = 0; i < 3; ++i) frame[kFrame - 3 + i] = (uint8_t)(crc >> (16 - 8 * i));
  put(line, (ttf_LiveSample){.kind = kOnSlot, .slot = kOwn}, frame, kFrame);
}

// A list of one object, as real_node.c has it.
static void send_list(struct line *line, int number, uint32_t measured_us) {
  static const uint8_t car[12] = {0x99, 0x00, 0x80, 0x00, 0x07, 0xD0, 0x1F, 0x48, 0x00, 0x70, 0x32, 0x00};
  uint8_t list[kFrame] = {(uint8_t)(number >> 8), (uint8_t)number, 0, 1};
  for (int i = 0; i < 4; ++i) list[4 + i] = (uint8_t)(measured_us >> (24 - 8 * i));
  memcpy(list + 8, car, sizeof car);
  put(line, (ttf_LiveSample){.kind = kFastCan, .identifier = 0x50}, list, kFrame);
}

int main(int argc, char **argv) {
  if (argc < 2) {
    fprintf(stderr, "usage: %s SESSION [TIME_SCALE [FAULT...]]\n", argv[0]);
    return 2;
  }
  const int64_t scale = argc > 2 ? atoi(argv[2]) : 1;
  dds_entity_t here = dds_create_participant(0, NULL, NULL);
  dds_qos_t *within = dds_create_qos();
  dds_qset_partition1(within, argv[1]);
  dds_entity_t publisher = dds_create_publisher(here, within, NULL);
  dds_entity_t subscriber = dds_create_subscriber(here, within, NULL);
  struct line a = line_of(here, publisher, "ttf/flexray/A"), b = line_of(here, publisher, "ttf/flexray/B");
  struct line camera = line_of(here, publisher, "ttf/can/camera_can");
  struct line out = line_of(here, publisher, "ttf/can/observation_can");
  dds_entity_t reader = dds_create_reader(subscriber, a.topic, NULL, NULL), waits = dds_create_waitset(here);
  dds_waitset_attach(waits, dds_create_readcondition(reader, DDS_ANY_STATE), 0);
  for (int cycle = -1, number = 0;;) {  // counted from the drive's first, if it receives that one
    void *taken[1] = {NULL};
    dds_sample_info_t info;
    dds_waitset_wait(waits, NULL, 0, DDS_INFINITY);
    if (dds_take(reader, taken, &info, 1, 1) < 1) continue;
    ttf_LiveSample received = *(ttf_LiveSample *)taken[0];
    int count = info.valid_data && received.kind == kOnSlot && received.slot <= 34 ? received.bytes._buffer[4] & 63 : -1;
    dds_return_loan(reader, taken, 1);
    int ahead = (count - cycle % 64 + 64) % 64;
    if (count < 0 || (cycle >= 0 && (ahead == 0 || ahead > 32))) continue;  // one frame states enough of its cycle
    cycle = cycle < 0 ? count : cycle + ahead;
    int64_t due = received.sent - (received.tells_late ? received.late : 0);
    int64_t next = due + scale * (kCycle - (received.slot - 1) * kSlot - kActionPoint);
    const char *fault = argc > 3 ? argv[3 + cycle % (argc - 3)] : "0";
    sleep_until(next + scale * ((kOwn - 1) * kSlot + kActionPoint) + atoi(fault) * 1000);
    send_status(&a, 0xFEDCBA, cycle + 1, *fault == 's');
    send_status(&b, 0xABCDEF, cycle + 1, *fault == 's');
    if (cycle % 8 == 0) {  // in cycles 1 + 8n the camera is to measure
      sleep_until(next + scale * kTrigger);
      put(&camera, (ttf_LiveSample){.kind = kClassicCan, .identifier = 4}, NULL, 0);
    } else if (cycle % 8 == 6 && cycle > 6) {  // 30 ms later its list is there
      send_list(&out, number++, (uint32_t)(cycle - 5) * 5000 + kTrigger / 1000);
    }
  }
}
