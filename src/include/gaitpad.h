/* gaitpad in C: walkers for programs in C, and for languages that call C (Python's ctypes, C#,
 * Rust, Lua). libgaitpad.so has these functions and nothing else; they wrap gaitpad::core
 * (gaitpad/walk.h).
 *
 * Units: metres, seconds, radians. World: y up, +z ahead at heading 0, +x to its left; headings
 * grow to the left. Rotations are unit quaternions in the order x, y, z, w. Matrices have 16
 * numbers, column by column. Arrays of two belong to the left and the right foot.
 *
 * The caller sets `size` of a struct to sizeof the struct before each call: a later version may add
 * members at the end, and fills or reads only those that the caller's version has. A call that
 * fails returns null or 0 and writes one sentence to `error`, cut to `error_size` bytes with the
 * final 0; `error` may be null. A null handle, or a null pointer where none is allowed, fails too;
 * a call that returns nothing then changes nothing. No C++ exception leaves a call. Several threads
 * may use walks of one model at a time; a walk belongs to one thread at a time. */
#ifndef GAITPAD_H
#define GAITPAD_H
/* NOLINTBEGIN(modernize-*): C */
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

/* Grows when functions or members are added. */
#define GAITPAD_API_VERSION 2
GAITPAD_API uint32_t gaitpad_api_version(void); /* of the library that runs */

/* ---- A model: a skeleton that can walk. It does not change once it is made. */

typedef struct gaitpad_model gaitpad_model;

/* A joint as it stands: upright, facing +z. Parents before children; joint 0 is the root. */
typedef struct gaitpad_bone {
  const char* name;   /* by which the legs are found: LeftUpLeg, thigh.L, r_hip ... */
  int32_t parent;     /* index of an earlier bone; -1: the root, which is the first */
  int32_t is_tip;     /* 1: the end of a bone, which nothing turns */
  double offset_m[3]; /* from the parent; finite */
} gaitpad_bone;

/* The height of the ground at a place of the world. gaitpad_walk_step() calls it on its thread. */
typedef double (*gaitpad_ground)(const void* game, double x_m, double z_m);

/* The caller fills it. */
typedef struct gaitpad_model_options {
  size_t size;
  const gaitpad_bone* bones; /* null: the built-in adult */
  int32_t bone_count;        /* 1 to 320 */
  double root_height_m;  /* of joint 0 above the floor, standing; finite; read only with bones */
  double scale;          /* of all bones, 0.05 to 20 */
  double leg_ratio;      /* of the legs, on top of scale, 0.05 to 20 */
  gaitpad_ground ground; /* null: level, at height 0 */
  const void* game;      /* handed to `ground` */
} gaitpad_model_options;
/* The built-in adult on level ground. Sets `size`. */
GAITPAD_API void gaitpad_model_defaults(gaitpad_model_options* options);

/* Takes about 0.2 s: the walk is solved for the skeleton. Null: `error` says why. */
GAITPAD_API gaitpad_model* gaitpad_model_create(const gaitpad_model_options* options, char* error,
                                                size_t error_size);
/* Null is allowed. Walks of the model may live on. */
GAITPAD_API void gaitpad_model_destroy(gaitpad_model* model);

/* Joints in the order of all poses. With own bones: their order. */
GAITPAD_API int32_t gaitpad_joint_count(const gaitpad_model* model);
GAITPAD_API const char* gaitpad_joint_name(const gaitpad_model* model,
                                           int32_t joint); /* null: there is none */
GAITPAD_API int32_t gaitpad_joint_parent(const gaitpad_model* model,
                                         int32_t joint); /* -1: the root, or none */

/* ---- A walk: one character. */

typedef struct gaitpad_walk gaitpad_walk;

/* It stands at the place, on the ground there; place_m[1] does not matter. Null: `error` says why.
 */
GAITPAD_API gaitpad_walk* gaitpad_walk_create(const gaitpad_model* model, const double place_m[3],
                                              double heading_rad, char* error, size_t error_size);
GAITPAD_API void gaitpad_walk_destroy(gaitpad_walk* walk); /* null is allowed */

/* A value of its style by its key: `hip_sway`, `left_leg.weight.knee`, `legs.stride_length`,
 * `spine.lean_deg`. 0: there is no such key, or the value is out of its bounds; nothing has
 * changed. */
GAITPAD_API int32_t gaitpad_walk_set(gaitpad_walk* walk, const char* key, double value);

/* Moves the walk on by dt_s, a constant of the run from 0.0001 to 0.1. The stick: right and
 * forward, -1 to 1, calibrated. No memory is taken and nothing is waited for. A number that is not
 * finite or out of range counts as the last good one (gaitpad_frame::bad_inputs). */
GAITPAD_API void gaitpad_walk_step(gaitpad_walk* walk, double stick_right, double stick_forward,
                                   double dt_s);

/* Turns the walk about the world's vertical through the origin, then shifts it. Planted feet move
 * along. A number beyond 1e6 or not finite moves nothing and is counted. */
GAITPAD_API void gaitpad_walk_move(gaitpad_walk* walk, const double shift_m[3], double turn_rad);
/* The same, so that the hips come to be over a place and face a heading. */
GAITPAD_API void gaitpad_walk_put(gaitpad_walk* walk, const double place_m[3], double heading_rad);

/* The caller fills it: the motion that an engine has given the character's capsule, in the world.
 */
