// A real node for a launched cluster, with SocketCAN alone: it takes the place of camera_pre in
// schedules/paper_synchronised.yaml (docs/media/own_code.md). `launch --external camera_pre --dry-run` says its numbers.
//   cc -O2 -o real_node examples/real_node.c
//   ./real_node CHANNEL_A CHANNEL_B CAMERA_CAN OBSERVATION_CAN [FAULT...]
// A FAULT is a number of us by which its frames of slot 2 come too late, or `spoil`, which breaks their frame CRCs. One
// holds for all cycles; several take turns.
#include <linux/can/raw.h>
#include <net/if.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

enum { kSlot = 84000, kActionPoint = 7000, kCycle = 5000000, kOwn = 2, kTrigger = 900000, kBytes = 64 };  // ns

static int can_socket(const char *name) {
  int s = socket(PF_CAN, SOCK_RAW, CAN_RAW), on = 1;
  struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = s < 0 ? 0 : (int)if_nametoindex(name)};
  if (address.can_ifindex == 0) perror(name), exit(1);
  setsockopt(s, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
  setsockopt(s, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  if (bind(s, (struct sockaddr *)&address, sizeof address) != 0) perror(name), exit(1);
  return s;
}

// Returns the kernel's stamp of the next frame.
static int64_t receive(int s, struct canfd_frame *frame) {
  char control[128];
  struct timespec at;
  struct iovec data = {frame, sizeof *frame};
  struct msghdr message = {.msg_iov = &data, .msg_iovlen = 1, .msg_control = control, .msg_controllen = sizeof control};
  if (recvmsg(s, &message, 0) < 0) exit(0);
  memcpy(&at, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof at);
  return at.tv_sec * 1000000000LL + at.tv_nsec;
}

static void sleep_until(int64_t at) {
  struct timespec until = {at / 1000000000, at % 1000000000};
  clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &until, NULL);
}

static uint32_t crc24(uint32_t crc, const uint8_t *bytes, int count) {
  for (int bit = 0; bit < 8 * count; ++bit) {
    uint32_t next = (crc >> 23 ^ bytes[bit / 8] >> (7 - bit % 8)) & 1;
    crc = (crc << 1 ^ (next ? 0x5D6DCB : 0)) & 0xFFFFFF;
  }
  return crc;
}

// A status frame of 28 words: the header as the launch says it, the cycle count, zeros, the channel's CRC.
static void send_status(int s, uint32_t initial_crc, int cycle, int spoil) {
  struct canfd_frame frame = {
      .can_id = kOwn, .len = kBytes, .flags = CANFD_BRS, .data = {0x38, 0x02, 0x39, 0xF6, 0xC0}};
  frame.data[4] |= (uint8_t)(cycle % 64);
  uint32_t crc = crc24(initial_crc, frame.data, kBytes - 3) ^ (uint32_t)spoil;
  for (int i = 0; i < 3; ++i) frame.data[kBytes - 3 + i] = (uint8_t)(crc >> (16 - 8 * i));
  send(s, &frame, CANFD_MTU, 0);
}

// A list of one object: number, fragment 0, count 1, the instant of measuring in us. The object is always a car of
// 1.8 m width 32 m ahead: x, y, standard deviations of 1 m, no correlation, the angle of its silhouette.
static void send_list(int s, int number, uint32_t measured_us) {
  static const uint8_t car[12] = {0x99, 0x00, 0x80, 0x00, 0x07, 0xD0, 0x1F, 0x48, 0x00, 0x70, 0x32, 0x00};
  struct canfd_frame frame = {.can_id = 0x50, .len = kBytes, .flags = CANFD_BRS};
  frame.data[0] = (uint8_t)(number >> 8), frame.data[1] = (uint8_t)number, frame.data[3] = 1;
  for (int i = 0; i < 4; ++i) frame.data[4 + i] = (uint8_t)(measured_us >> (24 - 8 * i));
  memcpy(frame.data + 8, car, sizeof car);
  send(s, &frame, CANFD_MTU, 0);
}

int main(int argc, char **argv) {
  if (argc < 5) {
    fprintf(stderr, "usage: %s CHANNEL_A CHANNEL_B CAMERA_CAN OBSERVATION_CAN [FAULT...]\n", argv[0]);
    return 2;
  }
  int a = can_socket(argv[1]), b = can_socket(argv[2]), camera = can_socket(argv[3]), out = can_socket(argv[4]);
  for (int cycle = -1, number = 0;;) {  // counted from the drive's first, if it receives that one
    struct canfd_frame received;
    int64_t at = receive(a, &received);
    if (received.can_id == 0 || received.can_id > 34) continue;  // a follow-up
    int ahead = ((received.data[4] & 63) - cycle % 64 + 64) % 64;
    if (cycle >= 0 && (ahead == 0 || ahead > 32)) continue;  // one frame states enough of its cycle
    cycle = cycle < 0 ? received.data[4] & 63 : cycle + ahead;
    int64_t next = at - (received.can_id - 1) * kSlot - kActionPoint + kCycle;
    const char *fault = argc > 5 ? argv[5 + cycle % (argc - 5)] : "0";
    sleep_until(next + (kOwn - 1) * kSlot + kActionPoint + atoi(fault) * 1000);
    send_status(a, 0xFEDCBA, cycle + 1, *fault == 's');
    send_status(b, 0xABCDEF, cycle + 1, *fault == 's');
    if (cycle % 8 == 0) {  // in cycles 1 + 8n the camera is to measure
      struct can_frame trigger = {.can_id = 4};
      sleep_until(next + kTrigger);
      send(camera, &trigger, CAN_MTU, 0);
    } else if (cycle % 8 == 6 && cycle > 6) {  // 30 ms later its list is there
      send_list(out, number++, (uint32_t)(cycle - 5) * 5000 + kTrigger / 1000);
    }
  }
}
