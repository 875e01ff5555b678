// Capsules, stairs and meshes against slow ray casters in double precision that share no formula with the shaders: where
// they are, which way their surface looks, and what shadow they throw on the floor and on themselves.
#include "tests/render/harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 200
#define HEIGHT 120

// ---- The slow twin ---------------------------------------------------------------------------------------------------

// The first point of a ray on a body; in the body's axes, or in the world's.
typedef struct Hit {
  bool hit;
  double t, normal[3];
} Hit;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void at(double p[3], const Ray *ray, double t) {
  for (int k = 0; k < 3; ++k) p[k] = ray->origin[k] + t * ray->direction[k];
}

// Keep the nearer of *hit and the entry into a box.
static void meet_box(Hit *hit, const Ray *ray, const double low[3], const double high[3]) {
  double enter = 0, leave = 1e30;
  int through = -1;
  for (int k = 0; k < 3; ++k) {
    const double d = ray->direction[k], a = (low[k] - ray->origin[k]) / d, b = (high[k] - ray->origin[k]) / d;
    if (d == 0 && (ray->origin[k] < low[k] || ray->origin[k] > high[k])) return;
    if (d == 0) continue;
    if (fmin(a, b) > enter) {
      enter = fmin(a, b);
      through = k;
    }
    leave = fmin(leave, fmax(a, b));
  }
  if (through < 0 || enter > leave || (hit->hit && hit->t <= enter)) return;
  *hit = (Hit){true, enter, {0, 0, 0}};
  hit->normal[through] = ray->direction[through] > 0 ? -1 : 1;
}

// A flight is the union of one box for each step.
static Hit cast_stairs(const SimObstacle *o, const Ray *ray) {
  Hit hit = {0};
  const double half[3] = {(double)o->size[0] / 2, (double)o->size[1] / 2, (double)o->size[2] / 2};
  for (int32_t k = 0; k < o->steps; ++k) {
    const double low[3] = {-half[0] + (double)o->size[0] * k / o->steps, -half[1], -half[2]};
    const double high[3] = {half[0], -half[1] + (double)o->size[1] * (k + 1) / o->steps, half[2]};
    meet_box(&hit, ray, low, high);
  }
  return hit;
}

// A capsule is what lies within a radius of a line: step on by the distance to it.
static Hit cast_capsule(const SimObstacle *o, const Ray *ray) {
  const double radius = (double)o->size[0] / 2, half = fmax((double)o->size[1] / 2 - radius, 0);
  const double speed = sqrt(dot(ray->direction, ray->direction));
  double t = 0;
  for (int i = 0; i < 2000 && t < 20; ++i) {
    double p[3];
    at(p, ray, t);
    p[1] -= fmin(fmax(p[1], -half), half);
    const double length = sqrt(dot(p, p));
    if (length < radius + 1e-8) return (Hit){true, t, {p[0] / length, p[1] / length, p[2] / length}};
    t += (length - radius) / speed;
  }
  return (Hit){0};
}

// Every triangle: the volumes that the ray spans with its edges have one sign.
static Hit cast_mesh(const SimObstacle *o, const Ray *ray) {
  Hit hit = {0};
  for (int32_t i = 0; i < o->mesh->triangle_count; ++i) {
    double v[3][3], n[3], sign[3];
    for (int c = 0; c < 3; ++c) {
      const float *vertex = o->mesh->vertex + 3 * (size_t)o->mesh->triangle[3 * i + c];
      for (int k = 0; k < 3; ++k) v[c][k] = (double)vertex[k] - ray->origin[k];
    }
    for (int c = 0; c < 3; ++c) {
      const double *a = v[c], *b = v[(c + 1) % 3], *d = ray->direction;
      sign[c] =
          d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) + d[2] * (a[0] * b[1] - a[1] * b[0]);
    }
    if (!(sign[0] < 0 && sign[1] < 0 && sign[2] < 0)) continue; // past it, or from behind
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      n[k] = (v[1][a] - v[0][a]) * (v[2][b] - v[0][b]) - (v[1][b] - v[0][b]) * (v[2][a] - v[0][a]);
    }
    const double t = dot(v[0], n) / dot(ray->direction, n), length = sqrt(dot(n, n));
    if (t <= 0 || (hit.hit && t >= hit.t)) continue;
    hit = (Hit){true, t, {n[0] / length, n[1] / length, n[2] / length}};
  }
  return hit;
}

