// Light that the water's surface bundles: how much of it comes to the floor, and where, against rays traced in double precision.
#include "tests/render/fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NODES 101
#define SPACING 0.02f
#define SIDE 2.0 // m, of the field

static const double deg = 3.14159265358979323846 / 180;

// ---- Truth -----------------------------------------------------------------------------------------------------------

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Eq. 3: the direction behind a surface with this upward unit normal, of light that comes from the unit direction `sun`.
static void refracted(const double sun[3], const double normal[3], double index, double out[3]) {
  const double c = dot(sun, normal), k = sqrt(1 - (1 - c * c) / (index * index));
  for (int i = 0; i < 3; ++i) out[i] = -sun[i] / index + (c / index - k) * normal[i];
}

// Fresnel's equations for s and p polarised light, by amplitudes; their mean.
static double transmitted(double cosine, double index) {
  const double sine = sqrt(1 - cosine * cosine), a = acos(cosine), b = asin(sine / index);
  if (a < 1e-6) return 1 - pow((index - 1) / (index + 1), 2);
  const double s = sin(a - b) / sin(a + b), p = tan(a - b) / tan(a + b);
  return 1 - 0.5 * (s * s + p * p);
}

// Light taken in by a square metre of the ground under a surface of these slopes, in the sun's.
static double taken(const double sun[3], double dx, double dz, double index, double normal[3]) {
  const double length = sqrt(dx * dx + dz * dz + 1);
  normal[0] = -dx / length;
  normal[1] = 1 / length;
  normal[2] = -dz / length;
  const double c = dot(sun, normal);
  return c > 0 ? transmitted(c, index) * c * length : 0;
}

// ---- Scenes ----------------------------------------------------------------------------------------------------------

static void set_sun(FieldBench *b, double elevation, double azimuth, double sun[3]) {
  const double to[3] = {cos(elevation * deg) * cos(azimuth * deg), sin(elevation * deg),
                        cos(elevation * deg) * sin(azimuth * deg)};
  for (int k = 0; k < 3; ++k) {
    sun[k] = to[k];
    b->settings.sun_direction[k] = (float)to[k];
  }
}

static void reset(FieldBench *b) {
  b->settings = render_default_settings();
  b->settings.floor_level = 0;
  b->frame = (SimFrame){0};
}

// A wave along x, and one along z, of whole lengths in the field.
typedef struct Wave {
  double level, x_height, x_number, z_height, z_number; // m, rad/m
} Wave;

static double wave_height(double x, double z, const void *context) {
  const Wave *w = context;
  return w->level + w->x_height * cos(w->x_number * x) + w->z_height * cos(w->z_number * z);
}

static TestField wave_field(const Wave *wave) {
  return test_field_create(NODES, NODES, SPACING, 0, 0, wave_height, wave);
}

// Mean of the light over the floor below the field, and its extremes.
static double floor_mean(const FieldBench *b, const float *light, double range[2]) {
  double sum = 0, rgb[3];
  const int samples = 200;
  range[0] = 1e30;
  range[1] = 0;
  for (int i = 0; i < samples * samples; ++i) {
    const double p[3] = {SIDE * (i % samples + 0.5) / samples, 0, SIDE * (double)(i / samples + 0.5) / samples};
    field_light_at(b, light, p, rgb);
    sum += rgb[0];
    range[0] = fmin(range[0], rgb[0]);
    range[1] = fmax(range[1], rgb[0]);
  }
  return sum / (samples * samples);
}

// ---- Light is conserved ----------------------------------------------------------------------------------------------

static void test_level_water(void **state) {
  FieldBench *b = *state;
  const Wave level = {.level = 0.5};
  const double elevations[] = {20, 45, 70, 90};
  reset(b);
  TestField f = wave_field(&level);
  for (int i = 0; i < 4; ++i) {
    double sun[3], way[3], range[2];
    set_sun(b, elevations[i], 30, sun);
    float *light = field_bench_light(b, &f);
    const double index = (double)b->settings.refractive_index;
    refracted(sun, (double[3]){0, 1, 0}, index, way);
    const double mean = floor_mean(b, light, range) * -way[1], want = transmitted(sun[1], index) * sun[1];
    print_message("sun at %.0f degrees: floor %.5f of the sun, want %.5f (%+.3f %%); from %.5f to %.5f\n",
                  elevations[i], mean, want, 100 * (mean / want - 1), range[0] * -way[1], range[1] * -way[1]);
    assert_true(fabs(mean / want - 1) < 2e-3);
    assert_true(range[1] - range[0] < 0.01 * mean); // next to the walls, too
    assert_true(fabs((double)b->caustics.level_light * -way[1] / want - 1) < 1e-5);
    for (int k = 0; k < 3; ++k) assert_true(fabs((double)b->caustics.way[k] - way[k]) < 1e-5);
    free(light);
  }
  test_field_destroy(&f);
}

