/* SPDX-License-Identifier: Apache-2.0
 *
 * The Phalanx link, version 1: the messages between an exoskeleton's controller and its host. They go over
 * UDP (one frame a datagram) or over a serial line. A serial line uses COBS (Consistent Overhead Byte
 * Stuffing) with a zero byte after each frame. This header and phalanx_link.c are the reference: C99, no
 * allocation, no other file, no operating system. Firmware may use both unchanged (bytes: docs/link.md).
 *
 * All numbers are little-endian, floats IEEE 754 binary32. Units are SI and radians, except for raw counts.
 * CRC-32 is the cyclic redundancy check of IEEE 802.3. A frame is
 *   header (16 bytes), payload of the type's fixed size, CRC-32 of everything before it.
 */
#ifndef PHALANX_DEVICE_LINK_PHALANX_LINK_H
#define PHALANX_DEVICE_LINK_PHALANX_LINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PHX_VERSION 1u
#define PHX_HEADER_SIZE 16u
#define PHX_CRC_SIZE 4u
#define PHX_JOINTS 20u      /* 5 digits (thumb first), 4 joints each, in the order of docs/link.md */
#define PHX_CHANNELS 32u    /* most channels of a device */
#define PHX_WALLS 15u       /* at most 3 a digit: wall w belongs to digit w / 3 */
#define PHX_WALL_JOINTS 4u  /* a wall moves the joints of its digit */
#define PHX_SERIAL_SIZE 16u /* serial number: ASCII, padded with zeros */
#define PHX_FRAME_MAX 1024u /* no frame is larger; see phx_frame_size() */
#define PHX_COBS_MAX (PHX_FRAME_MAX + PHX_FRAME_MAX / 254u + 2u) /* encoded, with the closing zero */

/* Type of a frame. Sender: H host, C controller. */
enum phx_type {
  PHX_HELLO = 1,         /* H  asks for the session */
  PHX_WELCOME = 2,       /* C  grants it: serial number, channels, the session's epoch */
  PHX_REFUSED = 3,       /* C  refuses it */
  PHX_CONFIGURE = 4,     /* H  calibration and limits; repeated until a sample has CONFIGURED */
  PHX_SAMPLE = 5,        /* C  every tick of the controller while a session is open */
  PHX_COMMAND = 6,       /* H  torques, repeated at 1 kHz */
  PHX_COMMAND_WALLS = 7, /* H  torques and local walls */
  PHX_RESET = 8,         /* H  clears a latched fault whose cause is gone */
  PHX_GOODBYE = 9,       /* H  gives the session back */
  PHX_PING = 10,         /* H  any sender may; answered with PONG */
  PHX_PONG = 11          /* C */
};

/* Reason of a refused HELLO. */
enum phx_refusal {
  PHX_REFUSED_BUSY = 1,   /* another host has the session */
  PHX_REFUSED_VERSION = 2 /* this controller speaks phx_refused.version */
};

/* Quantity that a channel measures, and the meaning of `index`. */
enum phx_channel_kind {
  PHX_CHANNEL_ANGLE = 0,  /* joint angle [rad]; index: joint, 0 .. 19 */
  PHX_CHANNEL_TORQUE = 1, /* torque on a joint [Nm]; index: joint */
  PHX_CHANNEL_FORCE = 2,  /* force at a digit's tip [N]; index: digit, 0 thumb .. 4 little */
  PHX_CHANNEL_MOTOR =
      3, /* wound length of a motor [m]; index: motor, in the order of their names in the device file */
  PHX_CHANNEL_CURL = 4, /* a whole digit: 0 open .. 1 closed; index: digit */
  PHX_CHANNEL_SPLAY = 5 /* abduction of a digit, -1 .. 1 of its range; index: digit */
};

/* value = gain * raw + offset. A raw value outside raw_min .. raw_max is an open or shorted sensor. */
typedef struct {
  uint8_t kind;  /* enum phx_channel_kind */
  uint8_t index; /* of the joint, digit or motor */
  int32_t raw_min;
  int32_t raw_max;
  float gain;   /* nominal; the host's calibration replaces it */
  float offset; /* nominal */
} phx_channel;