static Hit cast_ray(const SimObstacle *o, const Ray *ray) {
  Ray own = *ray;
  for (int k = 0; k < 3; ++k) own.origin[k] -= (double)o->position[k];
  harness_to_body(own.origin, o->rotation);
  harness_to_body(own.direction, o->rotation);
  Hit hit = o->shape == SIM_STAIRS    ? cast_stairs(o, &own)
            : o->shape == SIM_CAPSULE ? cast_capsule(o, &own)
                                      : cast_mesh(o, &own);
  harness_from_body(hit.normal, o->rotation);
  return hit;
}

// The body at a pixel; false where a tenth of a pixel more or less shows something else, so that rounding decides.
static bool cast_pixel(const SimObstacle *o, const RenderView *view, int32_t x, int32_t y, Hit *hit) {
  const Ray middle = harness_ray(view, WIDTH, HEIGHT, x, y);
  const Ray right = harness_ray(view, WIDTH, HEIGHT, x + 1, y), below = harness_ray(view, WIDTH, HEIGHT, x, y + 1);
  *hit = cast_ray(o, &middle);
  for (int i = 0; i < 4; ++i) {
    const double share = i & 1 ? 0.1 : -0.1;
    Ray beside = middle;
    for (int k = 0; k < 3; ++k) {
      beside.direction[k] += share * ((i & 2 ? right : below).direction[k] - middle.direction[k]);
    }
    const Hit other = cast_ray(o, &beside);
    if (other.hit != hit->hit) return false;
    if (hit->hit && (fabs(other.t - hit->t) > 0.02 || dot(other.normal, hit->normal) < 0.98)) return false;
  }
  return true;
}

// ---- The bodies ------------------------------------------------------------------------------------------------------

static SimFrame frame_with(const SimObstacle *obstacle) {
  return (SimFrame){.particle_radius = 0.0175f, .obstacle_count = 1, .obstacles = obstacle};
}

static const RenderView front = {{-0.9f, 1.6f, 3}, {0, 0.5f, 0}, 35};

#define TURN_NONE                                                                                                      \
  { 0, 0, 0, 1 }
#define TURN_TILTED                                                                                                    \
  { 0.2f, 0.3f, 0.1f, 0.9273618f }
#define GREY                                                                                                           \
  { 0.6f, 0.7f, 0.8f }

static const SimObstacle stairs_level = {SIM_STAIRS, {1.2f, 0.9f, 0.7f}, {0, 0.45f, 0}, TURN_NONE, GREY, 5, NULL};
static const SimObstacle stairs_tilted = {SIM_STAIRS, {1.1f, 0.5f, 0.8f}, {0.1f, 0.6f, 0}, TURN_TILTED, GREY, 3, NULL};
static const SimObstacle stairs_one = {SIM_STAIRS, {0.8f, 0.5f, 0.6f}, {0, 0.5f, 0}, TURN_TILTED, GREY, 1, NULL};
static const SimObstacle stairs_back = {
    SIM_STAIRS, {1.2f, 0.9f, 0.7f}, {0, 0.45f, 0}, {0, 0.9238795f, 0, 0.3826834f}, GREY, 8, NULL};
static const SimObstacle capsule_tilted = {
    SIM_CAPSULE, {0.4f, 1.2f, 0}, {0.1f, 0.6f, 0}, {0.4f, 0.1f, 0.2f, 0.8888194f}, GREY, 0, NULL};
static const SimObstacle capsule_upright = {SIM_CAPSULE, {0.5f, 1, 0}, {0, 0.5f, 0}, TURN_NONE, GREY, 0, NULL};
static const SimObstacle capsule_ball = {SIM_CAPSULE, {0.8f, 0.8f, 0}, {0, 0.5f, 0}, TURN_TILTED, GREY, 0, NULL};

