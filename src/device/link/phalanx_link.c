/* SPDX-License-Identifier: Apache-2.0
 *
 * Reference of the Phalanx link; see phalanx_link.h and docs/link.md. C99, freestanding: the compiler may
 * need memcpy and memset, nothing else is used.
 */
#include "phalanx/device/link/phalanx_link.h"

/* ---- bytes: one description of every frame serves both directions ---- */

typedef struct {
  uint8_t* at;
  bool reading;
  bool finite; /* of all floats that were read */
} phx_stream;

static bool is_finite(float value) {
  union {
    float number;
    uint32_t bits;
  } view;
  view.number = value;
  return (view.bits & 0x7F800000u) != 0x7F800000u; /* on the bits: holds under -ffast-math as well */
}

static void pass_u8(phx_stream* stream, uint8_t* value) {
  if (stream->reading) {
    *value = *stream->at;
  } else {
    *stream->at = *value;
  }
  ++stream->at;
}

static void pass_u16(phx_stream* stream, uint16_t* value) {
  uint8_t low = (uint8_t)(*value & 0xFFu);
  uint8_t high = (uint8_t)(*value >> 8);
  pass_u8(stream, &low);
  pass_u8(stream, &high);
  if (stream->reading) *value = (uint16_t)(low | (uint16_t)(high << 8));
}

static void pass_u32(phx_stream* stream, uint32_t* value) {
  uint16_t low = (uint16_t)(*value & 0xFFFFu);
  uint16_t high = (uint16_t)(*value >> 16);
  pass_u16(stream, &low);
  pass_u16(stream, &high);
  if (stream->reading) *value = (uint32_t)low | ((uint32_t)high << 16);
}

static void pass_u64(phx_stream* stream, uint64_t* value) {
  uint32_t low = (uint32_t)(*value & 0xFFFFFFFFu);
  uint32_t high = (uint32_t)(*value >> 32);
  pass_u32(stream, &low);
  pass_u32(stream, &high);
  if (stream->reading) *value = (uint64_t)low | ((uint64_t)high << 32);
}

static void pass_i32(phx_stream* stream, int32_t* value) {
  union {
    int32_t number;
    uint32_t bits;
  } view;
  view.number = *value;
  pass_u32(stream, &view.bits);
  if (stream->reading) *value = view.number;
}

static void pass_float(phx_stream* stream, float* value) {
  union {
    float number;
    uint32_t bits;
  } view;
  view.number = *value;
  pass_u32(stream, &view.bits);
  if (!stream->reading) return;
  *value = view.number;
  if (!is_finite(view.number)) stream->finite = false;
}

static void pass_floats(phx_stream* stream, float* values, size_t count) {
  for (size_t i = 0; i < count; ++i) pass_float(stream, &values[i]);
}

static void pass_channel(phx_stream* stream, phx_channel* channel) {
  pass_u8(stream, &channel->kind);
  pass_u8(stream, &channel->index);
  pass_i32(stream, &channel->raw_min);
  pass_i32(stream, &channel->raw_max);
  pass_float(stream, &channel->gain);
  pass_float(stream, &channel->offset);
}

/* Channels from channel_count on are zeros on the wire; other values received there become zeros. */
static void pass_welcome(phx_stream* stream, phx_welcome* welcome) {
  static const phx_channel none = {0, 0, 0, 0, 0.0f, 0.0f};
  pass_u64(stream, &welcome->host_id);
  for (size_t i = 0; i < PHX_SERIAL_SIZE; ++i) {
    uint8_t letter = (uint8_t)welcome->serial[i];
    pass_u8(stream, &letter);
    if (stream->reading) welcome->serial[i] = (char)letter;
  }
  pass_u16(stream, &welcome->rate_hz);
  pass_u8(stream, &welcome->channel_count);
  for (size_t i = 0; i < PHX_CHANNELS; ++i) {
    if (i < welcome->channel_count) {
      pass_channel(stream, &welcome->channel[i]);
    } else {
      phx_channel unused = none;
      const bool finite = stream->finite;
      pass_channel(stream, &unused);
      stream->finite = finite;
      if (stream->reading) welcome->channel[i] = none;
    }
  }
}

static void pass_refused(phx_stream* stream, phx_refused* refused) {
  pass_u64(stream, &refused->host_id);
  pass_u8(stream, &refused->reason);
  pass_u8(stream, &refused->version);
}

static void pass_configure(phx_stream* stream, phx_configure* configure) {
  pass_floats(stream, configure->gain, PHX_CHANNELS);
  pass_floats(stream, configure->offset, PHX_CHANNELS);
  pass_float(stream, &configure->torque_limit);
  pass_float(stream, &configure->torque_rate);
}