static void test_waves_conserve_light(void **state) {
  FieldBench *b = *state;
  const Wave waves[] = {{0.5, 0.01, 10 * deg * 180 / SIDE, 0.01, 16 * deg * 180 / SIDE},
                        {0.8, 0.03, 8 * deg * 180 / SIDE, 0.02, 6 * deg * 180 / SIDE}};
  for (int i = 0; i < 4; ++i) {
    const Wave *w = &waves[i % 2];
    double sun[3], way[3], normal[3], range[2], want = 0;
    reset(b);
    set_sun(b, i < 2 ? 50 : 80, 20, sun);
    TestField f = wave_field(w);
    float *light = field_bench_light(b, &f);
    const double index = (double)b->settings.refractive_index;
    const int samples = 400;
    for (int k = 0; k < samples * samples; ++k) {
      const double x = SIDE * (k % samples) / samples, z = SIDE * (double)(k / samples) / samples;
      want += taken(sun, -w->x_height * w->x_number * sin(w->x_number * x),
                    -w->z_height * w->z_number * sin(w->z_number * z), index, normal) /
              (samples * samples);
    }
    refracted(sun, (double[3]){0, 1, 0}, index, way);
    const double mean = floor_mean(b, light, range) * -way[1];
    print_message("waves of %.2f and %.2f m, sun at %d degrees: floor %.5f of the sun, want %.5f (%+.3f %%); to %.2f\n",
                  w->x_height, w->z_height, i < 2 ? 50 : 80, mean, want, 100 * (mean / want - 1), range[1]);
    assert_true(fabs(mean / want - 1) < 0.02);
    assert_true(range[1] > 2 * mean);
    free(light);
    test_field_destroy(&f);
  }
}

// ---- Where the bright lines lie --------------------------------------------------------------------------------------

#define BINS 1000 // of the field along x

// Light across the refracted sunlight on a plane at a height under a wave along x, by tracing. `blur`: standard deviation, m.
// `folds`: where it would be without end; returns how many.
static int trace_wave(const Wave *w, const double sun[3], double index, double height, double blur, double bins[BINS],
                      double folds[64]) {
  const int rays = 1000000;
  double way[3], before = 0, change = 0, sharp[BINS] = {0};
  int count = 0;
  refracted(sun, (double[3]){0, 1, 0}, index, way);
  for (int i = 0; i < rays; ++i) {
    const double x = SIDE * (3.0 * i / rays - 1);
    double normal[3], d[3];
    const double power = taken(sun, -w->x_height * w->x_number * sin(w->x_number * x), 0, index, normal);
    refracted(sun, normal, index, d);
    const double at = x + d[0] / -d[1] * (wave_height(x, 0, w) - height);
    const int bin = (int)floor(at / SIDE * BINS);
    if (bin >= 0 && bin < BINS) sharp[bin] += power * 3 * BINS / rays / -way[1];
    if (i > 1 && (at - before) * change < 0 && at > 0 && at < SIDE && count < 64) folds[count++] = at;
    if (i > 0) change = at - before;
    before = at;
  }
  for (int i = 0; i < BINS; ++i) {
    double sum = 0, all = 0;
    for (int k = -20; k <= 20; ++k) {
      const double weight = exp(-0.5 * pow(k * SIDE / BINS / blur, 2));
      if (i + k < 0 || i + k >= BINS) continue;
      sum += weight * sharp[i + k];
      all += weight;
    }
    bins[i] = sum / all;
  }
  return count;
}

// The same of the map, along a stripe of a plane.
static void profile(const FieldBench *b, const float *light, double height, const double z[2], double bins[BINS]) {
  const int across = 40, along = 1;
  memset(bins, 0, BINS * sizeof *bins);
  for (int i = 0; i < BINS * along * across; ++i) {
    double rgb[3];
    const int bin = i / (along * across);
    const double p[3] = {SIDE * (bin + (i % along + 0.5) / along) / BINS, height,
                         z[0] + (z[1] - z[0]) * (i / along % across + 0.5) / across};
    field_light_at(b, light, p, rgb);
    bins[bin] += rgb[0] / (along * across);
  }
}

