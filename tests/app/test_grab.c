// The hand on a body: rays against shapes whose distances are known on paper, and against a slow twin; drags against where
// the cursor must find the body again.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "app/camera.h"
#include "app/grab.h"

enum { WIDTH = 800, HEIGHT = 400 };

// A unit cube around its origin.
static const float cube_vertex[] = {-0.5f, -0.5f, -0.5f, 0.5f, -0.5f, -0.5f, -0.5f, 0.5f, -0.5f, 0.5f, 0.5f, -0.5f,
                                    -0.5f, -0.5f, 0.5f,  0.5f, -0.5f, 0.5f,  -0.5f, 0.5f, 0.5f,  0.5f, 0.5f, 0.5f};
static const int32_t cube_triangle[] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
static const SimMesh cube = {8, 12, cube_vertex, cube_triangle};

static const SimObstacle shapes[] = {
    {.shape = SIM_BOX, .size = {1, 2, 3}},
    {.shape = SIM_SPHERE, .size = {1.5f}},
    {.shape = SIM_CYLINDER, .size = {1, 2}},
    {.shape = SIM_CAPSULE, .size = {1, 3}},
    {.shape = SIM_CAPSULE, .size = {1, 1}}, // a ball
    {.shape = SIM_STAIRS, .size = {3, 2, 1}, .steps = 4},
    {.shape = SIM_MESH, .mesh = &cube},
};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static void assert_meets(const SimObstacle *body, const float origin[3], const float direction[3], double want) {
  float distance;
  bool meets = grab_ray_meets(body, origin, direction, &distance);
  if (meets != isfinite(want)) fail_msg("shape %d: meets is %d", (int)body->shape, meets);
  if (meets && !(fabs(distance - want) < 1e-5))
    fail_msg("shape %d: got %g, want %g", (int)body->shape, (double)distance, want);
}

static void distances_are_those_on_paper(void **state) {
  (void)state;
  const struct {
    int shape;
    float origin[3], direction[3];
    double want;
  } rows[] = {
      {0, {0, 0, 5}, {0, 0, -1}, 3.5},
      {0, {0, 0, 5}, {0, 0, 1}, INFINITY},
      {0, {0.6f, 0, 5}, {0, 0, -1}, INFINITY},
      {0, {0, 0, 0}, {1, 0, 0}, 0},
      {0, {-3, 0, 0}, {0.6f, 0, 0.8f}, INFINITY},
      {1, {0, 0, 5}, {0, 0, -1}, 4.25},
      {1, {0, 0.45f, 5}, {0, 0, -1}, 4.4},
      {1, {0, 0.76f, 5}, {0, 0, -1}, INFINITY},
      {2, {5, 0, 0}, {-1, 0, 0}, 4.5},
      {2, {0.3f, 5, 0}, {0, -1, 0}, 4},
      {2, {0.6f, 5, 0}, {0, -1, 0}, INFINITY},
      {2, {5, 1.01f, 0}, {-1, 0, 0}, INFINITY},
      {3, {5, 0.9f, 0}, {-1, 0, 0}, 4.5},
      {3, {0, 5, 0}, {0, -1, 0}, 3.5},
      {3, {0.3f, 5, 0}, {0, -1, 0}, 3.6},
      {3, {5, 1.4f, 0}, {-1, 0, 0}, 4.7},
      {4, {0, 0, -5}, {0, 0, 1}, 4.5},
      // Steps of 0.75 m by 0.5 m: over the first the ray falls further.
      {5, {-1.4f, 5, 0}, {0, -1, 0}, 5.5},
      {5, {1.4f, 5, 0}, {0, -1, 0}, 4},
      {5, {-5, 0.75f, 0}, {1, 0, 0}, 5.75},
      {5, {-5, -0.75f, 0}, {1, 0, 0}, 3.5},
      {5, {5, 0.75f, 0}, {-1, 0, 0}, 3.5},
      {5, {0, 0.75f, 3}, {0, 0, -1}, INFINITY},
      {6, {0.1f, 0.2f, 5}, {0, 0, -1}, 4.5},
      {6, {5, 0.1f, 0.2f}, {-1, 0, 0}, 4.5},
      {6, {0.6f, 0, 5}, {0, 0, -1}, INFINITY},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    SimObstacle body = shapes[rows[i].shape];
    body.rotation[3] = 1;
    assert_meets(&body, rows[i].origin, rows[i].direction, rows[i].want);
    // Moved and turned by a quarter about z, with the ray: the same. x → y, y → −x.
    body.rotation[2] = body.rotation[3] = 0.70710678f;
    for (int k = 0; k < 3; k++) body.position[k] = 1.5f * (float)(k - 1);
    const float *o = rows[i].origin, *d = rows[i].direction;
    const float origin[3] = {-o[1] - 1.5f, o[0], o[2] + 1.5f}, direction[3] = {-d[1], d[0], d[2]};
    assert_meets(&body, origin, direction, rows[i].want);
  }
}