static void pass_sample(phx_stream* stream, phx_sample* sample) {
  pass_u64(stream, &sample->time_us);
  pass_u64(stream, &sample->acted_tick);
  pass_u32(stream, &sample->acted_age_us);
  pass_u8(stream, &sample->state);
  pass_u8(stream, &sample->flags);
  pass_u16(stream, &sample->fault);
  pass_u8(stream, &sample->fault_channel);
  pass_float(stream, &sample->factor);
  pass_u32(stream, &sample->corrupt);
  pass_u32(stream, &sample->refused);
  pass_u32(stream, &sample->outdated);
  for (size_t i = 0; i < PHX_CHANNELS; ++i) pass_i32(stream, &sample->raw[i]);
}

static void pass_command(phx_stream* stream, phx_command* command) {
  pass_u64(stream, &command->tick);
  pass_u64(stream, &command->sample_time_us);
  pass_u8(stream, &command->flags);
  pass_floats(stream, command->torque, PHX_JOINTS);
}

static void pass_walls(phx_stream* stream, phx_command_walls* walls) {
  pass_command(stream, &walls->command);
  pass_u32(stream, &walls->valid_us);
  pass_floats(stream, walls->q_ref, PHX_JOINTS);
  for (size_t i = 0; i < PHX_WALLS; ++i) {
    phx_wall* wall = &walls->wall[i];
    pass_floats(stream, wall->g, PHX_WALL_JOINTS);
    pass_float(stream, &wall->d_ref);
    pass_float(stream, &wall->stiffness);
    pass_float(stream, &wall->force_max);
    pass_float(stream, &wall->host_force);
  }
}

static void pass_payload(phx_stream* stream, phx_message* message) {
  switch (message->header.type) {
    case PHX_HELLO:
      pass_u64(stream, &message->as.hello.host_id);
      break;
    case PHX_WELCOME:
      pass_welcome(stream, &message->as.welcome);
      break;
    case PHX_REFUSED:
      pass_refused(stream, &message->as.refused);
      break;
    case PHX_CONFIGURE:
      pass_configure(stream, &message->as.configure);
      break;
    case PHX_SAMPLE:
      pass_sample(stream, &message->as.sample);
      break;
    case PHX_COMMAND:
      pass_command(stream, &message->as.command);
      break;
    case PHX_COMMAND_WALLS:
      pass_walls(stream, &message->as.walls);
      break;
    case PHX_PING:
    case PHX_PONG:
      pass_u64(stream, &message->as.ping.stamp);
      pass_u64(stream, &message->as.ping.time_us);
      break;
    default: /* RESET and GOODBYE have no payload */
      break;
  }
}

/* ---- frames ---- */

/* CRC-32 of IEEE 802.3, reflected: polynomial 0xEDB88320, begins and ends inverted. It takes four bits
 * at a time: a table of 64 bytes, two look-ups a byte. */
