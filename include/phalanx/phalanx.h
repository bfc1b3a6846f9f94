// SPDX-License-Identifier: Apache-2.0
//
// The C interface of Phalanx: one shared library, libphalanx.so.0, and this header, which is C99 and C++.
// It is for Unity, Unreal, MATLAB, LabVIEW and every language that can call C (docs/c-api.md).
//
//   scene (a file, a name or TOML text) -> model (hand and objects) -> state -> phalanx_step() -> snapshot
//
// Units are SI and radians. The world frame is W; a pose X_AB gives a point in frame A from one in frame B.
// Joints: 20, digit by digit from the thumb, each with flexion, abduction and two hinges. Segments: 16,
// digit by digit from the palm to the tip; the palm is last. HCP is the hand as measured, GDP the hand as
// shown, which does not penetrate an object.
//
// Failure. A function returns a phalanx_result. On failure it changes none of its outputs, unless stated,
// and phalanx_error_text() has the reason in the words of the C++ library. No exception leaves a function.
// A null pointer, a handle that is destroyed, of another kind or invented, and a wrong size are refused.
//
// Structs. The first member `struct_size` is the size that the caller knows: sizeof(struct). A smaller size
// than the library's is allowed from the size stated at the struct on, in multiples of 8: the library then
// reads or writes only that much, and takes defaults for the rest. So a program that was compiled with an
// older header works with a newer library. A larger size is refused with PHALANX_ERROR_SIZE. New members
// are added at the end only. Structs without `struct_size` are parts of others and do not change.
//
// Threads. Different handles may be used by different threads at the same time. One handle is used by one
// thread at a time, unless stated. A handle is never destroyed while another thread uses it.
//
// Real-time. Functions marked so allocate no memory, take no lock, throw nothing and do no I/O. Their
// failures are the exception: these write a text.
#ifndef PHALANX_PHALANX_H
#define PHALANX_PHALANX_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define PHALANX_API __attribute__((visibility("default")))
#else
#define PHALANX_API
#endif

#define PHALANX_DIGITS 5     ///< thumb, index, middle, ring, little
#define PHALANX_JOINTS 20    ///< joint 4 d + i is joint i of digit d
#define PHALANX_SEGMENTS 16  ///< segment 3 d + k is segment k of digit d, from the palm; 15 is the palm

// ---- results

/// Result of a function: one of PHALANX_OK and PHALANX_ERROR_*.
typedef int32_t phalanx_result;

enum {
  PHALANX_OK = 0,
  PHALANX_ERROR_NULL = 1,     ///< a pointer that must not be null is null
  PHALANX_ERROR_HANDLE = 2,   ///< not a handle of this kind, or destroyed
  PHALANX_ERROR_SIZE = 3,     ///< struct_size, or the size of an array or buffer
  PHALANX_ERROR_INDEX = 4,    ///< an index or a choice is out of range
  PHALANX_ERROR_REFUSED = 5,  ///< an input cannot be used: scene, key, value, mesh, file of a scene
  PHALANX_ERROR_NOT_NOW = 6,  ///< the call is not allowed in this state
  PHALANX_ERROR_FAILED = 7,   ///< a file or the system failed
  PHALANX_ERROR_MEMORY = 8,   ///< out of memory
  PHALANX_ERROR_INTERNAL = 9  ///< an error of Phalanx; please report it
};

/// Returns the version of the library, "0.1.0". The text lives as long as the library. Real-time.
PHALANX_API const char* phalanx_version(void);

/// Returns the reason of the last failure of a call by this thread, in UTF-8, at most 2,047 bytes; ""
/// before the first. The text is valid until the next failure of a call by this thread. Successful calls
/// leave it. Real-time.
PHALANX_API const char* phalanx_error_text(void);

/// Returns a result's name, "PHALANX_ERROR_NULL"; "unknown" for another number. Real-time.
PHALANX_API const char* phalanx_result_name(phalanx_result result);

// ---- names
// Each returns a text that lives as long as the library, or null if the number is out of range. Real-time.

/// Returns the name of a digit, "index".
PHALANX_API const char* phalanx_digit_name(int32_t digit);
/// Returns the name of a joint, as in motion files and tables.
PHALANX_API const char* phalanx_joint_name(int32_t joint);
/// Returns the name of a segment, as in WebXR.
PHALANX_API const char* phalanx_segment_name(int32_t segment);
/// Returns the name of bit `bit` of a status, 0 .. 13, "start_inside".
PHALANX_API const char* phalanx_status_name(int32_t bit);

