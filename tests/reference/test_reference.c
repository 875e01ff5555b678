// The reference ray tracer against answers worked out on paper: spheres of water, and a flat layer, which is a sphere so
// large (100 km) that within a metre it is level to 5 micrometres.
#include "tests/reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/harness.h"

#define PI 3.14159265358979323846
#define INDEX 1.333
// The weight below which branches of the tree are cut, and some.
#define CUT 2e-4

// ---- Scenes ----------------------------------------------------------------------------------------------------------

typedef struct Balls {
  float position[3 * 4], radius[4];
  SimFrame frame;
} Balls;

static Balls *balls_create(int count, const float position[], const float radius[]) {
  Balls *balls = calloc(1, sizeof *balls);
  memcpy(balls->position, position, 3 * (size_t)count * sizeof(float));
  memcpy(balls->radius, radius, (size_t)count * sizeof(float));
  balls->frame =
      (SimFrame){.count = count, .particle_radius = 0.1f, .position = balls->position, .radius = balls->radius};
  return balls;
}

static Reference *reference_of_balls(int count, const float position[], const float radius[],
                                     const RenderSettings *settings) {
  Balls *balls = balls_create(count, position, radius);
  Reference *reference = reference_create(&balls->frame, settings);
  assert_non_null(reference);
  free(balls);
  return reference;
}

/// Water from y = 0 to LAYER over the checker.
#define LAYER 0.5
static Reference *layer_create(const RenderSettings *settings) {
  return reference_of_balls(1, (float[]){0, -99999.5f, 0}, (float[]){1e5f}, settings);
}

static RenderSettings sky_only(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  for (int k = 0; k < 3; ++k) {
    settings.sky_horizon[k] = 0.1f + 0.2f * (float)k;
    settings.sky_zenith[k] = 0.9f - 0.3f * (float)k;
  }
  return settings;
}

static double sky(const RenderSettings *s, int channel, double up) {
  const double h = (double)s->sky_horizon[channel], z = (double)s->sky_zenith[channel];
  return up > 0 ? h + (z - h) * up : h;
}

static double fresnel(double degrees_in_air) {
  const double f0 = pow((INDEX - 1) / (INDEX + 1), 2);
  return f0 + (1 - f0) * pow(1 - cos(degrees_in_air * PI / 180), 5);
}

static double absorbed(const RenderSettings *s, int channel, double length) {
  return exp(-(double)s->absorption[channel] * length);
}

static bool checker_is_even(const RenderSettings *s, double x, double z) {
  const long sum = lround(floor(x / (double)s->tile_size) + floor(z / (double)s->tile_size));
  return sum % 2 == 0;
}

// ---- One ray through plates ------------------------------------------------------------------------------------------

/// What a body lets through and throws back that a ray crosses twice at right angles, over `length` of water, with all
/// inner reflections: geometric series.
typedef struct Plate {
  double through, back;
} Plate;

static Plate plate_of(double length, double absorption) {
  const double f = fresnel(0), t = exp(-absorption * length), series = 1 / (1 - f * f * t * t);
  return (Plate){(1 - f) * (1 - f) * t * series, f + (1 - f) * (1 - f) * f * t * t * series};
}

static void check_straight(const Reference *reference, const RenderSettings *s, const double origin[3],
                           Plate plates[3]) {
  const double up[3] = {0.6, 0.8, 0};
  double rgb[3];
  reference_ray(reference, origin, up, 0, rgb);
  for (int k = 0; k < 3; ++k) {
    const double expected = plates[k].through * sky(s, k, 0.8) + plates[k].back * sky(s, k, -0.8);
    assert_float_equal(rgb[k], expected, CUT);
  }
}

static void test_centre_of_sphere(void **state) {
  (void)state;
  const RenderSettings s = sky_only();
  Reference *reference = reference_of_balls(1, (float[]){3, 4, 0}, (float[]){0.25f}, &s);
  Plate plates[3];
  for (int k = 0; k < 3; ++k) plates[k] = plate_of(0.5, (double)s.absorption[k]);
  check_straight(reference, &s, (double[]){0, 0, 0}, plates);
  reference_destroy(reference);
}

