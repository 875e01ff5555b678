// Liquids in the style "raycast": light on a layer of known depth worked out on paper, and every material by its name.
#include "tests/render/cloud.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 96
#define HEIGHT 72
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define SPACING (2 * RADIUS)

static RenderSettings settings_of_raycast(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  return settings;
}

static const float white[3] = {1, 1, 1};

// ---- A layer of water on the checker ---------------------------------------------------------------------------------

// `tint`: the colour of all its particles.
static TestWater layer_of_water(const float tint[3]) {
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 40, 5, 40, 0);
  for (int32_t i = 0; i < cloud->count; ++i) {
    cloud->position[3 * i + 1] += 2.5f * SPACING; // it stands on y = 0
    memcpy(cloud->colour + 3 * i, tint, 3 * sizeof *tint);
  }
  TestWater water = cloud_water(cloud, CLOUD_COLOURS, NULL);
  free(cloud);
  return water;
}

typedef struct Seen {
  double light[3];
  double apart; // m, from where the bent ray meets the floor to the next square of the checker
} Seen;

// What the eye sees at a point p of flat water, looking along `way`: Snell, Beer and Lambert down to the floor at y = 0, what
// the water itself sends back, and the sky by Schlick.
static Seen look(const RenderSettings *s, const double p[3], const double way[3], const float tint[3], double spacing) {
  const double n = (double)s->refractive_index, length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  const double d[3] = {way[0] / length, way[1] / length, way[2] / length}, up = -sqrt(1 - (1 - d[1] * d[1]) / (n * n));
  const double f0 = pow((n - 1) / (n + 1), 2), mirror = f0 + (1 - f0) * pow(1 + d[1], 5), metres = -p[1] / up;
  const double x = p[0] + metres * d[0] / n, z = p[2] + metres * d[2] / n, tile = (double)s->tile_size;
  const float *square = s->floor_colour[fmod(fabs(floor(x / tile) + floor(z / tile)), 2) != 0];
  const double in_x = fabs(x / tile - round(x / tile)), in_z = fabs(z / tile - round(z / tile));
  Seen seen = {.apart = fmin(in_x, in_z) * tile};
  // Tints show as soon as there is half a spacing of water.
  const double tinted = 1 - exp(-metres / (0.5 * spacing));
  for (int k = 0; k < 3; ++k) {
    const double extinction = (double)s->absorption[k] + (double)s->scattering[k], left = exp(-extinction * metres);
    const double horizon = (double)s->sky_horizon[k], zenith = (double)s->sky_zenith[k];
    const double source = 0.9 * (horizon + 0.5 * (zenith - horizon)); // of the sky over a level surface
    const double inside = (double)square[k] * left + (double)s->scattering[k] / extinction * (1 - left) * source;
    const double sky = horizon - d[1] * (zenith - horizon); // mirrored: up
    seen.light[k] = (1 - mirror) * (1 + tinted * ((double)tint[k] - 1)) * inside + mirror * sky;
  }
  return seen;
}