/* Reason of the controller's latch. The host's own faults continue this list (phalanx/device/fault.h). */
enum phx_fault {
  PHX_FAULT_NONE = 0,
  PHX_FAULT_STEP_TOO_OLD = 1,   /* the step acted on became PHX_LATCH_AGE_US old */
  PHX_FAULT_SENSOR_RANGE = 2,   /* a raw value was outside its channel's range in 3 samples in a row */
  PHX_FAULT_EMERGENCY_STOP = 3, /* the emergency stop was pressed */
  PHX_FAULT_DRIVE = 4           /* the device's own: a motor driver, a supply, a temperature */
};

/* State of the controller. */
enum phx_state {
  PHX_STATE_NO_SESSION = 0, /* zero torque */
  PHX_STATE_READY = 1,      /* session open, not enabled: zero torque, or on its way there */
  PHX_STATE_STARTING = 2,   /* torque rises over PHX_START_RAMP_US */
  PHX_STATE_ACTIVE = 3,     /* commands act */
  PHX_STATE_FADING = 4,     /* the step acted on is older than PHX_HOLD_AGE_US: torque falls */
  PHX_STATE_LATCHED = 5     /* zero torque until RESET */
};

/* The AGE of a step is the controller's time minus its own time of the sample that the step was computed
 * from. Every command carries that time back. No clocks need to agree, and no repetition or queue can make an
 * old step look new. */
#define PHX_HOLD_AGE_US 14000u /* up to here the step acts in full */
#define PHX_LATCH_AGE_US \
  20000u /* from PHX_HOLD_AGE_US on it falls linearly to zero; here it is zero and latched */
#define PHX_START_RAMP_US 1000000u
#define PHX_STOP_RAMP_US 5000u /* from the largest torque to zero, for any rate limit */
#define PHX_SESSION_US \
  1000000u                 /* without a frame of its host for this long, another host may take a session */
#define PHX_BAD_SAMPLES 3u /* of a channel, in a row, until the controller latches */

typedef struct {
  uint8_t type; /* enum phx_type */
  uint8_t version;
  uint16_t size;     /* of the whole frame, CRC included */
  uint32_t epoch;    /* of the session; 0 in HELLO, REFUSED, PING, PONG */
  uint32_t sequence; /* of the sender's frames of this type, from 1; an answer has its question's */
} phx_header;

typedef struct {
  uint64_t host_id; /* random for each run of a host; identifies the session's owner */
} phx_hello;

#define PHX_WELCOME_SIMULATED 0x01u /* no motor and no person are connected: what is measured is computed */

typedef struct {
  uint64_t host_id; /* of the HELLO that it answers */
  char serial[PHX_SERIAL_SIZE];
  uint16_t rate_hz; /* of samples and control */
  uint8_t channel_count;
  uint8_t flags; /* PHX_WELCOME_*; on the wire they are the header's bytes 6 and 7 */
  phx_channel channel[PHX_CHANNELS];
} phx_welcome;

typedef struct {
  uint64_t host_id;
  uint8_t reason;  /* enum phx_refusal */
  uint8_t version; /* that the controller speaks */
} phx_refused;

typedef struct {
  float gain[PHX_CHANNELS];   /* calibrated: value = gain * raw + offset */
  float offset[PHX_CHANNELS]; /* the controller uses them for the local walls only */
  float torque_limit;         /* [Nm] the controller takes the smaller of this and its own */
  float torque_rate;          /* [Nm/s] likewise */
} phx_configure;

#define PHX_SAMPLE_ESTOP 0x01u      /* the emergency stop is pressed now */
#define PHX_SAMPLE_CONFIGURED 0x02u /* CONFIGURE has arrived in this session */

typedef struct {
  uint64_t time_us;      /* the controller's clock at the measurement */
  uint64_t acted_tick;   /* tick of the step acted on; 0: none */
  uint32_t acted_age_us; /* its age at this sample */
  uint8_t state;         /* enum phx_state */
  uint8_t flags;         /* PHX_SAMPLE_* */
  uint16_t fault;        /* enum phx_fault that it is latched for */
  uint8_t fault_channel; /* of SENSOR_RANGE */
  float factor;          /* on the commanded torque: 0 .. 1 */
  uint32_t corrupt;      /* frames dropped: not a frame, CRC, size, version, a number not finite */
  uint32_t refused;      /* frames dropped: another epoch */
  uint32_t outdated;     /* commands not used: their step was not newer than the one acted on, or too old */
  int32_t raw[PHX_CHANNELS];
} phx_sample;