static void test_two_spheres_in_line(void **state) {
  (void)state;
  const RenderSettings s = sky_only();
  Reference *reference = reference_of_balls(2, (float[]){3, 4, 0, 6, 8, 0}, (float[]){0.25f, 0.25f}, &s);
  Plate plates[3];
  for (int k = 0; k < 3; ++k) {
    const Plate one = plate_of(0.5, (double)s.absorption[k]);
    const double series = 1 / (1 - one.back * one.back);
    plates[k] = (Plate){one.through * one.through * series, one.back + one.through * one.through * one.back * series};
  }
  check_straight(reference, &s, (double[]){0, 0, 0}, plates);
  reference_destroy(reference);
}

static void test_overlap_has_no_inner_surface(void **state) {
  (void)state;
  const RenderSettings s = sky_only();
  // Along (0.6, 0.8, 0): the first from 4.75 to 5.25, the second from 5 to 5.5; then with one inside the first.
  Reference *pair = reference_of_balls(2, (float[]){3, 4, 0, 3.15f, 4.2f, 0}, (float[]){0.25f, 0.25f}, &s);
  Reference *nested = reference_of_balls(2, (float[]){3, 4, 0, 3.03f, 4.04f, 0}, (float[]){0.25f, 0.1f}, &s);
  Plate plates[3];
  for (int k = 0; k < 3; ++k) plates[k] = plate_of(0.75, (double)s.absorption[k]);
  check_straight(pair, &s, (double[]){0, 0, 0}, plates);
  for (int k = 0; k < 3; ++k) plates[k] = plate_of(0.5, (double)s.absorption[k]);
  check_straight(nested, &s, (double[]){0, 0, 0}, plates);
  reference_destroy(pair);
  reference_destroy(nested);
}

// ---- Off the centre --------------------------------------------------------------------------------------------------

// A ray upwards beside the axis: refracted twice it has turned by 2 (θi − θt), reflected at once by 180° − 2 θi, reflected
// at the back by θi − θt + 180° − 2 θt. Both Fresnel terms are the same, as the angle in air is.
static void test_off_centre(void **state) {
  (void)state;
  RenderSettings s = sky_only();
  s.sky_horizon[0] = 0; // red: the height of the direction alone
  s.sky_zenith[0] = 1;
  Reference *reference = reference_of_balls(1, (float[]){0, 5, 0}, (float[]){0.5f}, &s);
  for (double in = 5; in < 90; in += 5) {
    const double out = asin(sin(in * PI / 180) / INDEX) * 180 / PI, f = fresnel(in);
    const double origin[3] = {0.5 * sin(in * PI / 180), 0, 0}, up[3] = {0, 2, 0};
    double rgb[3], two[3];
    reference_ray_chain(reference, origin, up, 2, two);
    reference_ray(reference, origin, up, 0, rgb);
    for (int k = 0; k < 3; ++k) {
      const double t = absorbed(&s, k, cos(out * PI / 180));
      const double first = sky(&s, k, cos((180 - 2 * in) * PI / 180));
      const double back = sky(&s, k, cos((in - 3 * out + 180) * PI / 180));
      const double ahead = sky(&s, k, cos(2 * (in - out) * PI / 180));
      assert_float_equal(two[k], f * first + (1 - f) * t * (f * back + (1 - f) * ahead), 1e-9);
      // The whole tree: the ray leaves after m inner reflections, each turning it by 180° − 2 θt.
      double light = f * first, weight = (1 - f) * (1 - f) * t;
      for (int m = 0; m < 12; ++m, weight *= f * t) {
        light += weight * sky(&s, k, cos((2 * (in - out) + m * (180 - 2 * out)) * PI / 180));
      }
      assert_float_equal(rgb[k], light, CUT);
    }
  }
  reference_destroy(reference);
}

// ---- A flat layer ----------------------------------------------------------------------------------------------------

static void test_layer_over_checker(void **state) {
  (void)state;
  RenderSettings s = harness_pinned_settings();
  s.tile_size = 0.01f; // fine, so that a wrong offset shows
  Reference *reference = layer_create(&s);
  int looked_at = 0;
  for (double in = 0; in < 85; in += 2.5) {
    for (double x = -0.5; x < 0.5; x += 0.0137) {
      const double a = in * PI / 180, out = asin(sin(a) / INDEX), top[3] = {x, LAYER, 0.005};
      const double origin[3] = {top[0] - sin(a), top[1] + cos(a), top[2]}, direction[3] = {sin(a), -cos(a), 0};
      const double floor_x = x + LAYER * tan(out), squares = floor_x / (double)s.tile_size;
      if (fabs(squares - round(squares)) < 0.01) continue; // on a line between squares
      double rgb[3];
      reference_ray(reference, origin, direction, 0, rgb);
      for (int k = 0; k < 3; ++k) {
        const double square = (double)s.floor_colour[checker_is_even(&s, floor_x, top[2]) ? 0 : 1][k];
        const double expected =
            fresnel(in) * sky(&s, k, cos(a)) + (1 - fresnel(in)) * absorbed(&s, k, LAYER / cos(out)) * square;
        assert_float_equal(rgb[k], expected, 1e-4);
      }
      ++looked_at;
    }
  }
  assert_true(looked_at > 1000);
  reference_destroy(reference);
}