/// Conditions of a step: bits of `status`. Several may hold at once.
enum {
  PHALANX_STATUS_SAMPLE_NOT_FINITE = 1 << 0,  ///< an angle was NaN or infinite; its last good value was used
  PHALANX_STATUS_SAMPLE_OUT_OF_RANGE = 1 << 1,  ///< an angle was outside the range of motion; it was clamped
  PHALANX_STATUS_SAMPLE_JUMP = 1 << 2,          ///< an angle was faster than limits.joint_speed
  PHALANX_STATUS_TIME_NOT_INCREASING = 1 << 3,  ///< the time did not increase; the angles were not used
  /// A digit started inside an object. It has no force, unless its opening is confirmed.
  PHALANX_STATUS_START_INSIDE = 1 << 4,
  PHALANX_STATUS_SLID = 1 << 5,                   ///< a contact's offset exceeds contact.slid_mm
  PHALANX_STATUS_SEARCH_EXHAUSTED = 1 << 6,       ///< the contact search stopped a digit early
  PHALANX_STATUS_FORCE_LIMITED = 1 << 7,          ///< the fingertip cap changed the force
  PHALANX_STATUS_TORQUE_LIMITED = 1 << 8,         ///< the joint torque limit acted
  PHALANX_STATUS_TORQUE_RATE_LIMITED = 1 << 9,    ///< the torque-rate limit acted
  PHALANX_STATUS_COMMAND_NOT_FINITE = 1 << 10,    ///< a torque was not finite; it was set to zero
  PHALANX_STATUS_TRAJECTORY_EXHAUSTED = 1 << 11,  ///< gdp.method = "trajectory" found no free pose
  PHALANX_STATUS_SAMPLE_STALE = 1 << 12,          ///< no sample was wholly good for 50 ms
  PHALANX_STATUS_OSCILLATING = 1 << 13            ///< the force of a segment oscillates
};

// ---- scene

/// Scene: hand, objects, parameters and motion, as a scene file states them (docs/scenes.md).
typedef struct phalanx_scene phalanx_scene;

/// Reads a scene. Not real-time.
/// @param name   of a shipped scene ("grasp_teapot"), or a path, which contains `/` or ends with .toml
/// @param scene  receives the handle; phalanx_scene_destroy() frees it
/// @returns PHALANX_ERROR_REFUSED if it cannot be read; the text names file and line, key, value and remedy
PHALANX_API phalanx_result phalanx_scene_load(const char* name, phalanx_scene** scene);

/// Reads a scene from TOML text; "" has the default of every key. Not real-time.
/// @param text    UTF-8
/// @param folder  in which the scene's relative paths are looked up; null: the working directory
/// @returns as phalanx_scene_load()
PHALANX_API phalanx_result phalanx_scene_parse(const char* text, const char* folder, phalanx_scene** scene);

/// Replaces a value, as `--set KEY=VALUE` does. Models, states and motions that exist do not change. Not
/// real-time.
/// @param key    path of a scene's key: "force.stiffness_n_per_mm", "objects.0.size_mm"
/// @param value  as in a scene file; what is not TOML is taken as a text. "": the scene's own value again
/// @returns PHALANX_ERROR_REFUSED for an unknown key or a value out of range; the scene is then as before
PHALANX_API phalanx_result phalanx_scene_set(phalanx_scene* scene, const char* key, const char* value);

/// Reads a value as written in a scene file: `500`, `"hooke"` with its quotes. A key that the scene does
/// not state has its default; "" is a key without a default. Not real-time.
/// @param text    receives the value and a zero byte; null if `size` is 0
/// @param size    of `text` [bytes]
/// @param needed  receives the size with the zero byte, also if `size` is too small; may be null
/// @returns PHALANX_ERROR_SIZE if `size` is above 0 and too small; PHALANX_ERROR_REFUSED for an unknown key
PHALANX_API phalanx_result phalanx_scene_get(const phalanx_scene* scene, const char* key, char* text,
                                             size_t size, size_t* needed);

/// Frees the scene. What was made of it remains. Null has no effect. Not real-time.
PHALANX_API phalanx_result phalanx_scene_destroy(phalanx_scene* scene);

// ---- model