// ---- A slow twin: walk along the ray until a point is inside ------------------------------------------------------------

static bool inside(const SimObstacle *body, const double p[3]) {
  const float *size = body->size;
  double across = sqrt(p[0] * p[0] + p[2] * p[2]), reach, step;
  switch (body->shape) {
  case SIM_BOX:
    return fabs(p[0]) <= size[0] / 2 && fabs(p[1]) <= size[1] / 2 && fabs(p[2]) <= size[2] / 2;
  case SIM_SPHERE:
    return sqrt(across * across + p[1] * p[1]) <= size[0] / 2;
  case SIM_CYLINDER:
    return across <= size[0] / 2 && fabs(p[1]) <= size[1] / 2;
  case SIM_CAPSULE:
    reach = fmax(fabs(p[1]) - (size[1] - size[0]) / 2, 0);
    return sqrt(across * across + reach * reach) <= size[0] / 2;
  case SIM_STAIRS:
    step = floor((p[0] / size[0] + 0.5) * body->steps);
    return fabs(p[0]) < size[0] / 2 && fabs(p[2]) <= size[2] / 2 && p[1] >= -size[1] / 2 &&
           p[1] <= size[1] * ((step + 1) / body->steps - 0.5);
  default:
    return fabs(p[0]) <= 0.5 && fabs(p[1]) <= 0.5 && fabs(p[2]) <= 0.5;
  }
}

static double random_share(uint32_t *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return (*seed >> 8) / 16777216.0 * 2 - 1;
}

static void rays_agree_with_a_walk(void **state) {
  (void)state;
  uint32_t seed = 5;
  const double step = 2e-3;
  for (int s = 0; s < SHAPES; s++) {
    SimObstacle body = shapes[s];
    body.rotation[3] = 1;
    int hits = 0;
    for (int n = 0; n < 200; n++) {
      // From a ball around the body to a point near its middle.
      float origin[3], direction[3];
      double length = 0;
      for (int k = 0; k < 3; k++) origin[k] = (float)random_share(&seed);
      for (int k = 0; k < 3; k++) length += origin[k] * (double)origin[k];
      for (int k = 0; k < 3; k++) origin[k] *= (float)(4 / sqrt(length));
      length = 0;
      for (int k = 0; k < 3; k++) direction[k] = (float)(1.5 * random_share(&seed)) - origin[k];
      for (int k = 0; k < 3; k++) length += direction[k] * (double)direction[k];
      for (int k = 0; k < 3; k++) direction[k] /= (float)sqrt(length);
      float distance;
      bool meets = grab_ray_meets(&body, origin, direction, &distance);
      double t = 0, p[3];
      for (bool in = false; !in && t < 8; t += step) {
        for (int k = 0; k < 3; k++) p[k] = origin[k] + t * direction[k];
        in = inside(&body, p);
        if (in && !meets) fail_msg("shape %d: the walk finds it at %g, the ray does not", s, t);
        if (in && !(distance <= t + 1e-5 && distance >= t - step - 1e-5))
          fail_msg("shape %d: the ray says %g, the walk %g", s, (double)distance, t);
        if (in) hits++;
      }
    }
    assert_in_range(hits, 20, 200);
  }
}