// From 0.3 m below the surface: the sky within 48.6° of the vertical, outside of it the floor as in a mirror.
static void test_total_reflection(void **state) {
  (void)state;
  RenderSettings s = harness_pinned_settings();
  s.tile_size = 0.01f;
  Reference *reference = layer_create(&s);
  const double eye[3] = {0.003, LAYER - 0.3, 0.005};
  assert_true(reference_inside(reference, eye));
  for (double in_water = 1; in_water < 75; in_water += 0.5) {
    const double a = in_water * PI / 180, direction[3] = {sin(a), cos(a), 0}, path = 0.3 / cos(a),
                 down = LAYER / cos(a);
    const double floor_x = eye[0] + (path + down) * sin(a), squares = floor_x / (double)s.tile_size;
    if (fabs(squares - round(squares)) < 0.05) continue;
    double rgb[3];
    reference_ray(reference, eye, direction, 0, rgb);
    for (int k = 0; k < 3; ++k) {
      const double square = (double)s.floor_colour[checker_is_even(&s, floor_x, eye[2]) ? 0 : 1][k];
      const double mirror = absorbed(&s, k, path + down) * square;
      const bool total = INDEX * sin(a) > 1;
      const double out = total ? 90 : asin(INDEX * sin(a)) * 180 / PI, f = total ? 1 : fresnel(out);
      const double window = absorbed(&s, k, path) * sky(&s, k, cos(out * PI / 180));
      assert_float_equal(rgb[k], f * mirror + (1 - f) * window, 1e-4);
      assert_true(total == (in_water > 48.6));
    }
  }
  reference_destroy(reference);
}

// The chain of one refraction goes straight on at the first floor it meets, so on a layer it is the whole truth; the tree
// cut after no surface at all sees the environment only.
static void test_depth(void **state) {
  (void)state;
  const RenderSettings s = harness_pinned_settings();
  Reference *layer = layer_create(&s), *empty = reference_of_balls(0, (float[]){0}, (float[]){0}, &s);
  const double eye[3] = {0.1, 1, 0.1}, direction[3] = {0.3, -1, 0.2};
  double tree[3], one[3], none[3], air[3];
  reference_ray(layer, eye, direction, 0, tree);
  reference_ray_chain(layer, eye, direction, 1, one);
  reference_ray_chain(layer, eye, direction, 0, none);
  reference_ray(empty, eye, direction, 0, air);
  for (int k = 0; k < 3; ++k) {
    assert_float_equal(one[k], tree[k], 1e-12);
    assert_true(none[k] == air[k]);
  }
  assert_true(fabs(tree[0] - air[0]) > 0.1);
  reference_destroy(layer);
  reference_destroy(empty);
}

// ---- Without water ---------------------------------------------------------------------------------------------------

static void test_ray_that_misses(void **state) {
  (void)state;
  const RenderSettings s = harness_pinned_settings();
  Reference *reference = reference_of_balls(1, (float[]){0, 1, 0}, (float[]){0.25f}, &s);
  const double eye[3] = {0, 1, -2};
  double rgb[3];
  for (double slope = -0.9; slope < 0.95; slope += 0.1) {
    if (fabs(slope) < 0.15) continue; // there the ball is
    const double direction[3] = {0.1, slope, 1}, length = sqrt(1.01 + slope * slope);
    reference_ray(reference, eye, direction, 0, rgb);
    const double t = -1 / slope, x = 0.1 * t, z = t - 2;
    for (int k = 0; k < 3; ++k) {
      const double square = (double)s.floor_colour[checker_is_even(&s, x, z) ? 0 : 1][k];
      assert_float_equal(rgb[k], slope < 0 ? square : sky(&s, k, slope / length), 1e-12);
    }
  }
  reference_destroy(reference);
}