/// Rigid pose X_AB:  p_A = R p_B + p.
typedef struct phalanx_pose {
  double rotation[9];  ///< R by rows, orthonormal
  double position[3];  ///< p [m]
} phalanx_pose;

/// Hand of round numbers that needs no file: five equal straight digits along -Z of the hand frame H,
/// scaled to a size. H is WebXR's wrist: origin at the wrist's centre, +Y out of the back of the hand, +X
/// to the right of a right hand held palm down. Zero is the default of each member. Smallest size: 8.
typedef struct phalanx_hand {
  uint32_t struct_size;
  uint32_t left;       ///< 1: a left hand
  double length;       ///< from the wrist's centre to the tip of the middle finger [m]; 0: 0.18
  double breadth;      ///< at the knuckles [m]; 0: in proportion to the length
  phalanx_pose pose;   ///< X_WH; a rotation of zeros is the identity
  uint32_t triangles;  ///< approximate number, 800 .. 2,000,000; 0: 2,250
  uint32_t reserved;   ///< 0
} phalanx_hand;

/// Triangle mesh in memory of the library. Smallest size: all of it.
typedef struct phalanx_mesh {
  uint32_t struct_size;
  uint32_t reserved;
  uint64_t vertex_count;
  uint64_t triangle_count;
  const double* vertices;    ///< x, y, z of each vertex [m]; null without vertices
  const int32_t* triangles;  ///< three indices of each triangle, counter-clockwise seen from outside
} phalanx_mesh;

/// Meshes of a model.
enum {
  PHALANX_MESH_SEGMENT = 0,  ///< of a segment, in the segment's frame S: those of the contact search
  PHALANX_MESH_DISPLAY = 1,  ///< of a segment, in S: those to draw. Often the same
  PHALANX_MESH_OBJECTS = 2   ///< of all objects, in W; `segment` is not used
};

/// Numbers of a model's hand. Smallest size: all of it.
typedef struct phalanx_model_info {
  uint32_t struct_size;
  uint32_t left;            ///< 1: a left hand
  uint64_t hand_triangles;  ///< of the contact search
  uint64_t object_triangles;
  double min_angle[PHALANX_JOINTS];   ///< range of motion [rad]
  double max_angle[PHALANX_JOINTS];   ///< [rad]
  double open_angle[PHALANX_JOINTS];  ///< open hand, where the shown hand starts [rad]
  phalanx_pose palm;                  ///< X_WS of the palm, which does not move
} phalanx_model_info;

/// Hand and objects with their search trees. It is constant: any number of threads and states may use one.
typedef struct phalanx_model phalanx_model;

/// Makes the model of a scene. It reads the files that the scene names. Where the scene has its grasp
/// planned, it takes seconds, on all cores. For each mesh file of the hand or of an object it forks the
/// process, which costs a running loop some steps of 1 to 2 ms: make models before the loop starts. With
/// hand.meshes = "capsules", and no object of kind "file", it does not fork. Not real-time.
/// @returns PHALANX_ERROR_REFUSED for a file, mesh or size that cannot be used
PHALANX_API phalanx_result phalanx_model_create(const phalanx_scene* scene, phalanx_model** model);

/// Makes a model from arrays, without any file and without a fork. The arrays are copied. Not real-time.
/// @param hand            null: the default of each member
/// @param vertices        x, y, z of each vertex of the objects, in W [m]; may be null without vertices
/// @param triangles       three indices of each triangle, counter-clockwise seen from outside
/// @param triangle_count  0 with 0 vertices: a world without objects
/// @returns PHALANX_ERROR_REFUSED for a vertex that is not finite or farther than 10 km, an index without a
/// vertex, or a hand that cannot be made
PHALANX_API phalanx_result phalanx_model_create_from_mesh(const phalanx_hand* hand, const double* vertices,
                                                          size_t vertex_count, const int32_t* triangles,
                                                          size_t triangle_count, phalanx_model** model);

/// Reads the numbers of the hand. Real-time.
PHALANX_API phalanx_result phalanx_model_get_info(const phalanx_model* model, phalanx_model_info* info);

/// Gives access to a mesh. The memory is valid until the model is destroyed. Real-time.
/// @param kind     PHALANX_MESH_*
/// @param segment  0 .. 15
PHALANX_API phalanx_result phalanx_model_get_mesh(const phalanx_model* model, int32_t kind, int32_t segment,
                                                  phalanx_mesh* mesh);

