/* The walk for C, and for whatever calls C: Python's ctypes, Rust, C#. Link libgaitpad-c.

   - Handles are opaque. A model is read only and may be shared by threads; a walker belongs to one
     thread at a time. A model may be destroyed before its walkers.
   - A struct begins with `size`: set it to sizeof the struct. A program built with an older header
     works with a newer library: fields that it does not know count as 0, and are not written.
   - Functions that can fail return NULL or -1. Those that take `error` write one sentence to it, cut
     to its size; it may be NULL. No exception leaves the library.
   - Metres, seconds, radians. y is up; at heading 0 a walk goes along +z, and +x is to its left.
     Arrays of two are by side: 0 left, 1 right. Places are in the world. */
#ifndef GAITPAD_GAITPAD_H
#define GAITPAD_GAITPAD_H
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define GAITPAD_API __attribute__((visibility("default")))
#else
#define GAITPAD_API
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(modernize-use-using): C */
typedef struct gaitpad_model gaitpad_model;
typedef struct gaitpad_walker gaitpad_walker;

/* A joint of a skeleton that stands, its toes along +z. Parents come before children. */
typedef struct gaitpad_bone {
  const char* name;   /* "LeftUpLeg", "mixamorig:Hips": legs are found by name, else by shape */
  int32_t parent;     /* index of a bone before; bone 0: -1 */
  int32_t is_tip;     /* 1: the tip of a bone, which nothing turns; else 0 */
  double offset_m[3]; /* from the parent; of bone 0 from the ground under the stand */
} gaitpad_bone;

/* The height of a game's ground at a place, and its unit normal. Must not change while a walker
   asks, and must not call this library. `game` is the one of the model. */
typedef double (*gaitpad_ground)(const void* game, double x_m, double z_m, double normal[3]);

typedef struct gaitpad_model_def {
  uint32_t size;             /* sizeof(gaitpad_model_def) */
  uint32_t bone_count;       /* 0: the built-in adult */
  const gaitpad_bone* bones; /* read by gaitpad_model_create() alone */
  double scale;              /* of all bones, 0.05 .. 20; 0: 1 */
  gaitpad_ground ground;     /* NULL: level ground at height 0 */
  const void* game;          /* handed to `ground` */
} gaitpad_model_def;

/* Takes some tenths of a second. NULL: see `error`. */
GAITPAD_API gaitpad_model* gaitpad_model_create(const gaitpad_model_def* def, char* error,
                                                size_t error_size);
GAITPAD_API void gaitpad_model_destroy(gaitpad_model* model);
/* Joints are numbered as the walk has them; of own bones these are the same joints by name. */
GAITPAD_API int32_t gaitpad_model_joint_count(const gaitpad_model* model);
/* The name of a joint, which lives as long as the model; NULL if there is no such joint. */
GAITPAD_API const char* gaitpad_model_joint_name(const gaitpad_model* model, int32_t joint);
/* -1 if there is none. */
GAITPAD_API int32_t gaitpad_model_find_joint(const gaitpad_model* model, const char* name);

/* A character that stands at a place, on its ground, facing a heading. NULL: see `error`. */
GAITPAD_API gaitpad_walker* gaitpad_walker_create(const gaitpad_model* model,
                                                  const double place_m[3], double heading_rad,
                                                  char* error, size_t error_size);
GAITPAD_API void gaitpad_walker_destroy(gaitpad_walker* walker);

/* A value of the walker's style by its key, such as "hip_sway" or "left_leg.stride_length". -1, and
   nothing changes, if there is no such key or the value is out of its range. */
GAITPAD_API int gaitpad_walker_set_style(gaitpad_walker* walker, const char* key, double value);

/* Moves the walker on by one tick of 0.0001 .. 0.1 seconds, a constant of the run. The stick lies in
   the unit disc: x to the right turns, y forward walks. A stick or length that is not finite counts
   as the last one, and gaitpad_frame.bad_inputs counts it. Uses no heap. */
GAITPAD_API void gaitpad_walker_advance(gaitpad_walker* walker, double stick_x, double stick_y,
                                        double dt_s);
/* Turns the walk about the world's vertical through the origin, then shifts it. */
GAITPAD_API void gaitpad_walker_move(gaitpad_walker* walker, const double shift_m[3],
                                     double turn_rad);
/* Puts its hips over a place, facing a heading, in the middle of a step, too. */
GAITPAD_API void gaitpad_walker_put(gaitpad_walker* walker, const double place_m[3],
                                    double heading_rad);

enum { GAITPAD_IDLE = 0, GAITPAD_FLIGHT = 1, GAITPAD_ROLL = 2 };

/* What the last tick did. */
typedef struct gaitpad_frame {
  uint32_t size;          /* sizeof(gaitpad_frame), set by the caller */
  int32_t stage;          /* GAITPAD_IDLE, GAITPAD_FLIGHT, GAITPAD_ROLL */
  int32_t swing;          /* flight: the foot that flies; roll: that has just landed */
  int32_t bad_inputs;     /* numbers so far that were not taken */
  double heading_rad;     /* to the left positive; whole turns add up */
  double speed_m_s;       /* of the running cycle; 0 when idle */
  double root_m[3];       /* the hips' place on the ground */
  double root_moved_m[3]; /* what the tick added to it, in axes of the heading before */
  double root_turned_rad; /* and to the heading */
  double heel_m[2][3], toe_m[2][3];
  int32_t heel_planted[2], toe_planted[2]; /* 1 planted, else 0 */
  int32_t steps[2];                        /* landings so far */
  int32_t ik_failed[2];                    /* 1: the leg did not reach its goal in this tick */
} gaitpad_frame;
/* -1, and nothing is written, where `size` does not hold the first field. */
GAITPAD_API int gaitpad_walker_frame(const gaitpad_walker* walker, gaitpad_frame* frame);

enum { GAITPAD_STEP_BEGIN = 0, GAITPAD_TOE_OFF = 1, GAITPAD_HEEL_STRIKE = 2 };
enum { GAITPAD_MOST_EVENTS = 6 };

/* An event of the last tick. */
typedef struct gaitpad_event {
  int32_t kind;      /* GAITPAD_STEP_BEGIN, GAITPAD_TOE_OFF, GAITPAD_HEEL_STRIKE */
  int32_t side;      /* 0 left, 1 right */
  double place_m[3]; /* where the heel is or was planted; GAITPAD_TOE_OFF: the toe */
} gaitpad_event;
/* Writes at most `room` of them, in their order in time, and returns how many. */
GAITPAD_API int32_t gaitpad_walker_events(const gaitpad_walker* walker, gaitpad_event* events,
                                          int32_t room);

/* The pose of the last tick, by the caller's bones: bone i is joint `joints[i]`; nothing is written
   for -1. Seen from an object at `frame.root_m` that faces `frame.heading_rad`: x left, z ahead.
   Local rotations, 4 floats a bone: x, y, z, w. The root's place goes to `root_m`. */
GAITPAD_API void gaitpad_walker_rotations(const gaitpad_walker* walker, const int32_t* joints,
                                          int32_t bone_count, float* out, float root_m[3]);
/* Rotations and places, 16 floats a bone: a matrix, column by column. */
GAITPAD_API void gaitpad_walker_matrices(const gaitpad_walker* walker, const int32_t* joints,
                                         int32_t bone_count, float* out);

/* NOLINTEND(modernize-use-using) */
#ifdef __cplusplus
}
#endif
#endif