// Where the profile is highest near x.
static double peak_near(const double bins[BINS], double x) {
  const int middle = (int)(x / SIDE * BINS), reach = 10;
  int best = middle;
  for (int i = middle - reach; i <= middle + reach; ++i) {
    if (i >= 0 && i < BINS && bins[i] > bins[best]) best = i;
  }
  return (best + 0.5) / BINS * SIDE;
}

static double difference(const double a[BINS], const double b[BINS]) {
  double sum = 0, all = 0;
  for (int i = BINS / 10; i < BINS - BINS / 10; ++i) {
    sum += fabs(a[i] - b[i]);
    all += b[i];
  }
  return sum / all;
}

// Bright lines at the folds of the traced light, and the same light everywhere, on a plane at a height under the wave.
static void expect_focus(FieldBench *b, const Wave *w, double elevation, double height, int least_folds,
                         double most_difference) {
  double sun[3], want[BINS], got[BINS], folds[64], worst = 0, far = 0;
  const double z[2] = {0.9, 1.1};
  set_sun(b, elevation, 0, sun);
  TestField f = wave_field(w);
  float *light = field_bench_light(b, &f);
  // A pixel, the weights 1 2 1 of its neighbours, and the way between pixels' middles.
  const double pixel = (double)b->caustics.extent[0] / b->caustics.light.width,
               blur = pixel * sqrt(1.0 / 12 + 0.5 + 1.0 / 6);
  const int count = trace_wave(w, sun, (double)b->settings.refractive_index, height, blur, want, folds);
  profile(b, light, height, z, got);
  int compared = 0;
  for (int i = 0; i < count; ++i) {
    if (folds[i] < 0.2 || folds[i] > SIDE - 0.2) continue;
    const double peak = peak_near(got, folds[i]);
    worst = fmax(worst, fabs(peak - peak_near(want, folds[i])));
    far = fmax(far, fabs(peak - folds[i]));
    ++compared;
  }
  print_message(
      "%.2f m below, sun at %.0f degrees: %d folds, lines %.1f mm from the traced ones at most, %.1f mm from the "
      "folds (a pixel is %.1f mm); light differs by %.1f %%\n",
      w->level - height, elevation, compared, 1e3 * worst, 1e3 * far, 1e3 * pixel, 100 * difference(got, want));
  assert_true(compared >= least_folds);
  assert_true(worst < 2 * pixel && far < 3 * pixel);
  assert_true(difference(got, want) < most_difference);
  free(light);
  test_field_destroy(&f);
}

// A wave's crest is a lens with a radius of curvature of 1/(A k²), 1/7.4 m here, and focuses n/(n − 1) times as far down.
static void test_focus(void **state) {
  FieldBench *b = *state;
  const double height = 0.03, number = 5 * 360 * deg / SIDE;
  const double focus = 1.333 / 0.333 / (height * number * number);
  print_message("focus %.2f m below a crest\n", focus);
  reset(b);
  const Wave before = {0.5 * focus, height, number, 0, 0}, beyond = {1.6 * focus, height, number, 0, 0};
  expect_focus(b, &before, 90, 0, 0, 0.04);
  expect_focus(b, &before, 60, 0, 0, 0.04);
  expect_focus(b, &beyond, 90, 0, 6, 0.12);
  expect_focus(b, &beyond, 60, 0, 6, 0.12);
}

// ---- Solids ----------------------------------------------------------------------------------------------------------

static SimObstacle box_at(float x, float y, float z, float width, float height) {
  return (SimObstacle){
      .shape = SIM_BOX, .size = {width, height, width}, .position = {x, y, z}, .rotation = {0, 0, 0, 1}};
}

// Height along the map's axis of what the refracted sun sees first over a point; that of the point.
static double solid_over(FieldBench *b, const double p[3], double *own) {
  const int32_t size = b->caustics.solid.width;
  float *solid = malloc(sizeof *solid * (size_t)size * (size_t)size);
  gpu_texture_read(&b->caustics.solid, solid);
  double at[2] = {(double)b->caustics.u[3], (double)b->caustics.v[3]};
  *own = 0;
  for (int k = 0; k < 3; ++k) {
    at[0] += p[k] * (double)b->caustics.u[k];
    at[1] += p[k] * (double)b->caustics.v[k];
    *own -= p[k] * (double)b->caustics.way[k];
  }
  const double height = (double)solid[(int32_t)(at[1] * size) * size + (int32_t)(at[0] * size)];
  free(solid);
  return height;
}