#define PHX_COMMAND_FAULT \
  0x02u /* the host is in fault: torque is zero within PHX_STOP_RAMP_US, also with ENABLE */
#define PHX_COMMAND_ENABLE 0x01u /* without it the torque goes to zero and the state to READY, no fault */

typedef struct {
  uint64_t tick;            /* of the host's step, from 1: larger is newer; a repetition has the same */
  uint64_t sample_time_us;  /* phx_sample.time_us of the sample that the step used */
  uint8_t flags;            /* PHX_COMMAND_* */
  float torque[PHX_JOINTS]; /* [Nm] */
} phx_command;

/* One contact, linearised at q_ref:  f = clamp(stiffness (d_ref - g . (q - q_ref)), 0, force_max).  Its
 * torque g f replaces the g host_force that `torque` contains for it. */
typedef struct {
  float g[PHX_WALL_JOINTS]; /* [m] */
  float d_ref;              /* [m] */
  float stiffness;          /* [N/m]; 0: no wall */
  float force_max;          /* [N] */
  float host_force;         /* [N] */
} phx_wall;

typedef struct {
  phx_command command;
  uint32_t valid_us;       /* the walls may be used until sample_time_us + valid_us */
  float q_ref[PHX_JOINTS]; /* [rad] */
  phx_wall wall[PHX_WALLS];
} phx_command_walls;

typedef struct {
  uint64_t stamp;   /* of the sender of PING; returned unchanged */
  uint64_t time_us; /* PONG: the controller's clock; PING: 0 */
} phx_ping;         /* PONG has the same payload */

typedef struct {
  phx_header header;
  union {
    phx_hello hello;
    phx_welcome welcome;
    phx_refused refused;
    phx_configure configure;
    phx_sample sample;
    phx_command command;
    phx_command_walls walls;
    phx_ping ping; /* PING and PONG; RESET and GOODBYE have no payload */
  } as;
} phx_message;

/* ---- frames ---- */

/* Returns the size of a frame of a type, header and CRC included; 0 for an unknown type. */
size_t phx_frame_size(uint8_t type);

/* Writes `message` into `out`; header.type, epoch and sequence are taken from it, version and size are set.
 * Returns the frame's size, 0 if the type is unknown or `capacity` too small. */
size_t phx_encode(const phx_message* message, uint8_t* out, size_t capacity);

/* Result of phx_decode(). */
enum phx_decoded {
  PHX_OK = 0,
  PHX_NOT_A_FRAME = 1, /* too short, wrong first bytes, unknown type, or a size that is not the type's */
  PHX_BAD_CRC = 2,
  PHX_OTHER_VERSION = 3, /* header.version and header.type are filled in, of HELLO host_id as well */
  PHX_BAD_NUMBER = 4     /* a float that is not finite, a count or kind out of range */
};

/* Reads one frame. `message` is whole only after PHX_OK. Any bytes of any size are allowed. */
enum phx_decoded phx_decode(const uint8_t* frame, size_t size, phx_message* message);

/* Encodes with COBS and the closing zero. Returns the encoded size, 0 if `capacity` is too small. */
size_t phx_cobs_encode(const uint8_t* frame, size_t size, uint8_t* out, size_t capacity);

/* Receiver that collects a serial stream into frames. It has memory for one frame, and resynchronises at the
 * next zero byte. */
typedef struct {
  uint8_t frame[PHX_FRAME_MAX]; /* decoded so far */
  size_t size;
  uint8_t left; /* bytes of the block still to come */
  uint8_t code; /* of the block */
  bool broken;  /* too long or malformed: skip to the next zero byte */
  bool begun;
  uint32_t dropped; /* frames that were broken */
} phx_receiver;

/* Empties a receiver. */
void phx_receiver_init(phx_receiver* receiver);
/* Takes one byte. If the byte completes a frame, returns its size; the frame stays in receiver->frame until
 * the next call. Else returns 0. */