// A box as eight shared vertices, the corner of which towards +x +y +z is pushed in: flat faces and a hollow.
static SimMesh *dented_box(void) {
  static const int32_t faces[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                       {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  SimMesh *mesh = test_mesh_create(8, 12);
  float *vertex = (float *)(uintptr_t)mesh->vertex;
  memcpy((int32_t *)(uintptr_t)mesh->triangle, faces, sizeof faces);
  for (int i = 0; i < 8; ++i) {
    const float scale = i == 7 ? 0 : 0.4f;
    for (int k = 0; k < 3; ++k) vertex[3 * i + k] = i >> k & 1 ? scale : -0.4f;
  }
  return mesh;
}

// ---- Depth and normals -----------------------------------------------------------------------------------------------

static void check_depth(const SimObstacle *obstacle) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const SimFrame frame = frame_with(obstacle);
  float *depth = harness_layer(&harness, "background_depth", 1, &frame, &front, &settings);
  int covered = 0, left_out = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      Hit hit;
      if (!cast_pixel(obstacle, &front, x, y, &hit)) {
        ++left_out;
        continue;
      }
      const double truth = hit.hit ? hit.t : 0;
      covered += hit.hit;
      if (fabs((double)depth[y * WIDTH + x] - truth) > 5e-5) {
        fail_msg("pixel %d, %d: depth %.7g, should be %.7g", x, y, (double)depth[y * WIDTH + x], truth);
      }
    }
  }
  assert_true(covered > 600);
  assert_true(left_out < 1500);
  free(depth);
  harness_close(&harness);
}

// What the renderer makes of a matt surface in sunlight under the gradient sky.
static int expected_byte(const SimObstacle *o, const RenderSettings *s, const double n[3], int channel) {
  double sun[3] = {(double)s->sun_direction[0], (double)s->sun_direction[1], (double)s->sun_direction[2]};
  const double length = sqrt(dot(sun, sun));
  const double facing = fmax(dot(n, sun) / length, 0), up = 0.25 + 0.25 * n[1];
  const double sky = (double)s->sky_horizon[channel] * (1 - up) + (double)s->sky_zenith[channel] * up;
  const double light = sky + (double)s->sun_colour[channel] * facing / 3.14159265358979;
  return (int)floor(255 * fmin((double)o->colour[channel] * light, 1) + 0.5);
}

static RenderSettings sunny_settings(float x, float y, float z) {
  RenderSettings settings = harness_pinned_settings();
  const float direction[3] = {x, y, z}, colour[3] = {1.5f, 1.4f, 1.3f};
  settings.sun = true;
  memcpy(settings.sun_direction, direction, sizeof direction);
  memcpy(settings.sun_colour, colour, sizeof colour);
  settings.floor = RENDER_FLOOR_NONE;
  return settings;
}

// The normal on a ring of triangles that pretends to be round.
static void ring_normal(const SimObstacle *o, const Ray *ray, double radius, Hit *hit) {
  double p[3];
  at(p, ray, hit->t);
  for (int k = 0; k < 3; ++k) p[k] -= (double)o->position[k];
  harness_to_body(p, o->rotation);
  const double from_axis = hypot(p[0], p[2]);
  p[0] -= radius * p[0] / from_axis;
  p[2] -= radius * p[2] / from_axis;
  const double length = sqrt(dot(p, p));
  for (int k = 0; k < 3; ++k) hit->normal[k] = p[k] / length;
  harness_from_body(hit->normal, o->rotation);
}

// Under suns from three sides every component of the normal shows. `ring_radius`: 0, or of a ring that is smooth.
static void check_normals(const SimObstacle *obstacle, double ring_radius, int tolerance) {
  static const float suns[3][3] = {{-1, 0.2f, 0.3f}, {0.3f, 1, 0.2f}, {0.1f, 0.3f, 1}};
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const SimFrame frame = frame_with(obstacle);
  for (int s = 0; s < 3; ++s) {
    const RenderSettings settings = sunny_settings(suns[s][0], suns[s][1], suns[s][2]);
    uint8_t *rgb = harness_draw(&harness, &frame, &front, &settings);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i += 3) {
      Hit hit;
      if (!cast_pixel(obstacle, &front, i % WIDTH, i / WIDTH, &hit) || !hit.hit) continue;
      const Ray ray = harness_ray(&front, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
      if (ring_radius > 0) ring_normal(obstacle, &ray, ring_radius, &hit);
      for (int k = 0; k < 3; ++k) {
        const int want = expected_byte(obstacle, &settings, hit.normal, k);
        if (abs(rgb[3 * i + k] - want) > tolerance) {
          fail_msg("sun %d, pixel %d, %d: %d, should be %d", s, i % WIDTH, i / WIDTH, rgb[3 * i + k], want);
        }
      }
    }
    free(rgb);
  }
  harness_close(&harness);
}