// Particles that are nowhere are not there; the others are as without them.
static void test_none_one_and_nan(void **state) {
  (void)state;
  const RenderSettings s = harness_pinned_settings();
  const RenderView view = harness_view(0.2f, 0.9f, -1.5f, 0, 0.5f, 0, 40);
  enum { W = 48, H = 32 };
  static float none[3 * W * H], one[3 * W * H], many[3 * W * H];
  static uint8_t covered[W * H];
  Reference *nobody = reference_of_balls(0, (float[]){0}, (float[]){0}, &s);
  Reference *single = reference_of_balls(1, (float[]){0, 0.5f, 0}, (float[]){0.2f}, &s);
  Reference *broken = reference_of_balls(4, (float[]){NAN, 0, 0, 0, 0.5f, 0, 0, INFINITY, 0, 0, 0.5f, -1},
                                         (float[]){0.2f, 0.2f, 0.2f, NAN}, &s);
  reference_trace(nobody, &view, W, H, 0, none);
  reference_trace(single, &view, W, H, 0, one);
  reference_trace(broken, &view, W, H, 0, many);
  reference_cover(single, &view, W, H, covered);
  assert_memory_equal(one, many, sizeof one);
  int water = 0;
  for (int i = 0; i < W * H; ++i) {
    water += covered[i];
    assert_true(covered[i] == (memcmp(&none[3 * i], &one[3 * i], 3 * sizeof(float)) != 0));
  }
  // A ball of 0.2 m at 1.56 m, 40° over 32 pixels: a circle of about 5.7 pixels radius.
  assert_in_range(water, 90, 115);
  reference_destroy(nobody);
  reference_destroy(single);
  reference_destroy(broken);
}

// Every pixel is the ray of the renderer's tests, to the last digit of a float.
static void test_pixels(void **state) {
  (void)state;
  const RenderSettings s = harness_pinned_settings();
  const RenderView view = harness_view(0.2f, 0.9f, -1.5f, 0, 0.5f, 0, 40);
  enum { W = 31, H = 20 };
  static float rgb[3 * W * H];
  Reference *reference = reference_of_balls(2, (float[]){0, 0.5f, 0, 0.2f, 0.4f, 0.3f}, (float[]){0.2f, 0.15f}, &s);
  reference_trace(reference, &view, W, H, 0, rgb);
  for (int y = 0; y < H; ++y) {
    for (int x = 0; x < W; ++x) {
      const Ray ray = harness_ray(&view, W, H, x, y);
      double expected[3];
      reference_ray(reference, ray.origin, ray.direction, 0, expected);
      for (int k = 0; k < 3; ++k) assert_float_equal(rgb[3 * (y * W + x) + k], expected[k], 1e-6);
    }
  }
  reference_destroy(reference);
}

// A picture taken inside a ball of water.
static void test_eye_in_water(void **state) {
  (void)state;
  const RenderSettings s = sky_only();
  Reference *reference = reference_of_balls(2, (float[]){0, 0, 0, 0, 0, 0.1f}, (float[]){0.5f, 0.3f}, &s);
  const double centre[3] = {0, 0, 0}, up[3] = {0, 1, 0}, outside[3] = {0, 0.51, 0};
  assert_true(reference_inside(reference, centre));
  assert_false(reference_inside(reference, outside));
  double rgb[3];
  reference_ray(reference, centre, up, 0, rgb);
  for (int k = 0; k < 3; ++k) {
    // Out at the top, or after inner reflections at the bottom and the top in turn.
    const double f = fresnel(0), half = absorbed(&s, k, 0.5), whole = half * half;
    double light = 0, weight = (1 - f) * half;
    for (int m = 0; m < 8; ++m, weight *= f * whole) light += weight * sky(&s, k, m % 2 == 0 ? 1 : -1);
    assert_float_equal(rgb[k], light, CUT);
  }
  reference_destroy(reference);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_centre_of_sphere),
      cmocka_unit_test(test_two_spheres_in_line),
      cmocka_unit_test(test_overlap_has_no_inner_surface),
      cmocka_unit_test(test_off_centre),
      cmocka_unit_test(test_layer_over_checker),
      cmocka_unit_test(test_total_reflection),
      cmocka_unit_test(test_depth),
      cmocka_unit_test(test_ray_that_misses),
      cmocka_unit_test(test_none_one_and_nan),
      cmocka_unit_test(test_pixels),
      cmocka_unit_test(test_eye_in_water),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