/// Frees the model. States that were made of it remain usable; pointers to its meshes do not. Null has no
/// effect. Not real-time.
PHALANX_API phalanx_result phalanx_model_destroy(phalanx_model* model);

// ---- sample and motion

/// Origin of a joint's angle. Only measured angles may be scored.
enum {
  PHALANX_ORIGIN_UNKNOWN = 0,
  PHALANX_ORIGIN_MEASURED = 1,   ///< a sensor of this joint
  PHALANX_ORIGIN_COMPLETED = 2,  ///< computed from other sensors
  PHALANX_ORIGIN_FIXED = 3,      ///< constant
  PHALANX_ORIGIN_SCRIPTED = 4    ///< from a motion
};

/// Measurement at one tick. Smallest size: up to `angle` (176).
typedef struct phalanx_sample {
  uint32_t struct_size;
  /// 1: the optional channels below are used; 0: they count as not measured, and their origin as unknown
  uint32_t has_channels;
  double time_s;                 ///< strictly increasing [s]
  double angle[PHALANX_JOINTS];  ///< [rad]
  double measured_torque
      [PHALANX_JOINTS];  ///< [Nm]; NaN: no sensor. Copied to the snapshot, without effect on it
  double measured_force[PHALANX_DIGITS];  ///< at the digits' tips [N]; likewise
  uint8_t angle_origin[24];               ///< PHALANX_ORIGIN_* of the 20 angles; the last 4 are 0
} phalanx_sample;

/// Motion of the whole hand over time.
typedef struct phalanx_motion phalanx_motion;

/// Makes the motion of a scene: its file, or its script. As phalanx_model_create(), it may plan a grasp, and
/// then reads the same mesh files. Not real-time.
PHALANX_API phalanx_result phalanx_motion_create(const phalanx_scene* scene, phalanx_motion** motion);

/// Reads the length of a simulation of the scene [s]. Real-time.
PHALANX_API phalanx_result phalanx_motion_get_seconds(const phalanx_motion* motion, double* seconds);

/// Writes the sample at `time_s` [s], linear between the motion's keys, held before and after them.
/// Real-time.
PHALANX_API phalanx_result phalanx_motion_get_sample(const phalanx_motion* motion, double time_s,
                                                     phalanx_sample* sample);

/// Frees the motion. Null has no effect. Not real-time.
PHALANX_API phalanx_result phalanx_motion_destroy(phalanx_motion* motion);

// ---- step

/// State that one step leaves for the next, with its parameters.
typedef struct phalanx_state phalanx_state;

/// Makes a state at the open hand, without contact, at zero torque. Not real-time.
/// @param scene  with the parameters; null: the default of each
/// @returns PHALANX_ERROR_REFUSED if the open hand or the palm touches an object
PHALANX_API phalanx_result phalanx_state_create(const phalanx_model* model, const phalanx_scene* scene,
                                                phalanx_state** state);

/// Makes one tick of the whole hand. Whatever the sample holds, all torques are finite and within the
/// limits. Same model, parameters and samples, same bits, as phalanx::step() in C++. Real-time.
/// @param status  receives PHALANX_STATUS_* bits; may be null
PHALANX_API phalanx_result phalanx_step(phalanx_state* state, const phalanx_sample* sample, uint32_t* status);

/// Replaces a parameter by the key of a scene, with the rules of a running station. These keys take effect
/// from the next step on, over 0.2 s: force.stiffness_n_per_mm, force.damping_ns_per_m, smoothing.* and
/// stabiliser.method among none, smoothing and rise_only. All other keys need a new state. Any thread may
/// call it, also while another thread steps. Not real-time.
/// @param value  as phalanx_scene_set()
/// @returns PHALANX_ERROR_NOT_NOW for a key that needs a new state; PHALANX_ERROR_REFUSED for an unknown
/// key or a value out of range
PHALANX_API phalanx_result phalanx_state_set(phalanx_state* state, const char* key, const char* value);

/// Reads a parameter, as phalanx_scene_get(): the value last set, also while it is on its way. Any thread.
/// Not real-time.
PHALANX_API phalanx_result phalanx_state_get(phalanx_state* state, const char* key, char* text, size_t size,
                                             size_t* needed);

/// Reads the nominal rate of phalanx_step() [Hz]. Real-time.
PHALANX_API phalanx_result phalanx_state_get_rate(const phalanx_state* state, double* rate_hz);