size_t phx_receiver_take(phx_receiver* receiver, uint8_t byte);

/* ---- the controller's side of a session: what firmware calls ---- */

typedef struct {
  char serial[PHX_SERIAL_SIZE];
  uint16_t rate_hz;
  uint8_t channel_count;
  bool simulated; /* false in firmware: the host must be able to trust it. See PHX_WELCOME_SIMULATED */
  phx_channel channel[PHX_CHANNELS];
  float torque_limit; /* [Nm] of every joint, the device's own */
  float torque_rate;  /* [Nm/s] of every joint, the device's own */
} phx_device;

typedef struct {
  phx_device device;
  uint32_t epoch;          /* of the session; also the last one given out */
  uint64_t host_id;        /* owner of the session */
  uint32_t hello_sequence; /* of the HELLO that opened it; an older or equal one is a repetition */
  bool session;            /* a session is open */
  uint64_t heard_us;       /* when its host was last heard */
  bool configured;
  phx_configure configure;
  uint8_t state;  /* enum phx_state */
  uint16_t fault; /* enum phx_fault */
  uint8_t fault_channel;
  bool acting;              /* a step has been taken since the session was opened or reset */
  phx_command_walls step;   /* the newest step; no walls: valid_us = 0 */
  uint64_t started_us;      /* when STARTING began */
  uint64_t reset_us;        /* of the last RESET: steps from earlier samples are not taken */
  float factor;             /* of the last tick: start ramp times fade */
  float fade;               /* of the last tick: 1, less from PHX_HOLD_AGE_US on */
  float torque[PHX_JOINTS]; /* of the last tick before the fade; the rate limit counts from it [Nm] */
  uint8_t bad_samples[PHX_CHANNELS];
  bool estop;            /* at the last tick */
  bool drive_fault;      /* at the last tick */
  bool ticked;           /* there was a last tick */
  uint64_t last_tick_us; /* when phx_controller_tick() was called last */
  uint32_t sample_sequence;
  uint32_t corrupt;
  uint32_t refused;
  uint32_t outdated;
} phx_controller;

/* Initialises a controller. `first_epoch` differs from boot to boot (a counter in flash, a random number), so
 * that commands of a session before the restart are refused. */
void phx_controller_init(phx_controller* controller, const phx_device* device, uint32_t first_epoch);

/* Result of phx_controller_receive(). */
enum phx_received {
  PHX_DROPPED = 0,     /* counted in corrupt, refused or outdated, without another effect, except
                          that any command of the session shows that its host is alive */
  PHX_USED = 1,        /* from the session's host */
  PHX_NEW_SESSION = 2, /* a HELLO was granted: samples go to its sender from now on */
  PHX_ANSWERED = 3     /* not from the session's host; only `reply` concerns its sender */
};

/* Takes one received frame (bytes between COBS zeros, or a datagram) at the controller's time. If
 * `*reply_size` is not 0 afterwards, send `reply` back to the sender. It never changes a torque; only
 * phx_controller_tick() does. */
enum phx_received phx_controller_receive(phx_controller* controller, const uint8_t* frame, size_t size,
                                         uint64_t now_us, uint8_t reply[PHX_FRAME_MAX], size_t* reply_size);

/* Output of the controller for one tick. */
typedef struct {
  float torque[PHX_JOINTS]; /* to the motors: finite, within limit and rate, times the factor [Nm] */
  size_t sample_size;       /* of the frame below; 0: no session, nothing to send */
  uint8_t sample[PHX_FRAME_MAX];
} phx_output;

/* Makes one tick: judges the sensors and the step's age, evaluates the walls, limits the torques, and makes
 * the sample frame. The order is
 *   torque -> walls -> finite check -> torque limit -> start ramp -> torque-rate limit -> torque limit
 *   -> finite check -> fade or latch.
 * The ramp comes before the rate limit, so that only a fade or a latch (towards zero) is faster than that.
 * `drive_fault`: the device's own hardware reports a fault, which latches PHX_FAULT_DRIVE. */
void phx_controller_tick(phx_controller* controller, uint64_t now_us, const int32_t raw[PHX_CHANNELS],
                         bool estop, bool drive_fault, phx_output* output);

#ifdef __cplusplus
}
#endif
#endif
