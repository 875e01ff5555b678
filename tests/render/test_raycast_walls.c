// The style "raycast" in containers: water lies flush with the walls, and its surface goes on to them as if they were not there.
#include "tests/render/cloud.h"
#include "tests/render/reference/iso.h"
#include "tests/render/walls.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 96
#define HEIGHT 72
#define PIXELS (WIDTH * HEIGHT)
#define SPACING (2 * WALL_RADIUS)
#define DEGREES (180 / 3.14159265358979323846)

static RenderSettings settings_of_raycast(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  settings.floor = RENDER_FLOOR_NONE;
  return settings;
}

// Still water in the tank and in the glass.
typedef struct Pools {
  TestWater tank, glass;
} Pools;

// ---- On the walls ----------------------------------------------------------------------------------------------------

static void expect_flush(const char *what, const TestWater *water, WallMeet *meet, const RenderView *view,
                         const char *layer) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const RenderSettings settings = settings_of_raycast();
  float *depth = harness_layer(&harness, "depth", 1, &water->frame, view, &settings);
  float *normal = harness_layer(&harness, layer, 3, &water->frame, view, &settings);
  double worst_depth = 0, worst_angle = 0;
  int pixels = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    WallMeeting m;
    if (!meet(&ray, 0, &m) || m.from_edge < 0) continue;
    double sine = 0;
    for (int k = 0; k < 3; ++k) sine += pow((double)normal[3 * i + k] - m.normal[k], 2);
    worst_depth = fmax(worst_depth, fabs((double)depth[i] - m.depth) / (double)SPACING);
    worst_angle = fmax(worst_angle, 2 * asin(fmin(sqrt(sine) / 2, 1)) * DEGREES);
    ++pixels;
  }
  print_message("%s, %s: %d pixels: %.2g spacings, %.2g degrees\n", what, layer, pixels, worst_depth, worst_angle);
  assert_true(pixels > PIXELS / 5);
  assert_true(worst_depth < 1e-3);
  assert_true(worst_angle < 0.01);
  free(depth);
  free(normal);
  harness_close(&harness);
}

static void test_flush(void **state) {
  const Pools *pools = *state;
  const RenderView level = {{0.5f, 0.25f, 2.1f}, {0.52f, 0.22f, 0}, 30};
  const RenderView above = {{0.1f, 0.9f, 1.9f}, {0.5f, 0.2f, 0.2f}, 30};
  const RenderView low = {{0.2f, -0.6f, 1.4f}, {0.5f, 0.1f, 0.2f}, 30};
  const RenderView at_glass = {{0.35f, 0.25f, 2.1f}, {0.35f, 0.22f, 0}, 25};
  expect_flush("tank", &pools->tank, wall_meet_tank, &level, "raw_normal");
  expect_flush("tank from above", &pools->tank, wall_meet_tank, &above, "normal");
  expect_flush("tank from below", &pools->tank, wall_meet_tank, &low, "raw_normal");
  expect_flush("glass", &pools->glass, wall_meet_glass, &at_glass, "raw_normal");
  expect_flush("glass", &pools->glass, wall_meet_glass, &at_glass, "normal");
}

// ---- Up to the walls -------------------------------------------------------------------------------------------------

enum { BANDS = 6 };
typedef struct Band {
  int pixels;
  double height, tilt, outward; // spacings; degrees from vertical, mean, and mean towards the wall
} Band;

static double distance_to_wall(const SimContainer *c, const double p[3], double out[3]) {
  double least = INFINITY;
  out[0] = out[1] = out[2] = 0;
  if (c->shape == SIM_CONTAINER_GLASS) {
    const double r = (double)c->max[0] / 2, x = p[0] - r, z = p[2] - r, at = hypot(x, z);
    out[0] = x / at, out[2] = z / at;
    return r - at;
  }
  for (int k = 0; k < 3; k += 2) {
    for (int side = 0; side < 2; ++side) {
      const double d = side == 0 ? p[k] - (double)c->min[k] : (double)c->max[k] - p[k];
      if (d >= least) continue;
      least = d;
      out[0] = out[2] = 0;
      out[k] = side == 0 ? -1 : 1;
    }
  }
  return least;
}