static void expect_light(Harness *harness, const char *what, const RenderSettings *settings, const float tint[3]) {
  static const RenderView views[] = {{{0.05f, 1.3f, 0.06f}, {0.03f, 0, 0.02f}, 30},
                                     {{0.5f, 1.1f, 0.7f}, {0.03f, 0, 0.02f}, 24}};
  TestWater water = layer_of_water(tint);
  for (int v = 0; v < 2; ++v) {
    uint8_t *rgb = harness_draw(harness, &water.frame, &views[v], settings);
    float *depth = harness_layer(harness, "depth", 1, &water.frame, &views[v], settings);
    double worst = 0, sum = 0;
    int pixels = 0;
    for (int i = 0; i < PIXELS; ++i) {
      const Ray ray = harness_ray(&views[v], WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
      double p[3];
      for (int k = 0; k < 3; ++k) p[k] = ray.origin[k] + (double)depth[i] * ray.direction[k];
      if (depth[i] <= 0 || fmax(fabs(p[0]), fabs(p[2])) > 12 * (double)SPACING) continue;
      const Seen seen = look(settings, p, ray.direction, tint, (double)SPACING);
      if (seen.apart < 0.015) continue;
      ++pixels;
      for (int k = 0; k < 3; ++k) {
        const double off = fabs((double)rgb[3 * i + k] - 255 * fmin(seen.light[k], 1));
        worst = fmax(worst, off);
        sum += off / 3;
      }
    }
    print_message("%s, view %d: %d pixels, off by %.2f of 255 in the mean, at most %.2f\n", what, v, pixels,
                  sum / pixels, worst);
    assert_true(pixels > PIXELS / 4);
    assert_true(worst < 1);
    free(rgb);
    free(depth);
  }
  test_water_destroy(&water);
}

static void test_light_of_a_layer(void **state) {
  Harness *harness = *state;
  const float red[3] = {0.9f, 0.3f, 0.2f};
  RenderSettings settings = settings_of_raycast();
  expect_light(harness, "water", &settings, white);
  expect_light(harness, "tinted water", &settings, red);
  for (int k = 0; k < 3; ++k) settings.scattering[k] = 0;
  expect_light(harness, "absorbing only", &settings, white);
  const float strong[3] = {1, 4, 12}, turbid[3] = {6, 3, 1};
  memcpy(settings.absorption, strong, sizeof strong);
  memcpy(settings.scattering, turbid, sizeof turbid);
  settings.refractive_index = 1.5f;
  expect_light(harness, "a turbid liquid", &settings, white);
}

// ---- Materials -------------------------------------------------------------------------------------------------------

static const RenderView over_layer = {{0.4f, 1.0f, 0.6f}, {0.03f, 0, 0.02f}, 30};

static RenderSettings settings_with(const char *name) {
  RenderSettings settings = settings_of_raycast();
  const RenderMaterial *material = render_material_find(name);
  assert_non_null(material);
  assert_string_equal(material->name, name);
  render_use_material(&settings, material);
  return settings;
}

// Mean of the difference of two pictures, of 255.
static double difference(const uint8_t *a, const uint8_t *b) {
  double sum = 0;
  for (int i = 0; i < 3 * PIXELS; ++i) sum += fabs((double)a[i] - (double)b[i]);
  return sum / (3 * PIXELS);
}

static void test_names(void **state) {
  (void)state;
  static const char *const names[] = {"water", "milk", "juice", "oil", "cola", "ink", "metal", "gold", "copper"};
  for (int32_t i = 0; i < 9; ++i) assert_string_equal(render_material(i)->name, names[i]);
  assert_null(render_material(9));
  assert_null(render_material(-1));
  assert_null(render_material_find("treacle"));
  assert_null(render_material_find(""));
  assert_null(render_material_find(NULL));
  // The first one is what is drawn without any.
  const RenderSettings none = settings_of_raycast(), water = settings_with("water");
  assert_memory_equal(none.absorption, water.absorption, sizeof none.absorption);
  assert_memory_equal(none.scattering, water.scattering, sizeof none.scattering);
  assert_memory_equal(none.reflectance, water.reflectance, sizeof none.reflectance);
  assert_true(none.refractive_index == water.refractive_index);
}

static void test_every_material_looks_different(void **state) {
  Harness *harness = *state;
  TestWater water = layer_of_water(white);
  uint8_t *rgb[9];
  for (int32_t i = 0; i < 9; ++i) {
    const RenderSettings settings = settings_with(render_material(i)->name);
    rgb[i] = harness_draw(harness, &water.frame, &over_layer, &settings);
  }
  double least = INFINITY;
  for (int i = 0; i < 9; ++i) {
    for (int k = 0; k < i; ++k) least = fmin(least, difference(rgb[i], rgb[k]));
  }
  print_message("any two materials differ by %.1f of 255 or more\n", least);
  assert_true(least > 10);
  for (int i = 0; i < 9; ++i) free(rgb[i]);
  test_water_destroy(&water);
}

// Level metal under the sky of two colours: the mirrored sky times Schlick's share, which the metal tints.
static void expect_mirror(Harness *harness, const TestWater *water, const char *name) {
  const RenderSettings settings = settings_with(name);
  uint8_t *rgb = harness_draw(harness, &water->frame, &over_layer, &settings);
  float *depth = harness_layer(harness, "depth", 1, &water->frame, &over_layer, &settings);
  double worst = 0;
  int pixels = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&over_layer, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    const double *d = ray.direction, down = -d[1] / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double x = ray.origin[0] + (double)depth[i] * d[0], z = ray.origin[2] + (double)depth[i] * d[2];
    if (depth[i] <= 0 || fmax(fabs(x), fabs(z)) > 12 * (double)SPACING) continue;
    ++pixels;
    for (int k = 0; k < 3; ++k) {
      const double f0 = (double)settings.reflectance[k], share = f0 + (1 - f0) * pow(1 - down, 5);
      const double horizon = (double)settings.sky_horizon[k], zenith = (double)settings.sky_zenith[k];
      const double want = 255 * fmin(share * (horizon + down * (zenith - horizon)), 1);
      worst = fmax(worst, fabs((double)rgb[3 * i + k] - want));
    }
  }
  print_message("%s: %d pixels, off by at most %.2f of 255\n", name, pixels, worst);
  assert_true(pixels > PIXELS / 4);
  // Half for rounding; the surface of a lattice is not quite level, and a tenth of a degree is another half.
  assert_true(worst < 1.5);
  free(rgb);
  free(depth);
}