static void test_stairs(void **state) {
  (void)state;
  const SimObstacle *const flights[] = {&stairs_level, &stairs_tilted, &stairs_one, &stairs_back};
  for (int i = 0; i < 4; ++i) {
    check_depth(flights[i]);
    check_normals(flights[i], 0, 1);
  }
}

// A thousand steps, each smaller than a pixel: no ray may fall through a crack between tread and riser.
static void test_a_thousand_steps(void **state) {
  (void)state;
  SimObstacle flight = stairs_tilted;
  flight.steps = 1000;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const SimFrame frame = frame_with(&flight);
  float *depth = harness_layer(&harness, "background_depth", 1, &frame, &front, &settings);
  int covered = 0;
  for (int32_t i = 0; i < WIDTH * HEIGHT; ++i) {
    const Ray ray = harness_ray(&front, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    const Hit hit = cast_ray(&flight, &ray);
    SimObstacle grown = flight, shrunk = flight;
    grown.size[2] *= 1.01f, shrunk.size[2] *= 0.99f;
    grown.size[1] *= 1.01f, shrunk.size[1] *= 0.99f;
    if (cast_ray(&grown, &ray).hit != cast_ray(&shrunk, &ray).hit) continue;
    covered += hit.hit;
    // Which of two neighbouring steps is met may be a matter of rounding; a step is 1.2 mm long and 0.5 mm high.
    if (fabs((double)depth[i] - (hit.hit ? hit.t : 0)) > 0.004) {
      fail_msg("pixel %d, %d: depth %.7g, should be %.7g", i % WIDTH, i / WIDTH, (double)depth[i], hit.t);
    }
  }
  assert_true(covered > 1000);
  free(depth);
  harness_close(&harness);
}

// Standing over the steps, within the box around the flight, one sees the flight.
static void test_eye_over_the_steps(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const SimFrame frame = frame_with(&stairs_level);
  const RenderView view = harness_view(-0.4f, 0.7f, 0.1f, 0.3f, 0.5f, 0, 70);
  float *depth = harness_layer(&harness, "background_depth", 1, &frame, &view, &settings);
  int covered = 0;
  for (int32_t i = 0; i < WIDTH * HEIGHT; ++i) {
    Hit hit;
    if (!cast_pixel(&stairs_level, &view, i % WIDTH, i / WIDTH, &hit)) continue;
    covered += hit.hit;
    if (fabs((double)depth[i] - (hit.hit ? hit.t : 0)) > 2e-5) {
      fail_msg("pixel %d, %d: depth %.7g, should be %.7g", i % WIDTH, i / WIDTH, (double)depth[i], hit.t);
    }
  }
  assert_true(covered > WIDTH * HEIGHT / 3);
  free(depth);
  harness_close(&harness);
}

static void test_capsules(void **state) {
  (void)state;
  const SimObstacle *const capsules[] = {&capsule_tilted, &capsule_upright, &capsule_ball};
  for (int i = 0; i < 3; ++i) {
    check_depth(capsules[i]);
    check_normals(capsules[i], 0, 1);
  }
}

static void test_meshes(void **state) {
  (void)state;
  SimMesh *box = dented_box(), *ring = test_mesh_torus(0.45f, 0.18f, 48, 24);
  SimObstacle body = {SIM_MESH, {0}, {0.1f, 0.5f, 0}, {0, -0.2f, 0.1f, 0.9746794f}, GREY, 0, box};
  check_depth(&body);
  check_normals(&body, 0, 1);
  body = (SimObstacle){SIM_MESH, {0}, {0, 0.5f, 0}, {0.5f, 0.1f, 0.1f, 0.8544004f}, GREY, 0, ring};
  check_depth(&body);
  check_normals(&body, 0.45, 2);
  test_mesh_destroy(box);
  test_mesh_destroy(ring);
}

// ---- Shadows ---------------------------------------------------------------------------------------------------------

// Does the sun shine on a point of a surface? 1 or 0; −1 where a little to any side along it, it is otherwise.
static int sunlit(const SimObstacle *o, const double point[3], const double normal[3], const float sun[3]) {
  int lit = 0;
  for (int i = 0; i < 27; ++i) {
    const double aside[3] = {0.02 * (i % 3 - 1), 0.02 * (i / 3 % 3 - 1), 0.02 * (i / 9 - 1)};
    Ray ray = {{point[0], point[1], point[2]}, {(double)sun[0], (double)sun[1], (double)sun[2]}};
    for (int k = 0; k < 3; ++k) ray.origin[k] += aside[k] - dot(aside, normal) * normal[k];
    lit += !cast_ray(o, &ray).hit;
  }
  return lit == 27 ? 1 : lit == 0 ? 0 : -1;
}

// Pictures of the same: where the sun shines, shadows change nothing, and where it does not, there might as well be none.
enum { SHADOWS, NO_SHADOWS, NO_SUN };

static void check_pixel_light(const SimObstacle *o, const RenderSettings *s, uint8_t *const pictures[3],
                              const RenderView *view, int32_t i, int counts[2][2]) {
  Hit hit;
  if (!cast_pixel(o, view, i % WIDTH, i / WIDTH, &hit)) return;
  const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
  double p[3], facing = 0;
  at(p, &ray, hit.hit ? hit.t : -ray.origin[1] / ray.direction[1]);
  for (int k = 0; k < 3 && hit.hit; ++k) {
    p[k] += 0.002 * hit.normal[k]; // off the surface
    facing += hit.normal[k] * (double)s->sun_direction[k];
  }
  if (hit.hit && facing < 0.1) return;
  if (!hit.hit) hit.normal[1] = 1;
  const int lit = sunlit(o, p, hit.normal, s->sun_direction);
  if (lit < 0) return;
  ++counts[hit.hit][lit];
  for (int k = 0; k < 3; ++k) {
    const int got = pictures[SHADOWS][3 * i + k], want = pictures[lit ? NO_SHADOWS : NO_SUN][3 * i + k];
    if (abs(got - want) > 1) {
      fail_msg("%s, %s, pixel %d, %d: %d, should be %d", hit.hit ? "body" : "floor", lit ? "in the sun" : "shaded",
               i % WIDTH, i / WIDTH, got, want);
    }
  }
}

// On a floor of one tile, seen from above.
static void check_shadow(const SimObstacle *obstacle, bool on_itself) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = sunny_settings(0.8f, 1, 0.3f);
  settings.floor = RENDER_FLOOR_TILES;
  settings.tile_size = 1000;
  const SimFrame frame = frame_with(obstacle);
  const RenderView view = harness_view(-1, 4, 1, -0.3f, 0, 0, 40);
  uint8_t *pictures[3];
  pictures[NO_SHADOWS] = harness_draw(&harness, &frame, &view, &settings);
  settings.sun = false;
  pictures[NO_SUN] = harness_draw(&harness, &frame, &view, &settings);
  settings.sun = settings.shadow = true;
  pictures[SHADOWS] = harness_draw(&harness, &frame, &view, &settings);
  int counts[2][2] = {{0}}; // on floor and body, shaded and in the sun
  for (int32_t i = 0; i < WIDTH * HEIGHT; i += 7) {
    check_pixel_light(obstacle, &settings, pictures, &view, i, counts);
  }
  assert_true(counts[0][0] > 30 && counts[0][1] > 500 && counts[1][1] > 50);
  assert_true(!on_itself || counts[1][0] > 30);
  for (int i = 0; i < 3; ++i) free(pictures[i]);
  harness_close(&harness);
}