/// Lets the next steps open a digit that started inside an object (docs/safety.md). For a caller who has
/// shown a person which digit it is, its way and where to, and got a confirmation. Real-time.
/// @returns PHALANX_ERROR_NOT_NOW, with no effect, unless the digit has no force for this reason and has a
/// contact
PHALANX_API phalanx_result phalanx_state_confirm_opening(phalanx_state* state, int32_t digit);

/// Takes all confirmations back: these digits have no force from the next step on. Real-time.
PHALANX_API phalanx_result phalanx_state_withdraw_openings(phalanx_state* state);

/// Frees the state; a recorder of it must be destroyed before. Null has no effect. Not real-time.
/// @returns PHALANX_ERROR_NOT_NOW while a recorder of it exists
PHALANX_API phalanx_result phalanx_state_destroy(phalanx_state* state);

// ---- snapshot

/// Contact of one segment; world frame W.
typedef struct phalanx_segment {
  uint32_t contact;      ///< 1: it has a contact
  uint32_t slips;        ///< 1, sliding mode: points with more than half of the normal force slip
  uint32_t oscillating;  ///< 1: `force` oscillates
  uint32_t reserved;
  double depth;        ///< [m] >= 0
  double force_raw;    ///< magnitude that the force law gives [N]
  double force;        ///< magnitude after caps and stabiliser [N]
  double point[3];     ///< contact point on the shown segment [m]
  double normal[3];    ///< direction of the force on the finger, unit; zeros without contact and force
  double slid;         ///< tangential offset of the contact [m]
  double friction[3];  ///< sliding mode: force along the surface on the finger [N]
  double spin;         ///< sliding mode: friction's moment about the normal [Nm]
  double slip_speed;   ///< sliding mode: of the point along the surface [m/s]
  double oscillation_frequency;  ///< [Hz]; 0 while not oscillating
  double oscillation_swing;      ///< last full swing, peak to peak [N]
} phalanx_segment;

/// Phase of a digit that started inside an object.
enum {
  PHALANX_OPENING_NONE = 0,         ///< it did not, or has been clear since
  PHALANX_OPENING_UNCONFIRMED = 1,  ///< it has no force
  PHALANX_OPENING_CONFIRMED = 2,    ///< a small force pushes it to where it is shown
  PHALANX_OPENING_NOT_FOLLOWED =
      3  ///< the finger did not follow; it has no force until it is confirmed again
};

/// A digit's way out of the object in which it started.
typedef struct phalanx_opening {
  uint32_t phase;  ///< PHALANX_OPENING_*
  uint32_t reserved;
  double way;    ///< greatest distance between the measured and the shown digit [m]
  double force;  ///< upper bound of the digit's forces [N]
} phalanx_opening;

/// Contact in a form that a device's own controller can evaluate between two steps, with stabiliser.method
/// = "local_wall":  f = clamp(stiffness (d_ref - g . (q - hcp_angle)), 0, force_max),  torque of joint i:
/// g_i f.
typedef struct phalanx_wall {
  uint32_t active;
  uint32_t reserved;
  double g[4];        ///< of the digit's joints [m]
  double d_ref;       ///< [m]
  double stiffness;   ///< [N/m]
  double force_max;   ///< [N]
  double host_force;  ///< contained in `torque` [N]
} phalanx_wall;

/// Result of the last step. Smallest size: up to `torque` (184).
typedef struct phalanx_snapshot {
  uint32_t struct_size;
  uint32_t status;                        ///< PHALANX_STATUS_* bits
  uint64_t tick;                          ///< number of steps so far
  double time_s;                          ///< of the last used sample [s]
  double torque[PHALANX_JOINTS];          ///< command, on the finger's joints, limited [Nm]
  double hcp_angle[PHALANX_JOINTS];       ///< measured [rad]
  double gdp_angle[PHALANX_JOINTS];       ///< shown [rad]
  double digit_force[PHALANX_DIGITS][3];  ///< vector sum of the digit's forces on the finger, in W [N]
  double fingertip[PHALANX_DIGITS][3];    ///< middle of each shown digit's pad, in W [m]
  phalanx_segment segment[PHALANX_SEGMENTS];
  phalanx_pose hcp_pose[PHALANX_SEGMENTS];  ///< X_WS, measured
  phalanx_pose gdp_pose[PHALANX_SEGMENTS];  ///< X_WS, shown
  phalanx_opening opening[PHALANX_DIGITS];
  double measured_torque[PHALANX_JOINTS];  ///< from the sample; NaN: not measured [Nm]
  double measured_force[PHALANX_DIGITS];   ///< from the sample; NaN: not measured [N]
  uint8_t angle_origin[24];                ///< PHALANX_ORIGIN_* of each hcp_angle
  double stiffness;                        ///< of the force law at this step [N/m]
  double stiffness_factor;                 ///< below 1 after the oscillation observer has halved the force
  double wall_valid_for;                   ///< validity of the walls from time_s on [s]; 0: no walls
  phalanx_wall wall[PHALANX_SEGMENTS];
  uint64_t contact_points;  ///< number for phalanx_state_get_contact_point(); 0 in static mode
} phalanx_snapshot;

