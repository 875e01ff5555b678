#include "app/interact.h"

#include <math.h>
#include <string.h>

#include "app/camera.h"

static double length3(const float v[3]) {
  return sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
}

InteractStrength interact_strength(const SimContainer *container, const float gravity[3], float particle_radius) {
  InteractStrength strength = {0};
  float edges[3];
  for (int k = 0; k < 3; k++) {
    edges[k] = container->max[k] - container->min[k];
    strength.depth_of[k] = 0.5f * (container->min[k] + container->max[k]);
  }
  // Water lies in the lower part of its container.
  strength.depth_of[1] = container->min[1] + 0.25f * edges[1];
  double diagonal = length3(edges), g = length3(gravity);
  if (!(g > 1e-3)) g = 9.81;
  strength.radius = (float)fmax(diagonal / 8, 8.0 * particle_radius);
  strength.acceleration = (float)(4 * g);
  strength.speed = (float)(0.5 * sqrt(g * diagonal));
  return strength;
}

void interact_begin(Interact *hand, InteractMode mode, float x, float y) {
  *hand = (Interact){.mode = mode, .x = x, .y = y, .last_x = x, .last_y = y};
}

void interact_move(Interact *hand, float x, float y) {
  hand->x = x;
  hand->y = y;
}

void interact_end(Interact *hand) {
  hand->released = true;
}

// Metres that a pixel spans in the plane through the water.
static double metres_per_pixel(const InteractStrength *strength, const RenderView *view, int height) {
  float right[3], up[3], forward[3];
  camera_axes(view, right, up, forward);
  double depth = 0;
  for (int k = 0; k < 3; k++) depth += ((double)strength->depth_of[k] - view->eye[k]) * forward[k];
  // With the water behind the eye, or the eye in it, any depth is as good: take the reach of the hand.
  depth = fmax(depth, strength->radius);
  return 2 * depth * tan(view->vertical_fov * 3.14159265358979323846 / 360) / (height > 0 ? height : 1);
}

// Acceleration of a stroke along (x, y) metres in the picture's plane (y up). `fast` in [0, 1] is the stroke's share;
// the rest goes along the ray, away from the eye or, pulling, towards it, at half strength.
static void stroke(const InteractStrength *strength, const RenderView *view, InteractMode mode, double x, double y,
                   double fast, SimPush *push) {
  float right[3], up[3], forward[3];
  camera_axes(view, right, up, forward);
  double length = sqrt(x * x + y * y);
  if (!(length > 0)) length = 1;
  double along = (mode == INTERACT_PULL ? -0.5 : 0.5) * (1 - fast);
  for (int k = 0; k < 3; k++) {
    double in_plane = fast * (x * right[k] + y * up[k]) / length;
    push->acceleration[k] = (float)(strength->acceleration * (in_plane + along * push->direction[k]));
  }
}

int interact_take(Interact *hand, const InteractStrength *strength, const RenderView *view, int width, int height,
                  double seconds, SimPush pushes[INTERACT_MAX_PUSHES]) {
  double x = hand->x, y = hand->y, dx = x - hand->last_x, dy = y - hand->last_y;
  InteractMode mode = hand->mode;
  hand->last_x = hand->x;
  hand->last_y = hand->y;
  if (hand->released) *hand = (Interact){.mode = INTERACT_NONE};
  if (mode == INTERACT_NONE || !isfinite(dx) || !isfinite(dy) || !(seconds > 0)) return 0;

  // How fast is the hand, in metres per second?
  double metres = metres_per_pixel(strength, view, height);
  double way = metres * sqrt(dx * dx + dy * dy);
  double fast = fmin(way / seconds / strength->speed, 1);

  // Rays one reach apart cover the way: their fall-offs add up to about one on it.
  int count = (int)fmin(fmax(ceil(way / strength->radius), 1), INTERACT_MAX_PUSHES);
  for (int i = 0; i < count; i++) {
    double back = (double)i / count;
    SimPush *push = &pushes[i];
    *push = (SimPush){.radius = strength->radius};
    camera_ray(view, (float)(x - back * dx), (float)(y - back * dy), width, height, push->origin, push->direction);
    stroke(strength, view, mode, dx * metres, -dy * metres, fast, push);
  }
  return count;
}

void interact_lean_goal(const SimContainer *container, const float keys[2], const float dragged[2], int height,
                        float goal[2]) {
  float most = container->shape == SIM_CONTAINER_GLASS ? INTERACT_MAX_GLASS_LEAN : INTERACT_MAX_LEAN;
  double turn = 0.5 * 3.14159265358979323846 / (height > 0 ? height : 1);
  for (int k = 0; k < 2; k++) goal[k] = (float)(keys[k] * INTERACT_MAX_LEAN + turn * dragged[k]);
  float length = hypotf(goal[0], goal[1]);
  for (int k = 0; k < 2 && length > most; k++) goal[k] *= most / length;
}

bool interact_lean_step(InteractLean *lean, const float goal[2], double seconds) {
  float share = (float)(1 - exp(-seconds / 0.12));
  bool leaned = lean->leans;
  lean->leans = false;
  for (int k = 0; k < 2; k++) {
    lean->angle[k] += share * (goal[k] - lean->angle[k]);
    if (goal[k] == 0 && fabsf(lean->angle[k]) < 1e-3f) lean->angle[k] = 0;
    if (lean->angle[k] != 0) lean->leans = true;
  }
  return leaned || lean->leans;
}

void interact_lean(const float gravity[3], const RenderView *view, float right, float away, float leaned[3]) {
  float axes[3][3];
  camera_axes(view, axes[0], axes[1], axes[2]);
  // The level direction into the picture; up × right, so that it exists when looking straight down too.
  const float level[3] = {axes[0][2], 0, -axes[0][0]};
  double angle = sqrt((double)right * right + (double)away * away), strength = length3(gravity);
  memcpy(leaned, gravity, 3 * sizeof *leaned);
  if (!(angle > 0) || !(strength > 0)) return;
  double side = strength * sin(angle) / angle;
  for (int k = 0; k < 3; k++)
    leaned[k] = (float)(cos(angle) * gravity[k] + side * (right * axes[0][k] + away * level[k]));
}