static void test_shadows(void **state) {
  (void)state;
  SimMesh *box = dented_box(), *ring = test_mesh_torus(0.45f, 0.18f, 48, 24);
  check_shadow(&stairs_back, false);
  check_shadow(&stairs_level, true); // the sun is behind the flight: every step lies in the shadow of the next
  check_shadow(&capsule_tilted, false);
  const SimObstacle dented = {SIM_MESH, {0}, {0, 0.5f, 0}, {0, 0, 0, 1}, GREY, 0, box};
  check_shadow(&dented, false);
  const SimObstacle hoop = {SIM_MESH, {0}, {0, 0.7f, 0}, {0.7071068f, 0, 0, 0.7071068f}, GREY, 0, ring};
  check_shadow(&hoop, false);
  test_mesh_destroy(box);
  test_mesh_destroy(ring);
}

// ---- Meshes come and go ----------------------------------------------------------------------------------------------

static uint8_t *draw_body(Harness *harness, const SimObstacle *obstacle) {
  const SimFrame frame = frame_with(obstacle);
  const RenderSettings settings = render_default_settings();
  return harness_draw(harness, &frame, &front, &settings);
}

// What is drawn is what the frame holds now, not what lay at the same address before.
static void test_a_mesh_may_change_in_place(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  SimMesh *mesh = dented_box();
  float *vertex = (float *)(uintptr_t)mesh->vertex;
  const SimObstacle body = {SIM_MESH, {0}, {0, 0.5f, 0}, TURN_NONE, GREY, 0, mesh};
  uint8_t *before = draw_body(&harness, &body);
  vertex[3 * 7] = vertex[3 * 7 + 1] = vertex[3 * 7 + 2] = 0.4f;
  uint8_t *after = draw_body(&harness, &body);
  assert_memory_not_equal(before, after, 3 * WIDTH * HEIGHT);
  const SimObstacle box = {SIM_BOX, {0.8f, 0.8f, 0.8f}, {0, 0.5f, 0}, TURN_NONE, GREY, 0, NULL};
  uint8_t *truth = draw_body(&harness, &box);
  int different = 0;
  for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i) different += abs(after[i] - truth[i]) > 3;
  assert_true(different < 200); // pixels on the outline
  vertex[3 * 7] = vertex[3 * 7 + 1] = vertex[3 * 7 + 2] = 0;
  uint8_t *again = draw_body(&harness, &body);
  assert_memory_equal(before, again, 3 * WIDTH * HEIGHT);
  free(before);
  free(after);
  free(truth);
  free(again);
  test_mesh_destroy(mesh);
  harness_close(&harness);
}