// On a table in the water the wave is in focus where it is at its depth, not at the floor's.
static void test_light_on_solid(void **state) {
  FieldBench *b = *state;
  const double height = 0.03, number = 5 * 360 * deg / SIDE, focus = 1.333 / 0.333 / (height * number * number);
  const SimObstacle table = box_at(1, 0.5f, 1, 1.9f, 0.1f);
  const double top = 0.55;
  reset(b);
  b->frame.obstacle_count = 1;
  b->frame.obstacles = &table;
  const Wave before = {top + 0.5 * focus, height, number, 0, 0}, beyond = {top + 1.6 * focus, height, number, 0, 0};
  expect_focus(b, &before, 90, top, 0, 0.04);
  expect_focus(b, &before, 75, top, 0, 0.05);
  expect_focus(b, &beyond, 90, top, 6, 0.12);
}

static void test_shadows_in_water(void **state) {
  FieldBench *b = *state;
  const Wave level = {.level = 0.8};
  const SimObstacle boxes[] = {box_at(1, 0.4f, 1, 0.3f, 0.1f), box_at(0.4f, 1.1f, 0.4f, 0.3f, 0.1f)};
  double sun[3], way[3], rgb[3], own;
  reset(b);
  set_sun(b, 55, 25, sun);
  b->frame.obstacle_count = 2;
  b->frame.obstacles = boxes;
  TestField f = wave_field(&level);
  float *light = field_bench_light(b, &f);
  refracted(sun, (double[3]){0, 1, 0}, 1.333, way);
  const double clear = (double)b->caustics.level_light;

  // On the box in the water, on the floor behind it, and beside that.
  const double top[3] = {1, 0.45, 1}, behind[3] = {1 - way[0] / way[1] * 0.45, 0, 1 - way[2] / way[1] * 0.45};
  const double beside[3] = {behind[0], 0, behind[2] + 0.4};
  field_light_at(b, light, top, rgb);
  assert_true(fabs(rgb[0] / clear - 1) < 0.01);
  assert_true(fabs(solid_over(b, top, &own) - own) < 2e-3);
  assert_true(solid_over(b, behind, &own) > own + 0.3);
  assert_true(solid_over(b, beside, &own) < own - 0.3);
  field_light_at(b, light, beside, rgb);
  assert_true(fabs(rgb[0] / clear - 1) < 0.01);

  // The box over the water darkens the surface, and the floor where that light would have come.
  const double to_surface = (1.1 - 0.8) / sun[1];
  const double dark[3] = {0.4 - sun[0] * to_surface - way[0] / way[1] * 0.8, 0,
                          0.4 - sun[2] * to_surface - way[2] / way[1] * 0.8};
  field_light_at(b, light, dark, rgb);
  assert_true(rgb[0] < 0.01 * clear);
  assert_true(solid_over(b, dark, &own) < own - 0.3); // but it is no solid in the water

  // Without shadows light goes through.
  b->settings.shadow = false;
  free(light);
  light = field_bench_light(b, &f);
  field_light_at(b, light, dark, rgb);
  assert_true(fabs(rgb[0] / clear - 1) < 0.01);
  free(light);
  test_field_destroy(&f);
}

// ---- Colours ---------------------------------------------------------------------------------------------------------

// Water in one small place.
static double patch(double x, double z, const void *context) {
  return hypot(x - 1, z - 1) < 0.105 ? *(const double *)context : NAN;
}