static uint32_t crc32(const uint8_t* bytes, size_t size) {
  static const uint32_t table[16] = {
      0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u, 0x4DB26158u, 0x5005713Cu,
      0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu, 0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
  uint32_t crc = 0xFFFFFFFFu;
  for (size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    crc = (crc >> 4) ^ table[crc & 15u];
    crc = (crc >> 4) ^ table[crc & 15u];
  }
  return ~crc;
}

static uint32_t u32_at(const uint8_t* at) {
  return (uint32_t)at[0] | ((uint32_t)at[1] << 8) | ((uint32_t)at[2] << 16) | ((uint32_t)at[3] << 24);
}

static bool crc_is_right(const uint8_t* frame, size_t size) {
  return crc32(frame, size - PHX_CRC_SIZE) == u32_at(frame + size - PHX_CRC_SIZE);
}

size_t phx_frame_size(uint8_t type) {
  /* clang-format off */
  static const uint16_t payload[] = {
    0,                                         /* no type 0 */
    8,                                         /* HELLO */
    8 + PHX_SERIAL_SIZE + 3 + PHX_CHANNELS * 18, /* WELCOME */
    10,                                        /* REFUSED */
    PHX_CHANNELS * 8 + 8,                      /* CONFIGURE */
    41 + PHX_CHANNELS * 4,                     /* SAMPLE */
    17 + PHX_JOINTS * 4,                       /* COMMAND */
    17 + PHX_JOINTS * 4 + 4 + PHX_JOINTS * 4 + PHX_WALLS * (PHX_WALL_JOINTS + 4) * 4, /* COMMAND_WALLS */
    0,                                         /* RESET */
    0,                                         /* GOODBYE */
    16,                                        /* PING */
    16                                         /* PONG */
  };
  /* clang-format on */
  if (type < PHX_HELLO || type > PHX_PONG) return 0;
  return PHX_HEADER_SIZE + payload[type] + PHX_CRC_SIZE;
}

/* Flags that the header of a type may have; other bits are reserved. */
static unsigned known_flags(uint8_t type) { return type == PHX_WELCOME ? PHX_WELCOME_SIMULATED : 0u; }

size_t phx_encode(const phx_message* message, uint8_t* out, size_t capacity) {
  const size_t size = phx_frame_size(message->header.type);
  if (size == 0 || size > capacity) return 0;
  phx_stream stream = {out, false, true};
  phx_message* source = (phx_message*)message; /* a stream that does not read leaves it as it is */
  uint8_t first = 'P';
  uint8_t second = 'X';
  uint8_t version = PHX_VERSION;
  uint16_t whole = (uint16_t)size;
  /* only known bits: phx_decode() refuses a frame with others */
  uint16_t flags = 0;
  if (source->header.type == PHX_WELCOME)
    flags = (uint16_t)(source->as.welcome.flags & known_flags(PHX_WELCOME));
  pass_u8(&stream, &first);
  pass_u8(&stream, &second);
  pass_u8(&stream, &version);
  pass_u8(&stream, &source->header.type);
  pass_u16(&stream, &whole);
  pass_u16(&stream, &flags);
  pass_u32(&stream, &source->header.epoch);
  pass_u32(&stream, &source->header.sequence);
  pass_payload(&stream, source);
  uint32_t crc = crc32(out, size - PHX_CRC_SIZE);
  pass_u32(&stream, &crc);
  return size;
}

static bool channel_is_right(const phx_channel* channel) {
  static const uint8_t most[] = {PHX_JOINTS, PHX_JOINTS, 5, PHX_CHANNELS, 5, 5}; /* by kind */
  if (channel->kind > PHX_CHANNEL_SPLAY) return false;
  return channel->index < most[channel->kind] && channel->raw_min <= channel->raw_max &&
         channel->gain != 0.0f;
}

static bool welcome_is_right(const phx_welcome* welcome) {
  if (welcome->channel_count > PHX_CHANNELS || welcome->rate_hz == 0) return false;
  for (size_t i = 0; i < welcome->channel_count; ++i) {
    if (!channel_is_right(&welcome->channel[i])) return false;
  }
  return true;
}

static bool sample_is_right(const phx_sample* sample) {
  return sample->state <= PHX_STATE_LATCHED && sample->fault_channel < PHX_CHANNELS &&
         sample->factor >= 0.0f && sample->factor <= 1.0f;
}

static bool walls_are_right(const phx_command_walls* walls) {
  for (size_t i = 0; i < PHX_WALLS; ++i) {
    const phx_wall* wall = &walls->wall[i];
    if (wall->stiffness < 0.0f || wall->force_max < 0.0f || wall->host_force < 0.0f) return false;
  }
  return true;
}

static bool numbers_are_right(const phx_message* message) {
  switch (message->header.type) {
    case PHX_WELCOME:
      return welcome_is_right(&message->as.welcome);
    case PHX_CONFIGURE:
      return message->as.configure.torque_limit >= 0.0f && message->as.configure.torque_rate >= 0.0f;
    case PHX_SAMPLE:
      return sample_is_right(&message->as.sample);
    case PHX_COMMAND_WALLS:
      return walls_are_right(&message->as.walls);
    default:
      return true;
  }
}

/* Reads the parts that no later version may change: the first four bytes, the final CRC, HELLO's host_id. */
static enum phx_decoded decode_other_version(const uint8_t* frame, size_t size, phx_message* message) {
  if (!crc_is_right(frame, size)) return PHX_BAD_CRC;
  message->header.version = frame[2];
  message->header.type = frame[3];
  message->header.size = (uint16_t)size;
  message->header.epoch = 0;
  message->header.sequence = 0;
  if (frame[3] == PHX_HELLO) {
    const bool has_id = size >= PHX_HEADER_SIZE + 8u + PHX_CRC_SIZE;
    const uint8_t* id = frame + PHX_HEADER_SIZE;
    message->as.hello.host_id = has_id ? (uint64_t)u32_at(id) | ((uint64_t)u32_at(id + 4) << 32) : 0;
  }
  return PHX_OTHER_VERSION;
}

enum phx_decoded phx_decode(const uint8_t* frame, size_t size, phx_message* message) {
  if (size < 4u + PHX_CRC_SIZE || size > PHX_FRAME_MAX) return PHX_NOT_A_FRAME;
  if (frame[0] != 'P' || frame[1] != 'X') return PHX_NOT_A_FRAME;
  if (frame[2] != PHX_VERSION) return decode_other_version(frame, size, message);
  if (size != phx_frame_size(frame[3])) return PHX_NOT_A_FRAME;
  if (!crc_is_right(frame, size)) return PHX_BAD_CRC;
  uint16_t flags = 0;
  phx_stream stream = {(uint8_t*)frame + 2, true,
                       true}; /* a stream that reads leaves the bytes as they are */
  pass_u8(&stream, &message->header.version);
  pass_u8(&stream, &message->header.type);
  pass_u16(&stream, &message->header.size);
  pass_u16(&stream, &flags);
  pass_u32(&stream, &message->header.epoch);
  pass_u32(&stream, &message->header.sequence);
  if (message->header.size != size || (flags & ~known_flags(message->header.type)) != 0)
    return PHX_NOT_A_FRAME;
  pass_payload(&stream, message);
  if (message->header.type == PHX_WELCOME) message->as.welcome.flags = (uint8_t)flags;
  return stream.finite && numbers_are_right(message) ? PHX_OK : PHX_BAD_NUMBER;
}

/* ---- COBS: Cheshire, Baker, "Consistent overhead byte stuffing", IEEE/ACM Trans. Networking 7(2), 1999 */

size_t phx_cobs_encode(const uint8_t* frame, size_t size, uint8_t* out, size_t capacity) {
  size_t code_at = 0; /* where the count of the block being written belongs */
  size_t at = 1;
  uint8_t code = 1;
  if (capacity < 2) return 0;
  for (size_t i = 0; i < size; ++i) {
    if (at >= capacity) return 0;
    if (frame[i] != 0) {
      out[at++] = frame[i];
      ++code;
    }
    const bool full = code == 0xFFu && i + 1 < size;
    if (frame[i] != 0 && !full) continue;
    if (at >= capacity) return 0;
    out[code_at] = code;
    code_at = at++;
    code = 1;
  }
  if (at >= capacity) return 0;
  out[code_at] = code;
  out[at++] = 0;
  return at;
}

void phx_receiver_init(phx_receiver* receiver) {
  receiver->size = 0;
  receiver->left = 0;
  receiver->code = 0;
  receiver->broken = false;
  receiver->begun = false;
  receiver->dropped = 0;
}

static void receiver_append(phx_receiver* receiver, uint8_t byte) {
  if (receiver->size >= PHX_FRAME_MAX) {
    receiver->broken = true;
  } else {
    receiver->frame[receiver->size++] = byte;
  }
}

/* Ends a frame at its zero byte. Zeros alone are neither frame nor error: a sender may begin with one. */
static size_t receiver_close(phx_receiver* receiver) {
  const bool whole = receiver->begun && !receiver->broken && receiver->left == 0 && receiver->size > 0;
  const size_t size = whole ? receiver->size : 0;
  if (receiver->begun && !whole) ++receiver->dropped;
  receiver->size = 0;
  receiver->left = 0;
  receiver->broken = false;
  receiver->begun = false;
  return size;
}

size_t phx_receiver_take(phx_receiver* receiver, uint8_t byte) {
  if (byte == 0) return receiver_close(receiver);
  if (receiver->broken) return 0;
  if (receiver->left > 0) {
    receiver_append(receiver, byte);
    --receiver->left;
    return 0;
  }
  /* A block that was not full stands for a zero after it, unless the frame ends there. */
  if (receiver->begun && receiver->code != 0xFFu) receiver_append(receiver, 0);
  receiver->begun = true;
  receiver->code = byte;
  receiver->left = (uint8_t)(byte - 1u);
  return 0;
}

/* ---- the controller's side ---- */

static uint64_t elapsed_us(uint64_t now_us, uint64_t since_us) {
  return now_us > since_us ? now_us - since_us : 0;
}

/* Returns the age of the newest step. If the time is before the sample's own, the clock ran backwards: the
 * age is unknown, and the step counts as too old. */
static uint32_t step_age_us(const phx_controller* controller, uint64_t now_us) {
  const uint64_t sample_time_us = controller->step.command.sample_time_us;
  if (now_us < sample_time_us) return UINT32_MAX;
  const uint64_t age_us = now_us - sample_time_us;
  return age_us < UINT32_MAX ? (uint32_t)age_us : UINT32_MAX;
}

static bool enabled(const phx_controller* controller) {
  const unsigned flags = controller->step.command.flags & (PHX_COMMAND_ENABLE | PHX_COMMAND_FAULT);
  return controller->acting && flags == PHX_COMMAND_ENABLE;
}

static bool latched(const phx_controller* controller) { return controller->fault != PHX_FAULT_NONE; }

static float limit_or_zero(float value) { return is_finite(value) && value > 0.0f ? value : 0.0f; }

static void forget_torque(phx_controller* controller) {
  for (size_t i = 0; i < PHX_JOINTS; ++i) controller->torque[i] = 0.0f;
  controller->factor = 0.0f;
  controller->fade = 1.0f;
}

static void forget_step(phx_controller* controller) {
  controller->step = (phx_command_walls){0};
  controller->acting = false;
}

void phx_controller_init(phx_controller* controller, const phx_device* device, uint32_t first_epoch) {
  *controller = (phx_controller){0};
  controller->device = *device;
  if (controller->device.channel_count > PHX_CHANNELS) controller->device.channel_count = PHX_CHANNELS;
  controller->device.torque_limit = limit_or_zero(device->torque_limit);
  controller->device.torque_rate = limit_or_zero(device->torque_rate);
  controller->epoch = first_epoch;
  controller->fade = 1.0f;
}

static void reply_refused(phx_message* message, uint8_t reason) {
  const uint64_t host_id = message->as.hello.host_id;
  message->header.type = PHX_REFUSED;
  message->header.epoch = 0;
  message->as.refused.host_id = host_id;
  message->as.refused.reason = reason;
  message->as.refused.version = PHX_VERSION;
}

static void reply_welcome(const phx_controller* controller, phx_message* message) {
  const phx_device* device = &controller->device;
  message->header.type = PHX_WELCOME;
  message->header.epoch = controller->epoch;
  message->as.welcome.host_id = controller->host_id;
  for (size_t i = 0; i < PHX_SERIAL_SIZE; ++i) message->as.welcome.serial[i] = device->serial[i];
  message->as.welcome.rate_hz = device->rate_hz;
  message->as.welcome.channel_count = device->channel_count;
  message->as.welcome.flags = device->simulated ? PHX_WELCOME_SIMULATED : 0u;
  for (size_t i = 0; i < device->channel_count; ++i) message->as.welcome.channel[i] = device->channel[i];
}

static void open_session(phx_controller* controller, const phx_message* hello, uint64_t now_us) {
  ++controller->epoch;
  if (controller->epoch == 0) controller->epoch = 1; /* 0 means none */
  controller->host_id = hello->as.hello.host_id;
  controller->hello_sequence = hello->header.sequence;
  controller->session = true;
  controller->heard_us = now_us;
  controller->configured = false;
  controller->reset_us = 0;
  controller->sample_sequence = 0;
  controller->state = latched(controller) ? PHX_STATE_LATCHED : PHX_STATE_READY;
  forget_step(controller);
}

static enum phx_received take_hello(phx_controller* controller, phx_message* message, uint64_t now_us) {
  const bool held = controller->session && elapsed_us(now_us, controller->heard_us) < PHX_SESSION_US;
  if (held && message->as.hello.host_id != controller->host_id) {
    reply_refused(message, PHX_REFUSED_BUSY);
    return PHX_ANSWERED;
  }
  /* A HELLO that the network has doubled or delayed must not end the session that it has opened. */
  const uint32_t ahead = message->header.sequence - controller->hello_sequence;
  if (held && (ahead == 0 || ahead >= 0x80000000u)) {
    reply_welcome(controller, message);
    return PHX_USED;
  }
  open_session(controller, message, now_us);
  reply_welcome(controller, message);
  return PHX_NEW_SESSION;
}

/* Limits never change under an acting step: CONFIGURE waits until the host has disabled it. */
static void take_configure(phx_controller* controller, const phx_configure* configure) {
  if (enabled(controller) && !latched(controller)) return;
  controller->configure = *configure;
  controller->configured = true;
}

/* Returns true if no cause of a latch was present at the last tick. */
static bool causes_gone(const phx_controller* controller) {
  if (controller->estop || controller->drive_fault) return false;
  for (size_t i = 0; i < controller->device.channel_count; ++i) {
    if (controller->bad_samples[i] != 0) return false;
  }
  return true;
}

/* The newest tick is remembered, so that no repetition of an old command can start the device again. */
static void take_reset(phx_controller* controller, uint64_t now_us) {
  if (!latched(controller) || !causes_gone(controller)) return;
  controller->fault = PHX_FAULT_NONE;
  controller->fault_channel = 0;
  controller->acting = false;
  controller->reset_us = now_us;
  controller->state = PHX_STATE_READY;
}

static void close_session(phx_controller* controller) {
  controller->session = false;
  controller->configured = false;
  controller->state = latched(controller) ? PHX_STATE_LATCHED : PHX_STATE_NO_SESSION;
  forget_step(controller);
}

/* Makes the command the newest step, or returns why not. */
static enum phx_received take_command(phx_controller* controller, const phx_message* message,
                                      uint64_t now_us) {
  const bool walls = message->header.type == PHX_COMMAND_WALLS;
  const phx_command* command = walls ? &message->as.walls.command : &message->as.command;
  if (latched(controller) || !controller->configured) return PHX_USED;
  if (command->tick == controller->step.command.tick) return PHX_USED;
  if (command->sample_time_us > now_us) {
    ++controller->corrupt;
    return PHX_DROPPED;
  }
  if (command->tick < controller->step.command.tick || command->sample_time_us < controller->reset_us ||
      now_us - command->sample_time_us >= PHX_LATCH_AGE_US) {
    ++controller->outdated;
    return PHX_DROPPED;
  }
  const bool was_enabled = enabled(controller);
  if (walls) {
    controller->step = message->as.walls;
  } else {
    controller->step.command = *command;
    controller->step.valid_us = 0;
  }
  controller->acting = true;
  if (enabled(controller) && !was_enabled) controller->started_us = now_us;
  return PHX_USED;
}

static enum phx_received take_from_host(phx_controller* controller, const phx_message* message,
                                        uint64_t now_us) {
  if (!controller->session || message->header.epoch != controller->epoch) {
    ++controller->refused;
    return PHX_DROPPED;
  }
  controller->heard_us = now_us;
  switch (message->header.type) {
    case PHX_CONFIGURE:
      take_configure(controller, &message->as.configure);
      return PHX_USED;
    case PHX_RESET:
      take_reset(controller, now_us);
      return PHX_USED;
    case PHX_GOODBYE:
      close_session(controller);
      return PHX_USED;
    default:
      return take_command(controller, message, now_us);
  }
}

/* Handles a message. If header.type is one of the controller's own afterwards, `message` is the answer. */
static enum phx_received take_message(phx_controller* controller, phx_message* message, uint64_t now_us) {
  switch (message->header.type) {
    case PHX_HELLO:
      return take_hello(controller, message, now_us);
    case PHX_PING:
      message->header.type = PHX_PONG;
      message->header.epoch = 0;
      message->as.ping.time_us = now_us;
      return PHX_ANSWERED;
    case PHX_CONFIGURE:
    case PHX_COMMAND:
    case PHX_COMMAND_WALLS:
    case PHX_RESET:
    case PHX_GOODBYE:
      return take_from_host(controller, message, now_us);
    default: /* what controllers send: an echo */
      ++controller->corrupt;
      return PHX_DROPPED;
  }
}

enum phx_received phx_controller_receive(phx_controller* controller, const uint8_t* frame, size_t size,
                                         uint64_t now_us, uint8_t reply[PHX_FRAME_MAX], size_t* reply_size) {
  phx_message message;
  *reply_size = 0;
  const enum phx_decoded decoded = phx_decode(frame, size, &message);
  enum phx_received received = PHX_DROPPED;
  if (decoded == PHX_OK) {
    received = take_message(controller, &message, now_us);
  } else if (decoded == PHX_OTHER_VERSION && message.header.type == PHX_HELLO) {
    reply_refused(&message, PHX_REFUSED_VERSION);
    received = PHX_ANSWERED;
  } else {
    ++controller->corrupt;
  }
  if (received == PHX_DROPPED) return received;
  const uint8_t type = message.header.type;
  if (type == PHX_WELCOME || type == PHX_REFUSED || type == PHX_PONG) {
    *reply_size = phx_encode(&message, reply, PHX_FRAME_MAX);
  }
  return received;
}

/* ---- one tick ---- */

static void judge_sensors(phx_controller* controller, const int32_t* raw) {
  for (size_t i = 0; i < controller->device.channel_count; ++i) {
    const phx_channel* channel = &controller->device.channel[i];
    if (raw[i] >= channel->raw_min && raw[i] <= channel->raw_max) {
      controller->bad_samples[i] = 0;
    } else if (controller->bad_samples[i] < UINT8_MAX) {
      ++controller->bad_samples[i];
    }
  }
}

static void latch(phx_controller* controller, uint16_t fault, size_t channel) {
  if (latched(controller)) return; /* the first fault is the one to report */
  controller->fault = fault;
  controller->fault_channel = (uint8_t)channel;
}

/* Latches faults while a session is open. Without a session there is no torque, and no host to reset it. */
static void judge_faults(phx_controller* controller, uint64_t now_us) {
  if (!controller->session) return;
  if (controller->estop) latch(controller, PHX_FAULT_EMERGENCY_STOP, 0);
  if (controller->drive_fault) latch(controller, PHX_FAULT_DRIVE, 0);
  for (size_t i = 0; i < controller->device.channel_count; ++i) {
    if (controller->bad_samples[i] >= PHX_BAD_SAMPLES) latch(controller, PHX_FAULT_SENSOR_RANGE, i);
  }
  if (enabled(controller) && step_age_us(controller, now_us) >= PHX_LATCH_AGE_US) {
    latch(controller, PHX_FAULT_STEP_TOO_OLD, 0);
  }
}

/* Returns 1 up to PHX_HOLD_AGE_US, 0 from PHX_LATCH_AGE_US on, and a linear factor between. */
static float fade_of_age(uint32_t age_us) {
  if (age_us <= PHX_HOLD_AGE_US) return 1.0f;
  if (age_us >= PHX_LATCH_AGE_US) return 0.0f;
  return (float)(PHX_LATCH_AGE_US - age_us) / (float)(PHX_LATCH_AGE_US - PHX_HOLD_AGE_US);
}

static float start_ramp(const phx_controller* controller, uint64_t now_us) {
  const uint64_t since_us = elapsed_us(now_us, controller->started_us);
  return since_us >= PHX_START_RAMP_US ? 1.0f : (float)(uint32_t)since_us / (float)PHX_START_RAMP_US;
}

/* Returns the real time since the last tick, at most two periods; the nominal period if it is unknown. */
static float tick_seconds(const phx_controller* controller, uint64_t now_us) {
  const uint32_t period_us = controller->device.rate_hz > 0 ? 1000000u / controller->device.rate_hz : 1000u;
  uint64_t dt_us = period_us;
  if (controller->ticked && now_us >= controller->last_tick_us) dt_us = now_us - controller->last_tick_us;
  if (dt_us > 2u * period_us) dt_us = 2u * period_us;
  return (float)(uint32_t)dt_us * 1e-6f;
}

/* Computes q - q_ref of every joint that a channel measures. It is 0 for the others, for a channel that is
 * configured with gain 0, and while its raw value is out of range. */
static void wall_angles(const phx_controller* controller, const int32_t* raw, float moved[PHX_JOINTS]) {
  for (size_t i = 0; i < PHX_JOINTS; ++i) moved[i] = 0.0f;
  for (size_t i = 0; i < controller->device.channel_count; ++i) {
    const phx_channel* channel = &controller->device.channel[i];
    const float gain = controller->configure.gain[i];
    if (channel->kind != PHX_CHANNEL_ANGLE || channel->index >= PHX_JOINTS) continue;
    if (gain == 0.0f || controller->bad_samples[i] != 0) continue;
    const float q = gain * (float)raw[i] + controller->configure.offset[i];
    moved[channel->index] = q - controller->step.q_ref[channel->index];
  }
}

/* Equals phalanx::local_wall_force() of force/local_wall.h. */
static float wall_force(const phx_wall* wall, const float* moved) {
  float depth = wall->d_ref;
  for (size_t i = 0; i < PHX_WALL_JOINTS; ++i) depth -= wall->g[i] * moved[i];
  const float force = wall->stiffness * depth;
  if (force >= wall->force_max) return wall->force_max;
  return force > 0.0f ? force : 0.0f; /* not a number: 0 */
}

/* Adds  sum g (f - host_force)  of the walls that are still valid. */
static void add_walls(const phx_controller* controller, uint64_t now_us, const int32_t* raw,
                      float torque[PHX_JOINTS]) {
  if (controller->step.valid_us == 0) return;
  if (step_age_us(controller, now_us) > controller->step.valid_us) return;
  float moved[PHX_JOINTS];
  wall_angles(controller, raw, moved);
  for (size_t w = 0; w < PHX_WALLS; ++w) {
    const phx_wall* wall = &controller->step.wall[w];
    const size_t first = w / 3u * PHX_WALL_JOINTS; /* joint of the wall's digit */
    if (!(wall->stiffness > 0.0f)) continue;
    const float change = wall_force(wall, &moved[first]) - wall->host_force;
    for (size_t i = 0; i < PHX_WALL_JOINTS; ++i) torque[first + i] += wall->g[i] * change;
  }
}

static float clamp(float value, float limit) {
  if (value > limit) return limit;
  return value < -limit ? -limit : value;
}

static float smaller(float a, float b) { return a < b ? a : b; }

/* Returns the largest change of a torque in this tick. It is the rate limit; if the host is in fault, it is
 * at least the change that reaches zero from the largest torque within PHX_STOP_RAMP_US. */
static float largest_change(const phx_controller* controller, float limit, float seconds) {
  const float ordinary = smaller(controller->device.torque_rate, controller->configure.torque_rate) * seconds;
  const float stopping = limit * seconds / (1e-6f * (float)PHX_STOP_RAMP_US);
  const bool fault = (controller->step.command.flags & PHX_COMMAND_FAULT) != 0;
  return fault && stopping > ordinary ? stopping : ordinary;
}

/* Applies torque limit, start ramp and torque-rate limit. The ramp comes before the rate limit, so that both
 * together never change the torque faster than the rate. The torque limit is applied last. */
static void limit_torques(phx_controller* controller, float ramp, float seconds, float torque[PHX_JOINTS]) {
  const float limit = smaller(controller->device.torque_limit, controller->configure.torque_limit);
  const float step = largest_change(controller, limit, seconds);
  for (size_t i = 0; i < PHX_JOINTS; ++i) {
    const float target = is_finite(torque[i]) ? ramp * clamp(torque[i], limit) : 0.0f;
    const float last = controller->torque[i];
    torque[i] = clamp(last + clamp(target - last, step), limit);
  }
}

/* If a newer step ends a fade, makes the torque rise from the last output at the rate limit, not at once. */
static void continue_from_sent(phx_controller* controller, float fade) {
  if (!(fade > controller->fade)) return;
  const float ratio = controller->fade / fade;
  for (size_t i = 0; i < PHX_JOINTS; ++i) controller->torque[i] *= ratio;
}

/* Computes the torques while acting and not latched: the step's torques through walls, limits and age. */
static void act(phx_controller* controller, uint64_t now_us, const int32_t* raw, phx_output* output) {
  const bool on = enabled(controller);
  const float fade = fade_of_age(step_age_us(controller, now_us));
  const float ramp = on ? start_ramp(controller, now_us) : 0.0f;
  if (on) {
    for (size_t i = 0; i < PHX_JOINTS; ++i) output->torque[i] = controller->step.command.torque[i];
    add_walls(controller, now_us, raw, output->torque);
  }
  continue_from_sent(controller, fade);
  limit_torques(controller, ramp, tick_seconds(controller, now_us), output->torque);
  for (size_t i = 0; i < PHX_JOINTS; ++i) {
    if (!is_finite(output->torque[i])) output->torque[i] = 0.0f;
    controller->torque[i] = output->torque[i];
    output->torque[i] *= fade;
  }
  controller->fade = fade;
  controller->factor = ramp * fade;
}

static uint8_t state_of(const phx_controller* controller, uint64_t now_us) {
  if (latched(controller)) return PHX_STATE_LATCHED;
  if (!controller->session) return PHX_STATE_NO_SESSION;
  if (!enabled(controller)) return PHX_STATE_READY;
  if (step_age_us(controller, now_us) > PHX_HOLD_AGE_US) return PHX_STATE_FADING;
  return elapsed_us(now_us, controller->started_us) < PHX_START_RAMP_US ? PHX_STATE_STARTING
                                                                        : PHX_STATE_ACTIVE;
}

static void make_sample(phx_controller* controller, uint64_t now_us, const int32_t* raw, phx_output* output) {
  phx_message message;
  phx_sample* sample = &message.as.sample;
  message.header.type = PHX_SAMPLE;
  message.header.epoch = controller->epoch;
  message.header.sequence = ++controller->sample_sequence;
  sample->time_us = now_us;
  sample->acted_tick = controller->acting ? controller->step.command.tick : 0;
  sample->acted_age_us = controller->acting ? step_age_us(controller, now_us) : 0;
  sample->state = controller->state;
  sample->flags = (uint8_t)((controller->estop ? PHX_SAMPLE_ESTOP : 0u) |
                            (controller->configured ? PHX_SAMPLE_CONFIGURED : 0u));
  sample->fault = controller->fault;
  sample->fault_channel = controller->fault_channel;
  sample->factor = controller->factor;
  sample->corrupt = controller->corrupt;
  sample->refused = controller->refused;
  sample->outdated = controller->outdated;
  for (size_t i = 0; i < PHX_CHANNELS; ++i)
    sample->raw[i] = i < controller->device.channel_count ? raw[i] : 0;
  output->sample_size = phx_encode(&message, output->sample, PHX_FRAME_MAX);
}

void phx_controller_tick(phx_controller* controller, uint64_t now_us, const int32_t raw[PHX_CHANNELS],
                         bool estop, bool drive_fault, phx_output* output) {
  for (size_t i = 0; i < PHX_JOINTS; ++i) output->torque[i] = 0.0f;
  output->sample_size = 0;
  controller->estop = estop;
  controller->drive_fault = drive_fault;
  judge_sensors(controller, raw);
  judge_faults(controller, now_us);
  if (controller->session && elapsed_us(now_us, controller->heard_us) >= PHX_SESSION_US) {
    close_session(controller);
  }
  if (latched(controller) || !controller->acting) {
    forget_torque(controller);
  } else {
    act(controller, now_us, raw, output);
  }
  controller->state = state_of(controller, now_us);
  controller->last_tick_us = now_us;
  controller->ticked = true;
  if (controller->session) make_sample(controller, now_us, raw, output);
}