static void rays_that_meet_end_on_the_surface(void **state) {
  (void)state;
  uint32_t seed = 11;
  for (int s = 0; s < SHAPES; s++) {
    SimObstacle body = shapes[s];
    body.rotation[3] = 1;
    for (int n = 0; n < 2000; n++) {
      float origin[3] = {0, 0, 6},
            direction[3] = {(float)(0.4 * random_share(&seed)), (float)(0.4 * random_share(&seed)), -1};
      float length = sqrtf(direction[0] * direction[0] + direction[1] * direction[1] + 1), distance;
      for (int k = 0; k < 3; k++) direction[k] /= length;
      if (!grab_ray_meets(&body, origin, direction, &distance)) continue;
      // Shrunk towards the ray's end by a little more than rounding, the point lies inside; before it, outside.
      double p[3], before[3];
      for (int k = 0; k < 3; k++) p[k] = (origin[k] + distance * (double)direction[k]) * (1 - 1e-5);
      for (int k = 0; k < 3; k++) before[k] = origin[k] + (distance - 1e-3) * (double)direction[k];
      if (body.shape != SIM_STAIRS) assert_true(inside(&body, p));
      assert_false(inside(&body, before));
    }
  }
}

// ---- Picking and dragging -------------------------------------------------------------------------------------------------

static RenderView front_view(void) {
  return (RenderView){.eye = {0, 0, 10}, .target = {0, 0, 0}, .vertical_fov = 38};
}

// Three balls in a row along the view, the middle one draggable.
typedef struct Row {
  SimObstacle bodies[3];
  SimObstacleDef defs[3];
} Row;

static GrabBodies make_row(Row *row) {
  for (int i = 0; i < 3; i++) {
    row->bodies[i] = (SimObstacle){
        .shape = SIM_SPHERE, .size = {1}, .position = {0, 0, 2.0f * (float)(i - 1)}, .rotation = {0, 0, 0, 1}};
    row->defs[i] = sim_default_obstacle_def();
  }
  row->defs[1].motion = SIM_DRAGGABLE;
  return (GrabBodies){3, row->bodies, row->defs};
}

static void the_nearest_body_is_picked_if_it_can_be_dragged(void **state) {
  (void)state;
  Row row;
  GrabBodies bodies = make_row(&row);
  const float eye[3] = {0, 0, 10}, along[3] = {0, 0, -1}, away[3] = {0, 0, 1};
  assert_int_equal(grab_pick(&bodies, eye, along), -1); // hidden behind one that stands
  row.bodies[2].position[0] = 3;
  assert_int_equal(grab_pick(&bodies, eye, along), 1);
  assert_int_equal(grab_pick(&bodies, eye, away), -1);
  row.defs[1].motion = SIM_FLOATING;
  row.defs[0].motion = SIM_DRAGGABLE;
  assert_int_equal(grab_pick(&bodies, eye, along), -1);
  assert_int_equal(grab_pick(&(GrabBodies){0}, eye, along), -1);
}