// Bands of a spacing's width along the walls; the last one is the rest.
static void measure_bands(Harness *harness, const TestWater *water, float level, const RenderView *view, Band *bands) {
  const RenderSettings settings = settings_of_raycast();
  float *depth = harness_layer(harness, "depth", 1, &water->frame, view, &settings);
  float *normal = harness_layer(harness, "normal", 3, &water->frame, view, &settings);
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    double p[3], out[3];
    for (int k = 0; k < 3; ++k) p[k] = ray.origin[k] + (double)depth[i] * ray.direction[k];
    const double wall = distance_to_wall(&water->frame.container, p, out) / (double)SPACING;
    if (depth[i] <= 0 || wall < 1e-3 || p[1] < (double)level - 2 * (double)SPACING) continue;
    Band *band = &bands[wall < BANDS - 1 ? (int)wall : BANDS - 1];
    const double y = (double)normal[3 * i + 1];
    ++band->pixels;
    band->height += (p[1] - (double)level) / (double)SPACING;
    band->tilt += acos(fmin(y, 1)) * DEGREES;
    band->outward += ((double)normal[3 * i] * out[0] + (double)normal[3 * i + 2] * out[2]) * DEGREES;
  }
  free(depth);
  free(normal);
}

// Against the rest, the last band.
static void expect_no_seam(const char *what, const TestWater *water, float level) {
  static const RenderView views[] = {{{0.4f, 1.8f, 0.3f}, {0.4f, 0, 0.29f}, 40},
                                     {{1.2f, 1.3f, 1.3f}, {0.4f, 0.3f, 0.3f}, 40}};
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  Band bands[BANDS] = {0};
  for (int k = 0; k < 2; ++k) measure_bands(&harness, water, level, &views[k], bands);
  for (int b = BANDS - 1; b >= 0; --b) {
    Band *band = &bands[b];
    assert_true(band->pixels > 50);
    band->height /= band->pixels;
    band->tilt /= band->pixels;
    band->outward /= band->pixels;
    print_message("%s, %d spacings from the wall: level %+.3f spacings, tilt %.2f degrees, outwards %+.2f\n", what, b,
                  band->height, band->tilt, band->outward);
    assert_true(fabs(band->height - bands[BANDS - 1].height) < 0.06);
    assert_true(band->tilt < 1);
    assert_true(fabs(band->outward) < 0.8);
  }
  harness_close(&harness);
}

static void test_no_seam(void **state) {
  const Pools *pools = *state;
  const SimContainer narrow = {{0, 0, 0}, {18 * SPACING, 0.8f, 14 * SPACING}, SIM_CONTAINER_BOX};
  TestWater settled = test_water_settled(&narrow, WALL_RADIUS, 6 * SPACING);
  expect_no_seam("tank in rows", &pools->tank, WALL_LEVEL);
  expect_no_seam("glass in rings", &pools->glass, WALL_LEVEL);
  expect_no_seam("settled tank", &settled, 6 * SPACING);
  test_water_destroy(&settled);
}

// ---- Against the slow twin -------------------------------------------------------------------------------------------

#define COLUMNS 11
static const SimContainer small_tank = {{0, 0, 0}, {COLUMNS * SPACING, 0.6f, COLUMNS *SPACING}, SIM_CONTAINER_BOX};

static TestWater small_pool(void) {
  Cloud *cloud = cloud_create(WALL_RADIUS);
  cloud_add_block(cloud, COLUMNS, 6, COLUMNS, 0.2f);
  for (int32_t i = 0; i < cloud->count; ++i) {
    for (int k = 0; k < 3; ++k) cloud->position[3 * i + k] += 0.5f * SPACING * (k == 1 ? 6 : COLUMNS);
  }
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, &small_tank);
  free(cloud);
  return water;
}

// Depths between which a ray is in the tank, whose top is open.
static void room_of(const Ray *ray, double t[2]) {
  t[0] = 1e-3;
  t[1] = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const double a = ((double)small_tank.min[k] - ray->origin[k]) / ray->direction[k];
    const double b = k == 1 ? (ray->direction[1] > 0 ? INFINITY : -INFINITY)
                            : ((double)small_tank.max[k] - ray->origin[k]) / ray->direction[k];
    t[0] = fmax(t[0], fmin(a, b));
    t[1] = fmin(t[1], fmax(a, b));
  }
}

typedef struct Errors {
  int walls, surface, grazed; // pixels
  double depth, angle;        // greatest; spacings, degrees
} Errors;

// Spacings of water on a ray from its surface at t on.
static double water_on(const IsoWater *twin, const Ray *ray, double t, double end) {
  const double *d = ray->direction, out = iso_crossing(twin, ray->origin, d, t * (1 + 1e-9), end);
  return ((out < 0 ? -out : end) - t) * sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / twin->spacing;
}