static void test_metals_mirror(void **state) {
  Harness *harness = *state;
  TestWater water = layer_of_water(white);
  expect_mirror(harness, &water, "metal");
  expect_mirror(harness, &water, "gold");
  expect_mirror(harness, &water, "copper");
  test_water_destroy(&water);
}

// Of pixels that show the liquid, how many change with the colours of the floor under it.
static double share_that_shows_floor(Harness *harness, const TestWater *water, const char *name) {
  RenderSettings settings = settings_with(name);
  float *depth = harness_layer(harness, "depth", 1, &water->frame, &over_layer, &settings);
  uint8_t *before = harness_draw(harness, &water->frame, &over_layer, &settings);
  for (int k = 0; k < 3; ++k) settings.floor_colour[0][k] = settings.floor_colour[1][k] = 0.5f;
  uint8_t *after = harness_draw(harness, &water->frame, &over_layer, &settings);
  int pixels = 0, changed = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&over_layer, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    const double x = ray.origin[0] + (double)depth[i] * ray.direction[0];
    const double z = ray.origin[2] + (double)depth[i] * ray.direction[2];
    // Away from the sides of the layer, which mirror the floor.
    if (depth[i] <= 0 || fmax(fabs(x), fabs(z)) > 12 * (double)SPACING) continue;
    ++pixels;
    changed += memcmp(before + 3 * i, after + 3 * i, 3) != 0;
  }
  free(depth);
  free(before);
  free(after);
  print_message("%s: %d of %d pixels show the floor\n", name, changed, pixels);
  return (double)changed / pixels;
}

static void test_metals_hide_what_is_behind(void **state) {
  Harness *harness = *state;
  TestWater water = layer_of_water(white);
  assert_true(share_that_shows_floor(harness, &water, "metal") == 0);
  assert_true(share_that_shows_floor(harness, &water, "copper") == 0);
  assert_true(share_that_shows_floor(harness, &water, "water") > 0.95);
  // 20 cm of milk let nothing through.
  assert_true(share_that_shows_floor(harness, &water, "milk") < 0.01);
  test_water_destroy(&water);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_light_of_a_layer),
      cmocka_unit_test(test_names),
      cmocka_unit_test(test_every_material_looks_different),
      cmocka_unit_test(test_metals_mirror),
      cmocka_unit_test(test_metals_hide_what_is_behind),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