// Bodies of all shapes in any order are the same picture: they are sorted, and each finds its own mesh.
static void test_any_order(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  SimMesh *box = dented_box(), *ring = test_mesh_torus(0.2f, 0.06f, 24, 12);
  SimObstacle bodies[7] = {
      {SIM_MESH, {0}, {-0.8f, 0.4f, 0}, TURN_TILTED, {0.9f, 0.1f, 0.1f}, 0, box},
      {SIM_STAIRS, {0.3f, 0.3f, 0.3f}, {0, 0.2f, 0}, TURN_NONE, GREY, 4, NULL},
      {SIM_MESH, {0}, {0.3f, 0.9f, 0}, TURN_TILTED, {0.1f, 0.9f, 0.1f}, 0, ring},
      {SIM_BOX, {0.2f, 0.2f, 0.2f}, {0.5f, 0.2f, 0}, TURN_NONE, GREY, 0, NULL},
      {SIM_CAPSULE, {0.2f, 0.5f, 0}, {0.8f, 0.5f, 0}, TURN_NONE, GREY, 0, NULL},
      {SIM_SPHERE, {0.3f, 0, 0}, {-0.2f, 0.9f, 0}, TURN_NONE, GREY, 0, NULL},
      {SIM_MESH, {0}, {0.4f, 0.2f, 0.8f}, TURN_NONE, {0.1f, 0.1f, 0.9f}, 0, ring},
  };
  SimFrame frame = frame_with(bodies);
  frame.obstacle_count = 7;
  const RenderSettings settings = render_default_settings();
  uint8_t *forward = harness_draw(&harness, &frame, &front, &settings);
  for (int i = 0; i < 3; ++i) {
    const SimObstacle swap = bodies[i];
    bodies[i] = bodies[6 - i];
    bodies[6 - i] = swap;
  }
  uint8_t *backward = harness_draw(&harness, &frame, &front, &settings);
  assert_memory_equal(forward, backward, 3 * WIDTH * HEIGHT);
  free(forward);
  free(backward);
  test_mesh_destroy(box);
  test_mesh_destroy(ring);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_stairs),
      cmocka_unit_test(test_a_thousand_steps),
      cmocka_unit_test(test_eye_over_the_steps),
      cmocka_unit_test(test_capsules),
      cmocka_unit_test(test_meshes),
      cmocka_unit_test(test_shadows),
      cmocka_unit_test(test_a_mesh_may_change_in_place),
      cmocka_unit_test(test_any_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