static void compare_pixel(const IsoWater *twin, const Ray *ray, double depth, const float normal[3], Errors *e) {
  double t[2], p[3], expected[3];
  room_of(ray, t);
  if (t[0] >= t[1]) {
    assert_true(depth == 0);
    return;
  }
  for (int k = 0; k < 3; ++k) p[k] = ray->origin[k] + t[0] * ray->direction[k];
  const bool at_wall = iso_field(twin, p) > (double)twin->settings.iso;
  const double truth = at_wall ? t[0] : iso_crossing(twin, ray->origin, ray->direction, t[0], t[1]);
  if (depth == 0) {
    // Steps are a tenth of a spacing at least: less water than that may be missed.
    assert_true(truth == 0 || (!at_wall && water_on(twin, ray, truth, t[1]) < 0.1));
    e->grazed += truth != 0;
    return;
  }
  e->depth = fmax(e->depth, fabs(depth - truth) / twin->spacing);
  e->walls += at_wall;
  e->surface += !at_wall;
  for (int k = 0; k < 3; ++k) p[k] = ray->origin[k] + truth * ray->direction[k];
  // Where the surface and a wall meet, rounding decides whose normal it is.
  if (truth - t[0] < 1e-3 * twin->spacing || !iso_normal(twin, p, expected)) return;
  double cosine = 0;
  for (int k = 0; k < 3; ++k) cosine += (double)normal[k] * expected[k];
  e->angle = fmax(e->angle, acos(fmin(cosine, 1)) * DEGREES);
}

static void expect_like_twin(const char *what, const RenderView *view) {
  TestWater water = small_pool();
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const RenderSettings settings = settings_of_raycast();
  float *depth = harness_layer(&harness, "depth", 1, &water.frame, view, &settings);
  float *normal = harness_layer(&harness, "raw_normal", 3, &water.frame, view, &settings);
  IsoWater twin = iso_water_create(&water.frame, &settings.raycast);
  Errors e = {0};
  for (int i = 0; i < PIXELS; i += 3) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    compare_pixel(&twin, &ray, (double)depth[i], normal + 3 * i, &e);
  }
  print_message("%s: %d pixels of walls, %d of the surface, %d grazed: %.2g spacings, %.2g degrees\n", what, e.walls,
                e.surface, e.grazed, e.depth, e.angle);
  assert_true(e.walls > 500 && e.surface > 300);
  assert_true(e.grazed <= 0.005 * (e.walls + e.surface));
  assert_true(e.depth < 0.01);
  assert_true(e.angle < 1);
  iso_water_destroy(&twin);
  free(depth);
  free(normal);
  harness_close(&harness);
  test_water_destroy(&water);
}

static void test_like_twin(void **state) {
  (void)state;
  const RenderView corner = {{0.75f, 0.55f, 0.85f}, {0.2f, 0.1f, 0.19f}, 30};
  const RenderView over_front = {{0.15f, 0.5f, 0.9f}, {0.2f, 0.13f, 0.17f}, 26};
  expect_like_twin("from over a corner", &corner);
  expect_like_twin("from over the front", &over_front);
}

// ---- Mirrored by a wall ----------------------------------------------------------------------------------------------

// The colour of the checker, or the sky, that a ray in the air sees; *edge: m, to the next edge of a square.
static double light_in_air(const RenderSettings *s, const double p[3], const double d[3], int k, double *edge) {
  if (d[1] >= 0) return (double)s->sky_horizon[k] + d[1] * ((double)s->sky_zenith[k] - (double)s->sky_horizon[k]);
  const double t = -p[1] / d[1], tile = (double)s->tile_size, x = (p[0] + t * d[0]) / tile,
               z = (p[2] + t * d[2]) / tile;
  *edge = fmin(*edge, tile * fmin(fabs(x - round(x)), fabs(z - round(z))));
  return (double)s->floor_colour[fmod(fabs(floor(x) + floor(z)), 2) != 0][k];
}

// In through the front at p, to the left wall, mirrored there, and down to the floor before the back: where that begins, and
// its direction. false: it goes elsewhere.
static bool by_left_wall(const double p[3], const double d[3], double index, double q[3], double way[3]) {
  const double bent[3] = {d[0] / index, d[1] / index, -sqrt(1 - (d[0] * d[0] + d[1] * d[1]) / (index * index))};
  const double t = ((double)wall_tank.min[0] - p[0]) / bent[0];
  if (!(bent[0] < -1e-6) || index * index * (1 - bent[0] * bent[0]) < 1.02) return false;
  for (int k = 0; k < 3; ++k) q[k] = p[k] + t * bent[k];
  const double low = (double)wall_tank.min[1] + 0.02, high = (double)WALL_LEVEL - 3 * (double)SPACING;
  if (q[1] < low || q[1] > high || q[2] < (double)wall_tank.min[2] + 0.02) return false;
  for (int k = 0; k < 3; ++k) way[k] = k == 0 ? -bent[0] : bent[k];
  const double down = (q[1] - (double)wall_tank.min[1]) / -way[1];
  return way[1] < 0 && q[2] + down * way[2] > (double)wall_tank.min[2] + 0.02;
}