typedef struct gaitpad_capsule {
  size_t size;
  double place_m[3];      /* of the hips on the ground; place_m[1] does not matter */
  double heading_rad;     /* that the character shall have when it stands */
  double velocity_m_s[3]; /* not faster than the walk can be */
  double turn_rate_rad_s; /* to the left positive */
} gaitpad_capsule;
/* In place of gaitpad_walk_step(): follows the capsule in its own steps. Feet stay planted, so the
 * walk is some centimetres off the capsule. If a number is not finite, the walk goes on as before
 * and counts it. 0: `size` is too small to be one of this struct's versions; nothing has moved. */
GAITPAD_API int32_t gaitpad_walk_follow(gaitpad_walk* walk, const gaitpad_capsule* capsule,
                                        double dt_s);

/* Asks the foot that flies, or that flies next, to land with its heel at a place of the world and
 * to point to a heading: a stepping stone. The next step is the stick's again. place_m[1] does not
 * matter. 0: the foot cannot reach it, or no step can be changed; nothing has changed. */
GAITPAD_API int32_t gaitpad_walk_step_to(gaitpad_walk* walk, const double place_m[3],
                                         double heading_rad);
/* Moves a place and a heading to the nearest ones that gaitpad_walk_step_to() takes now. 0: there
 * are none, or a number is not finite; both stay. */
GAITPAD_API int32_t gaitpad_walk_nearest_step(const gaitpad_walk* walk, double place_m[3],
                                              double* heading_rad);
/* Adds a velocity to that of the hips, at most 3 m/s; the running step or the next one catches the
 * fall. 0: the character stands or comes to rest, or a number is not finite or too large; nothing
 * has changed. */
GAITPAD_API int32_t gaitpad_walk_push(gaitpad_walk* walk, const double velocity_m_s[3]);

enum { GAITPAD_FULL = 0, GAITPAD_TABLES = 1 };
/* GAITPAD_TABLES: for a walk that is far away; it goes the same way in the same steps, and its legs
 * and upper body are the motion's. A change takes 0.25 s. 0: there is no such detail. */
GAITPAD_API int32_t gaitpad_walk_set_detail(gaitpad_walk* walk, int32_t detail);

/* ---- The last tick. */

enum { GAITPAD_STANDS = 0, GAITPAD_FLIGHT = 1, GAITPAD_ROLL = 2 };
enum { GAITPAD_LEFT = 0, GAITPAD_RIGHT = 1 };

/* gaitpad_walk_frame() fills it. */
typedef struct gaitpad_frame {
  size_t size;
  int32_t stage;      /* GAITPAD_STANDS: both feet are planted; GAITPAD_FLIGHT: `swing` flies;
                         GAITPAD_ROLL: it has landed */
  int32_t swing;      /* GAITPAD_LEFT or GAITPAD_RIGHT */
  double heading_rad; /* whole turns add up */
  double speed_m_s;   /* 0 when it stands */
  double root_m[3];   /* the hips' place on the ground, world */
  /* What the tick has added to it, in axes of the heading before (x left, z ahead), and to the
   * heading: root motion. */
  double root_moved_m[3];
  double root_turned_rad;
  double heel_m[2][3], toe_m[2][3];        /* world */
  int32_t heel_planted[2], toe_planted[2]; /* 0 or 1 */
  int32_t landings[2];                     /* so far */
  int32_t heel_struck[2], toe_off[2]; /* 1: in this very tick; toe_off: the foot left the ground */
  int32_t bad_inputs;                 /* numbers so far that were not taken */
} gaitpad_frame;
/* Fills the members that fit into frame->size. 0: `size` is too small to be one of this struct's
 * versions. */
GAITPAD_API int32_t gaitpad_walk_frame(const gaitpad_walk* walk, gaitpad_frame* frame);

/* GAITPAD_STEP_BEGINS: the other foot has landed or a stand ends, and this foot will fly next. */
enum { GAITPAD_STEP_BEGINS = 0, GAITPAD_TOE_OFF = 1, GAITPAD_HEEL_STRIKE = 2 };
typedef struct gaitpad_event {
  int32_t kind;      /* GAITPAD_STEP_BEGINS, GAITPAD_TOE_OFF or GAITPAD_HEEL_STRIKE */
  int32_t side;      /* GAITPAD_LEFT or GAITPAD_RIGHT */
  double place_m[3]; /* of the heel where it stands or stood; GAITPAD_TOE_OFF: of the toe. World */
} gaitpad_event;
/* A tick has at most six. */
enum { GAITPAD_MOST_EVENTS = 6 };
/* Writes the events of the last tick, in their order in time, at most `count` of them. Returns how
 * many were written. This struct does not grow. */
GAITPAD_API int32_t gaitpad_walk_events(const gaitpad_walk* walk, gaitpad_event* events,
                                        int32_t count);

/* Sets the pose that the functions below give until the next tick: at this share, 0 to 1, of the
 * way from the last tick but one to the last. A planted foot stays where it stands. For programs
 * that draw more often than their walks tick. Outside 0 to 1 it counts as 0 or 1. A walk that was
 * put elsewhere since then is there at all shares. 0: the share is not a number; nothing changes.
 */
GAITPAD_API int32_t gaitpad_walk_draw(gaitpad_walk* walk, double share);

/* The pose, for `count` joints from the first on (at most gaitpad_joint_count()). Both return how
 * many were written. Local rotations: of a joint's frame in its parent's; xyzw has 4 * count
 * numbers. root_m (3 numbers, may be null) is the place of joint 0 in the world. Matrices: from a
 * joint's frame to the world's; matrices has 16 * count numbers. */
GAITPAD_API int32_t gaitpad_pose_local(const gaitpad_walk* walk, float* xyzw, int32_t count,
                                       float* root_m);
GAITPAD_API int32_t gaitpad_pose_world(const gaitpad_walk* walk, float* matrices, int32_t count);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*) */
#endif
