/* SPDX-License-Identifier: Apache-2.0 */
#include "phalanx/device/link/phalanx_link.h"

/* What the board offers. */
uint64_t board_time_us(void);
int board_read_byte(void); /* -1: none has come in */
void board_write(const uint8_t* bytes, size_t size);
void board_read_sensors(int32_t raw[PHX_CHANNELS]);
bool board_emergency_stop(void);
bool board_drive_fault(void);
void board_set_torque(const float torque[PHX_JOINTS]);

/* What the board calls: once, and then 1000 times a second. */
void firmware_start(uint32_t boots);
void firmware_tick(void);

static phx_controller controller;
static phx_receiver receiver;

static void send_frame(const uint8_t* frame, size_t size) {
  static uint8_t stuffed[PHX_COBS_MAX];
  board_write(stuffed, phx_cobs_encode(frame, size, stuffed, sizeof stuffed));
}

void firmware_start(uint32_t boots) {
  phx_device device = {.serial = "GLOVE-0001",
                       .rate_hz = 1000,
                       .channel_count = 2,
                       .torque_limit = 0.5f, /* [Nm] */
                       .torque_rate = 10.0f /* [Nm/s] */};
  /* kind, joint, open and shorted sensor, [rad] per count, [rad]: the index finger's first two joints */
  device.channel[0] = (phx_channel){PHX_CHANNEL_ANGLE, 4, 50, 4045, 0.00157f, -0.2f};
  device.channel[1] = (phx_channel){PHX_CHANNEL_ANGLE, 5, 50, 4045, 0.00157f, -0.2f};
  phx_controller_init(&controller, &device, boots << 16); /* `boots` is counted in flash */
  phx_receiver_init(&receiver);
}

static void receive_frames(void) {
  static uint8_t reply[PHX_FRAME_MAX];
  int byte;
  while ((byte = board_read_byte()) >= 0) {
    const size_t size = phx_receiver_take(&receiver, (uint8_t)byte);
    size_t reply_size = 0;
    if (size == 0) continue;
    phx_controller_receive(&controller, receiver.frame, size, board_time_us(), reply, &reply_size);
    if (reply_size > 0) send_frame(reply, reply_size);
  }
}

void firmware_tick(void) {
  static phx_output output;
  int32_t raw[PHX_CHANNELS] = {0};
  receive_frames();
  board_read_sensors(raw);
  phx_controller_tick(&controller, board_time_us(), raw, board_emergency_stop(), board_drive_fault(),
                      &output);
  board_set_torque(output.torque);
  if (output.sample_size > 0) send_frame(output.sample, output.sample_size);
}