// Clear water: nothing is lost on the way.
static void test_side_wall_mirrors(void **state) {
  const Pools *pools = *state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  settings.tile_size = 0.2f;
  for (int k = 0; k < 3; ++k) settings.absorption[k] = settings.scattering[k] = 0;
  const RenderView view = {{0.75f, 0.6f, 1.9f}, {0.06f, 0.17f, 0.525f}, 9};
  const double index = (double)settings.refractive_index, f0 = pow((index - 1) / (index + 1), 2);
  uint8_t *rgb = harness_draw(&harness, &pools->tank.frame, &view, &settings);
  double worst = 0;
  int pixels = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    WallMeeting m;
    if (!wall_meet_tank(&ray, 0, &m) || m.from_edge < 0 || m.normal[2] < 0.99) continue;
    double p[3], d[3], q[3], way[3], length = 0, edge = 1;
    for (int k = 0; k < 3; ++k) length += ray.direction[k] * ray.direction[k];
    for (int k = 0; k < 3; ++k)
      d[k] = ray.direction[k] / sqrt(length), p[k] = ray.origin[k] + m.depth * ray.direction[k];
    if (!by_left_wall(p, d, index, q, way)) continue;
    const double mirror = f0 + (1 - f0) * pow(1 + d[2], 5), back[3] = {d[0], d[1], -d[2]};
    double off = 0;
    for (int k = 0; k < 3; ++k) {
      const double through = light_in_air(&settings, q, way, k, &edge),
                   outside = light_in_air(&settings, p, back, k, &edge);
      off = fmax(off, fabs(255 * ((1 - mirror) * through + mirror * outside) - (double)rgb[3 * i + k]));
    }
    if (edge < 0.02) continue;
    worst = fmax(worst, off);
    ++pixels;
  }
  print_message("mirrored by the left wall: %d pixels, off by at most %.2f of 255\n", pixels, worst);
  assert_true(pixels > 200);
  assert_true(worst < 1.5);
  free(rgb);
  harness_close(&harness);
}

// A slab outside of the left wall, whose face is as far into the tank.
static uint8_t *draw_slab(Harness *harness, const TestWater *water, const RenderView *view, float inwards) {
  const SimObstacle slab = {.shape = SIM_BOX,
                            .size = {0.1f, 2, 4},
                            .position = {wall_tank.min[0] - 0.05f + inwards, 0.5f, 0.5f},
                            .rotation = {0, 0, 0, 1},
                            .colour = {0.9f, 0.2f, 0.1f}};
  SimFrame frame = water->frame;
  frame.obstacles = &slab;
  frame.obstacle_count = 1;
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  return harness_draw(harness, &frame, view, &settings);
}

// A solid whose face lies in a wall is met by rays in the water, and no wall mirrors there.
static void test_solid_flush_with_wall(void **state) {
  const Pools *pools = *state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const RenderView view = {{0.75f, 0.6f, 1.9f}, {0.06f, 0.17f, 0.525f}, 9};
  uint8_t *flush = draw_slab(&harness, &pools->tank, &view, 0);
  uint8_t *inside = draw_slab(&harness, &pools->tank, &view, 0.001f);
  int other = 0, slab = 0;
  for (int i = 0; i < PIXELS; ++i) {
    int most = 0;
    for (int k = 0; k < 3; ++k) most = (int)fmax(most, abs(flush[3 * i + k] - inside[3 * i + k]));
    other += most > 12;
    slab += inside[3 * i] > inside[3 * i + 2] + 40;
  }
  print_message("a slab in the left wall: %d pixels, %d of the picture are others than with it a millimetre inside\n",
                slab, other);
  assert_true(slab > 200);
  assert_true(other < 60); // along its edges
  free(flush);
  free(inside);
  harness_close(&harness);
}

static int open_pools(void **state) {
  Pools *pools = malloc(sizeof *pools);
  *pools = (Pools){test_water_pool(&wall_tank, WALL_RADIUS, WALL_LEVEL),
                   test_water_pool(&wall_glass, WALL_RADIUS, WALL_LEVEL)};
  *state = pools;
  return 0;
}

static int close_pools(void **state) {
  Pools *pools = *state;
  test_water_destroy(&pools->tank);
  test_water_destroy(&pools->glass);
  free(pools);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_flush), cmocka_unit_test(test_no_seam),
                                     cmocka_unit_test(test_like_twin), cmocka_unit_test(test_side_wall_mirrors),
                                     cmocka_unit_test(test_solid_flush_with_wall)};
  return cmocka_run_group_tests(tests, open_pools, close_pools);
}