/// Contact point that presses in sliding mode; world frame W. Smallest size: all of it.
typedef struct phalanx_contact_point {
  uint32_t struct_size;
  uint32_t segment;    ///< 0 .. 15
  double point[3];     ///< on the shown segment [m]
  double normal[3];    ///< from the object to the segment, unit
  double force;        ///< along the normal, on the finger [N]
  double friction[3];  ///< along the surface, on the finger [N]
  double spin;         ///< friction's moment about the normal [Nm]
  double coefficient;  ///< of friction [-]
  uint32_t slips;      ///< 1: friction is at its bound, and the point moves
  uint32_t reserved;
} phalanx_contact_point;

/// Reads the result of the last step. The thread that steps calls it. Real-time.
PHALANX_API phalanx_result phalanx_state_get_snapshot(const phalanx_state* state, phalanx_snapshot* snapshot);

/// Reads a contact point of the last step. The thread that steps calls it. Real-time.
/// @param index  0 .. phalanx_snapshot.contact_points - 1
PHALANX_API phalanx_result phalanx_state_get_contact_point(const phalanx_state* state, int32_t index,
                                                           phalanx_contact_point* point);

/// Writes the unit quaternion x, y, z, w of a pose's rotation, w >= 0. Real-time.
/// @returns PHALANX_ERROR_REFUSED if the rotation is not orthonormal to 1e-6
PHALANX_API phalanx_result phalanx_pose_get_quaternion(const phalanx_pose* pose, double quaternion[4]);

// ---- closed loop

/// Closed-loop trial of a scene with its simulated device and patient (docs/stability.md). Smallest size:
/// 32.
typedef struct phalanx_trial {
  uint32_t struct_size;
  uint32_t reserved;
  uint64_t seed;
  double stiffness;  ///< of the wall, > 0, <= 1e5 [N/m]; NaN: the scene's. 0 is refused
  double press;      ///< intended force of each digit, 0 .. 1000 [N]; NaN: the patient's
} phalanx_trial;

/// Result of a trial. Smallest size: all of it.
typedef struct phalanx_trial_result {
  uint32_t struct_size;
  uint32_t valid;   ///< 1: only the limiter that is studied acted, and a contact was made
  uint32_t stable;  ///< 1: no contact swings by more than the criterion allows
  uint32_t reserved;
  double force_swing;     ///< largest peak-to-peak force in the window [N]
  double position_swing;  ///< the same for the measured position along the normal [m]
  double peak_depth;      ///< deepest penetration of the run [m]
  double mean_force;      ///< of the pressing contact, in the window [N]
  double mean_depth;      ///< of the pressing contact, in the window [m]
  double ghost_s;         ///< time with a force after the finger has left [s]
  double ghost_energy;    ///< work of this force on the finger [J]
  char why_invalid[128];  ///< a few words; "" if valid
} phalanx_trial_result;

/// Runs one trial. Equal arguments give equal bits. It takes seconds, and reads mesh files as
/// phalanx_model_create(). Not real-time.
/// @returns PHALANX_ERROR_REFUSED if a number of `trial` is out of its range, no digit meets the object, or the
/// scene, its device or its patient cannot be used
PHALANX_API phalanx_result phalanx_trial_run(const phalanx_scene* scene, const phalanx_trial* trial,
                                             phalanx_trial_result* result);

// ---- recording

/// Writer of a recording: the MCAP file of docs/recording.md. `phalanx session` and `phalanx replay` read
/// it.
typedef struct phalanx_recorder phalanx_recorder;

