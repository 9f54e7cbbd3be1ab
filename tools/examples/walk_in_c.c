/* A character on a skeleton of your own walks over waves, without a file. Prints its heel strikes.
 */
#include <gaitpad.h>
#include <math.h>
#include <stdio.h>

static double waves(const void* game, double x_m, double z_m) {
  (void)game;
  return 0.05 * sin(x_m) + 0.05 * cos(z_m);
}

int main(void) {
  static const gaitpad_bone bones[] = {
      /* standing: +x left, +y up, +z ahead */
      {"Hips", -1, 0, {0, 0, 0}},          {"LeftUpLeg", 0, 0, {0.1, 0, 0}},
      {"LeftLeg", 1, 0, {0, -0.44, 0}},    {"LeftFoot", 2, 0, {0, -0.4, 0}},
      {"LeftToe", 3, 0, {0, -0.07, 0.14}}, {"LeftTip", 4, 1, {0, 0, 0.06}},
      {"RightUpLeg", 0, 0, {-0.1, 0, 0}},  {"RightLeg", 6, 0, {0, -0.44, 0}},
      {"RightFoot", 7, 0, {0, -0.4, 0}},   {"RightToe", 8, 0, {0, -0.07, 0.14}},
      {"RightTip", 9, 1, {0, 0, 0.06}}};
  char error[256];
  gaitpad_model_options options;
  gaitpad_model_defaults(&options);
  options.bones = bones;
  options.bone_count = sizeof bones / sizeof *bones;
  options.root_height_m = 0.91;
  options.ground = waves;
  gaitpad_model* model = gaitpad_model_create(&options, error, sizeof error);
  const double start_m[3] = {0, 0, 0};
  gaitpad_walk* walk = model ? gaitpad_walk_create(model, start_m, 0.0, error, sizeof error) : NULL;
  if (!walk) return puts(error), 1;
  gaitpad_walk_set(walk, "left_leg.weight.knee", 0.3);

  gaitpad_event events[GAITPAD_MOST_EVENTS];
  for (int tick = 0; tick < 600; ++tick) { /* ten seconds */
    gaitpad_walk_step(walk, 0.1, 0.9, 1.0 / 60.0);
    const int count = gaitpad_walk_events(walk, events, GAITPAD_MOST_EVENTS);
    for (int i = 0; i < count; ++i)
      if (events[i].kind == GAITPAD_HEEL_STRIKE)
        printf("%.3f s: %s heel at %.2f %.2f %.2f m\n", (tick + 1) / 60.0,
               events[i].side == GAITPAD_LEFT ? "left" : "right", events[i].place_m[0],
               events[i].place_m[1], events[i].place_m[2]);
  }
  float matrices[16 * 11]; /* of all joints, to draw the character with */
  const int joints = gaitpad_pose_world(walk, matrices, 11);
  printf("%d joints, the last one at %.2f m\n", joints, matrices[16 * 10 + 14]);
  gaitpad_walk_destroy(walk);
  gaitpad_model_destroy(model);
  return 0;
}
