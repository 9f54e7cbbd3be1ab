/* A character of own bones on a ground of waves, in C. Prints where each heel lands and how far
   planted toes slide. Build: cc walk_in_c.c -lgaitpad-c -lm */
#include <gaitpad/gaitpad.h>
#include <math.h>
#include <stdio.h>

static const gaitpad_bone bones[] =
    {/* name, parent, whether a tip, offset: x left, y up, z ahead */
     {"Hips", -1, 0, {0.0, 0.84, 0.0}},      {"LeftUpLeg", 0, 0, {0.1, 0.0, 0.0}},
     {"LeftLeg", 1, 0, {0.0, -0.40, 0.0}},   {"LeftFoot", 2, 0, {0.0, -0.37, 0.0}},
     {"LeftToe", 3, 0, {0.0, -0.07, 0.14}},  {"LeftTip", 4, 1, {0.0, 0.0, 0.06}},
     {"RightUpLeg", 0, 0, {-0.1, 0.0, 0.0}}, {"RightLeg", 6, 0, {0.0, -0.40, 0.0}},
     {"RightFoot", 7, 0, {0.0, -0.37, 0.0}}, {"RightToe", 8, 0, {0.0, -0.07, 0.14}},
     {"RightTip", 9, 1, {0.0, 0.0, 0.06}}};

static double ground(const void* game, double x_m, double z_m, double normal[3]) {
  const double slope = 0.04 * cos(0.4 * x_m), length = sqrt(1.0 + slope * slope);
  (void)game, (void)z_m;
  normal[0] = -slope / length, normal[1] = 1.0 / length, normal[2] = 0.0;
  return 0.1 * sin(0.4 * x_m);
}

int main(void) {
  const double start_m[3] = {0.0, 0.0, 0.0};
  char error[200];
  gaitpad_model_def def = {0};
  def.size = sizeof def;
  def.bones = bones;
  def.bone_count = sizeof bones / sizeof *bones;
  def.ground = ground;
  gaitpad_model* model = gaitpad_model_create(&def, error, sizeof error);
  gaitpad_walker* walker =
      model ? gaitpad_walker_create(model, start_m, 0.0, error, sizeof error) : NULL;
  if (!walker) return fprintf(stderr, "%s\n", error), 1;
  const int32_t joints[] = {gaitpad_model_find_joint(model, "LeftFoot"), 0};
  float matrices[2][16];
  gaitpad_frame frame = {0}, before = {0};
  double slide_m = 0.0;
  frame.size = before.size = sizeof frame;
  for (int tick = 0; tick < 600; ++tick) {
    gaitpad_walker_frame(walker, &before);
    gaitpad_walker_advance(walker, 0.3, 0.8, 1.0 / 60.0);
    gaitpad_walker_frame(walker, &frame);
    gaitpad_event events[GAITPAD_MOST_EVENTS];
    const int32_t count = gaitpad_walker_events(walker, events, GAITPAD_MOST_EVENTS);
    for (int32_t i = 0; i < count; ++i)
      if (events[i].kind == GAITPAD_HEEL_STRIKE)
        printf("%s heel lands at %.3f %.3f %.3f\n", events[i].side ? "right" : "left",
               events[i].place_m[0], events[i].place_m[1], events[i].place_m[2]);
    for (int side = 0; side < 2; ++side)
      if (before.toe_planted[side] && frame.toe_planted[side])
        slide_m = fmax(slide_m, hypot(frame.toe_m[side][0] - before.toe_m[side][0],
                                      frame.toe_m[side][2] - before.toe_m[side][2]));
  }
  gaitpad_walker_matrices(walker, joints, 2, &matrices[0][0]);
  printf("toes slide %.4f mm, the left ankle is %.3f m up from the ground of the hips\n",
         1e3 * slide_m, (double)matrices[0][13]);
  gaitpad_walker_destroy(walker);
  gaitpad_model_destroy(model);
  return 0;
}