/// Begins a recording of a state that has made no step. Not real-time.
/// @param path  of the file, which does not exist yet; it ends with .mcap
/// @returns PHALANX_ERROR_NOT_NOW if the state has made a step or has a recorder; PHALANX_ERROR_FAILED or
/// PHALANX_ERROR_REFUSED if the file cannot be made
PHALANX_API phalanx_result phalanx_recorder_create(phalanx_state* state, const char* path,
                                                   phalanx_recorder** recorder);

/// Adds the last step of the state. Call it after each phalanx_step(), on the same thread; the file states
/// which steps are missing otherwise. About every 0.2 s it waits for the disk. Not real-time.
/// @returns PHALANX_ERROR_NOT_NOW if there is no new step, or after phalanx_recorder_finish();
/// PHALANX_ERROR_FAILED if the disk refuses: the step is kept then, and written with the next one
PHALANX_API phalanx_result phalanx_recorder_add(phalanx_recorder* recorder);

/// Adds something that happened, at the time of the last step. Not real-time.
/// @param code  one word;  @param text  at most 4,000 bytes are kept
/// @returns PHALANX_ERROR_NOT_NOW after phalanx_recorder_finish()
PHALANX_API phalanx_result phalanx_recorder_event(phalanx_recorder* recorder, const char* code,
                                                  const char* text);

/// Writes the rest and the file's end. Nothing can be added afterwards. Not real-time.
/// @returns PHALANX_ERROR_FAILED if the disk refuses; it may be called again
PHALANX_API phalanx_result phalanx_recorder_finish(phalanx_recorder* recorder);

/// Frees the recorder. Without phalanx_recorder_finish() the file has no end; `phalanx session repair`
/// mends it. Null has no effect. Not real-time.
PHALANX_API phalanx_result phalanx_recorder_destroy(phalanx_recorder* recorder);

/// Content of a recording, of a program like this one or of `phalanx run`.
typedef struct phalanx_recording phalanx_recording;

/// What is in a recording. Smallest size: all of it.
typedef struct phalanx_recording_info {
  uint32_t struct_size;
  uint32_t exact;      ///< 1: compared to the last bit; 0: recorded on another processor, compared to 1e-9
  uint64_t steps;      ///< number for phalanx_recording_get_step()
  uint64_t compared;   ///< steps of the file that were made again and compared
  uint64_t different;  ///< of those compared
  uint64_t missing;    ///< steps that the file does not have
  double rate_hz;      ///< of the first station's loop
  char scene[256];     ///< name or file of the first station's scene
} phalanx_recording_info;

/// One step of a recording. Smallest size: all of it.
typedef struct phalanx_recorded_step {
  uint32_t struct_size;
  uint32_t status;   ///< PHALANX_STATUS_* bits
  uint64_t station;  ///< number of the station; 1 for a program like this one
  uint64_t tick;
  double time_s;                       ///< since the beginning of the recording [s]
  double torque[PHALANX_JOINTS];       ///< as sent to the device [Nm]
  double hcp_angle[PHALANX_JOINTS];    ///< measured [rad]
  double gdp_angle[PHALANX_JOINTS];    ///< shown [rad]
  double digit_force[PHALANX_DIGITS];  ///< sum of the magnitudes on each digit [N]
  double stiffness;                    ///< of the force law at this step [N/m]
} phalanx_recorded_step;

/// Reads a recording: every step is made again and compared with the file (docs/recording.md). Not
/// real-time.
/// @param from_s, to_s  range of the steps that are kept, since the beginning; to_s is exclusive, and
/// INFINITY means to the end [s]
/// @returns PHALANX_ERROR_FAILED if the file is not whole, is encrypted, or needs another version;
/// PHALANX_ERROR_REFUSED if from_s or to_s is NaN
PHALANX_API phalanx_result phalanx_recording_open(const char* path, double from_s, double to_s,
                                                  phalanx_recording** recording);

/// Reads what is in the recording. Real-time.
PHALANX_API phalanx_result phalanx_recording_get_info(const phalanx_recording* recording,
                                                      phalanx_recording_info* info);

/// Reads a step. Real-time.
/// @param index  0 .. phalanx_recording_info.steps - 1
PHALANX_API phalanx_result phalanx_recording_get_step(const phalanx_recording* recording, uint64_t index,
                                                      phalanx_recorded_step* step);

/// Frees the content. Null has no effect. Not real-time.
PHALANX_API phalanx_result phalanx_recording_destroy(phalanx_recording* recording);

#ifdef __cplusplus
}
#endif

#endif  // PHALANX_PHALANX_H