static void the_body_stays_under_the_cursor(void **state) {
  (void)state;
  Row row;
  GrabBodies bodies = make_row(&row);
  row.bodies[2].position[0] = 9;
  RenderView view = {.eye = {4, 3, 8}, .target = {0.1f, 0, 0.2f}, .vertical_fov = 38};
  float x, y, at_x, at_y, right[3], up[3], forward[3];
  assert_true(camera_project(&view, row.bodies[1].position, WIDTH, HEIGHT, &x, &y));
  Grab grab = {0};
  assert_false(grab_begin(&grab, &bodies, &view, 5, 5, WIDTH, HEIGHT));
  assert_false(grab.holds || grab.moved);
  // Grasped beside its middle: the middle moves as far as the cursor.
  assert_true(grab_begin(&grab, &bodies, &view, x + 4, y - 3, WIDTH, HEIGHT));
  assert_int_equal(grab.body, 1);
  const float way[][2] = {{50, 0}, {-120, 60}, {10, -90}, {0, 0}};
  for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
    grab_move(&grab, &view, x + 4 + way[i][0], y - 3 + way[i][1], WIDTH, HEIGHT);
    assert_true(camera_project(&view, grab.target, WIDTH, HEIGHT, &at_x, &at_y));
    assert_true(fabsf(at_x - x - way[i][0]) < 0.05f && fabsf(at_y - y - way[i][1]) < 0.05f);
    // In the plane across the view.
    camera_axes(&view, right, up, forward);
    double depth = 0;
    for (int k = 0; k < 3; k++) depth += ((double)grab.target[k] - row.bodies[1].position[k]) * forward[k];
    assert_true(fabs(depth) < 1e-5);
  }
  grab_end(&grab);
  assert_true(grab.moved && !grab.holds);
  float target[3];
  memcpy(target, grab.target, sizeof target);
  grab_move(&grab, &view, 0, 0, WIDTH, HEIGHT);
  assert_memory_equal(target, grab.target, sizeof target);
}

static void nonsense_moves_nothing(void **state) {
  (void)state;
  Row row;
  GrabBodies bodies = make_row(&row);
  row.bodies[2].position[0] = 9;
  RenderView view = front_view();
  Grab grab = {0};
  assert_true(grab_begin(&grab, &bodies, &view, WIDTH / 2.0f, HEIGHT / 2.0f, WIDTH, HEIGHT));
  grab_move(&grab, &view, 10, 10, 0, 0); // minimised
  assert_true(grab.target[0] == 0 && grab.target[1] == 0 && grab.target[2] == 0);
  view.eye[2] = -5; // the body is behind the eye now
  view.target[2] = -9;
  grab_move(&grab, &view, 700, 10, WIDTH, HEIGHT);
  assert_true(grab.target[0] == 0 && grab.target[1] == 0 && grab.target[2] == 0);
}

static void a_glass_is_met_from_outside(void **state) {
  (void)state;
  // Wider along x: the glass is as wide as the shorter side, 2 m, around (3, 2, 0).
  SimContainer glass = {{0, 1, -1}, {6, 3, 1}, SIM_CONTAINER_GLASS};
  const struct {
    float origin[3], direction[3];
    bool meets;
  } rows[] = {
      {{3, 2, 9}, {0, 0, -1}, true},        {{3.9f, 2, 9}, {0, 0, -1}, true}, {{4.1f, 2, 9}, {0, 0, -1}, false},
      {{3.9f, 9, 0.9f}, {0, -1, 0}, false}, {{3, 9, 0}, {0, -1, 0}, true},    {{3, 3.1f, 9}, {0, 0, -1}, false},
      {{3, 2, 9}, {0, 0, 1}, false},        {{3, 2, 0}, {0, 0, -1}, false}, // behind the eye; around it
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    glass.shape = SIM_CONTAINER_GLASS;
    if (grab_meets_glass(&glass, rows[i].origin, rows[i].direction) != rows[i].meets) fail_msg("row %zu", i);
    glass.shape = SIM_CONTAINER_BOX;
    assert_false(grab_meets_glass(&glass, rows[i].origin, rows[i].direction));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distances_are_those_on_paper),
      cmocka_unit_test(rays_agree_with_a_walk),
      cmocka_unit_test(rays_that_meet_end_on_the_surface),
      cmocka_unit_test(the_nearest_body_is_picked_if_it_can_be_dragged),
      cmocka_unit_test(the_body_stays_under_the_cursor),
      cmocka_unit_test(nonsense_moves_nothing),
      cmocka_unit_test(a_glass_is_met_from_outside),
  };
  return cmocka_run_group_tests_name("app_grab", tests, NULL, NULL);
}