// Light of every colour goes where its own index sends it: red is bent least and lands farthest from the plumb line.
static void test_dispersion(void **state) {
  FieldBench *b = *state;
  const double level = 0.7;
  double sun[3];
  reset(b);
  set_sun(b, 35, 0, sun);
  b->settings.heightfield.dispersion = 0.08f;
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, patch, &level);
  float *light = field_bench_light(b, &f);
  double sum[3] = {0}, moment[3] = {0};
  for (int i = 0; i < 400; ++i) {
    for (int k = 0; k < 100; ++k) {
      double rgb[3];
      const double p[3] = {SIDE * i / 400, 0, 0.8 + 0.004 * k};
      field_light_at(b, light, p, rgb);
      for (int c = 0; c < 3; ++c) {
        sum[c] += rgb[c];
        moment[c] += rgb[c] * p[0];
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    const double sine = cos(35 * deg) / (1.333 + 0.04 * (c - 1)), shift = level * sine / sqrt(1 - sine * sine);
    const double got = 1 - moment[c] / sum[c];
    print_message("colour %d: %.4f m aside, want %.4f\n", c, got, shift);
    assert_true(fabs(got - shift) < 2e-3);
  }
  free(light);
  test_field_destroy(&f);
}

// ---- Degenerate scenes -----------------------------------------------------------------------------------------------

// Is every value finite? Returns the sum of the light.
static double light_sum(FieldBench *b, const TestField *f) {
  float *light = field_bench_light(b, f);
  double sum = 0;
  for (size_t i = 0; i < 4 * (size_t)b->caustics.light.width * (size_t)b->caustics.light.height; ++i) {
    assert_true(isfinite(light[i]) && light[i] >= 0);
    sum += (double)light[i];
  }
  const RenderCausticsBlock block = render_caustics_block(&b->caustics, &b->picture);
  const float *values = (const float *)&block;
  for (size_t i = 0; i < sizeof block / sizeof *values; ++i) assert_true(isfinite(values[i]));
  assert_true(block.way[1] < 0); // shaders divide by it
  assert_int_equal(strstr(render_caustics_defines(&b->caustics), "UNTRACED") == NULL, b->caustics.drawn);
  free(light);
  return sum;
}

static void test_no_sun(void **state) {
  FieldBench *b = *state;
  const Wave level = {.level = 0.5};
  const double elevations[] = {-90, -30, 0};
  double sun[3];
  TestField f = wave_field(&level);
  reset(b);
  b->settings.sun = false;
  assert_true(light_sum(b, &f) == 0 && !b->caustics.drawn && b->caustics.level_light == 0);
  for (int i = 0; i < 3; ++i) {
    reset(b);
    set_sun(b, elevations[i], 10, sun);
    assert_true(light_sum(b, &f) == 0 && !b->caustics.drawn && b->caustics.level_light == 0);
  }
  reset(b);
  b->settings.heightfield.traced_caustics = false;
  assert_true(light_sum(b, &f) == 0 && !b->caustics.drawn && b->caustics.level_light > 0.5f);
  test_field_destroy(&f);
}

static double constant(double x, double z, const void *context) {
  return x + z > 1e9 ? 0 : *(const double *)context;
}

static void test_no_water(void **state) {
  FieldBench *b = *state;
  const double dry = NAN, level = 0.5;
  const TestField none = {.heights = NULL};
  reset(b);
  assert_true(light_sum(b, &none) == 0 && !b->caustics.drawn);
  TestField f = test_field_create(20, 10, SPACING, 0, 0, constant, &dry);
  assert_true(light_sum(b, &f) == 0 && !b->caustics.drawn);
  test_field_destroy(&f);
  const int32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 9}, {2, 2}};
  for (int i = 0; i < 4; ++i) {
    f = test_field_create(sizes[i][0], sizes[i][1], SPACING, 0, 0, constant, &level);
    light_sum(b, &f);
    assert_true(b->caustics.drawn);
    test_field_destroy(&f);
  }
}

// Surfaces like needles, floors far away and above the water, liquids that bend nothing.
static double needles(double x, double z, const void *context) {
  return 0.5 + *(const double *)context * sin(1e4 * x + 7e4 * z);
}

static void test_absurd_water(void **state) {
  FieldBench *b = *state;
  const double heights[] = {0.4, 1000};
  const float floors[] = {0, -1e5f, 3}, indices[] = {1, 1.333f, 3};
  double sun[3];
  for (int i = 0; i < 18; ++i) {
    reset(b);
    set_sun(b, i % 2 == 0 ? 2 : 90, 10, sun);
    b->settings.floor_level = floors[i / 2 % 3];
    b->settings.refractive_index = indices[i / 6];
    b->settings.heightfield.dispersion = 0.5f;
    TestField f = test_field_create(30, 20, SPACING, 0, 0, needles, &heights[i % 2]);
    light_sum(b, &f);
    test_field_destroy(&f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_no_sun),
      cmocka_unit_test(test_no_water),
      cmocka_unit_test(test_absurd_water),
      cmocka_unit_test(test_level_water),
      cmocka_unit_test(test_waves_conserve_light),
      cmocka_unit_test(test_focus),
      cmocka_unit_test(test_light_on_solid),
      cmocka_unit_test(test_shadows_in_water),
      cmocka_unit_test(test_dispersion),
  };
  return cmocka_run_group_tests(tests, field_bench_open, field_bench_close);
}
