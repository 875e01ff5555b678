// Sunlight at points in and around the water of a height field, as shaders that light floor and solids get it.
#include "tests/render/fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NODES 51
#define SPACING 0.04f
#define SIDE 2.0  // m, of the field
#define LEVEL 0.8 // m
#define ACROSS 80 // points along x and along z
#define REACH 3.0 // m, of the square of points around the field's middle

// A square of points at one height, with the light that comes to each.
static const char probe[] = "#include \"frame.glsl\"\n"
                            "#include \"screen.glsl\"\n"
                            "#ifdef FRAGMENT_STAGE\n"
                            "layout(std140, binding = 1) uniform Params { vec4 corner, stride; };\n"
                            "#include \"sun.glsl\"\n"
                            "layout(location = 0) out vec4 direct;\n"
                            "layout(location = 1) out vec4 way;\n"
                            "layout(location = 2) out vec4 more;\n"
                            "void main() {\n"
                            "  vec2 at = floor(gl_FragCoord.xy);\n"
                            "  SunLight light = sun_light(corner.xyz + vec3(at.x, 0.0, at.y) * stride.x);\n"
                            "  direct = vec4(light.direct, light.focus);\n"
                            "  way = vec4(light.way, light.path);\n"
                            "  more = vec4(light.diffuse, light.below);\n"
                            "}\n"
                            "#endif\n";

typedef struct Probe {
  FieldBench *bench;
  GpuSource *sources; // the renderer's, and the probe
  GpuProgram program;
  GpuTexture texture[3];
  GpuTarget target;
  GpuBuffer pool;
  float values[3][4 * ACROSS * ACROSS];
} Probe;

static int open_probe(void **state) {
  Probe *p = calloc(1, sizeof *p);
  RenderError error = {0};
  void *bench;
  field_bench_open(&bench);
  p->bench = bench;
  size_t count = 0;
  while (gpu_sources[count].name != NULL) ++count;
  p->sources = calloc(count + 2, sizeof *p->sources);
  memcpy(p->sources, gpu_sources, count * sizeof *p->sources);
  p->sources[count] = (GpuSource){"probe.glsl", probe};
  const GpuTextureDesc desc = {"probe", ACROSS, ACROSS, GPU_RGBA32F, false};
  for (int i = 0; i < 3; ++i) assert_true(gpu_texture_create(&p->texture[i], &desc, &error));
  const GpuTargetDesc target = {"probe", {&p->texture[0], &p->texture[1], &p->texture[2]}, NULL};
  assert_true(gpu_target_create(&p->target, &target, &error));
  *state = p;
  return 0;
}

static int close_probe(void **state) {
  Probe *p = *state;
  void *bench = p->bench;
  gpu_program_destroy(&p->program);
  for (int i = 0; i < 3; ++i) gpu_texture_destroy(&p->texture[i]);
  gpu_target_destroy(&p->target);
  gpu_buffer_destroy(&p->pool);
  free(p->sources);
  free(p);
  return field_bench_close(&bench);
}

// ---- Scenes ----------------------------------------------------------------------------------------------------------

static double level_height(double x, double z, const void *context) {
  const double dry = *(const double *)context; // where x is more
  return z < -1e9 || x > dry ? NAN : LEVEL;
}

static void reset(FieldBench *b) {
  b->settings = render_default_settings();
  b->settings.floor_level = 0;
  const float sun[3] = {0.5f, 0.8f, -0.3f};
  memcpy(b->settings.sun_direction, sun, sizeof sun);
  b->frame =
      (SimFrame){.has_container = true, .container = {{0, 0, 0}, {(float)SIDE, 1, (float)SIDE}, SIM_CONTAINER_BOX}};
}

// The maps of a field, and the light at the points of the square at `height`.
static void light_points(Probe *p, const TestField *f, double height) {
  FieldBench *b = p->bench;
  RenderError error = {0};
  char defines[512];
  free(field_bench_light(b, f));
  snprintf(defines, sizeof defines, "%s%s", b->picture.defines, render_caustics_defines(&b->caustics));
  const GpuProgramDesc desc = {.label = "probe", .file = "probe.glsl", .defines = defines, .sources = p->sources};
  if (!gpu_program_prepare(&p->program, &desc, &error)) fail_msg("%s", error.message);
  struct {
    RenderHeightBlock height;
    RenderCausticsBlock caustics;
    float rest[1024]; // what the style adds
  } pool = {.height = render_height_block(&b->map), .caustics = render_caustics_block(&b->caustics, &b->picture)};
  assert_true(gpu_buffer_write(&p->pool, "pool", &pool, sizeof pool, &error));
  const float low = (float)(0.5 * SIDE - 0.5 * REACH), stride = (float)(REACH / ACROSS);
  const float params[8] = {low + 0.5f * stride, (float)height, low + 0.5f * stride, 0, stride};
  gpu_draw(&b->gpu, &(GpuDraw){.program = &p->program,
                               .target = &p->target,
                               .in = {.textures = {[3] = &b->map.surface,
                                                   &b->caustics.light,
                                                   &b->picture.sun_map.normal,
                                                   &b->picture.sun_map.water,
                                                   &b->picture.sun_map.solid,
                                                   NULL,
                                                   &b->caustics.solid},
                                      .storage = {[6] = &p->pool},
                                      .frame = &b->picture.uniforms,
                                      .params = params,
                                      .params_size = sizeof params}});
  for (int i = 0; i < 3; ++i) gpu_texture_read(&p->texture[i], p->values[i]);
}

static double place(int i) {
  return 0.5 * SIDE + REACH * ((i + 0.5) / ACROSS - 0.5);
}

// Is a place well within the field, or well outside? Neither next to its border.
static bool inside(double x, double z, double margin) {
  return fmin(x, z) > margin && fmax(x, z) < SIDE - margin;
}

static bool outside(double x, double z) {
  return !inside(x, z, -0.05);
}

static void expect_near(float got, double want, double margin) {
  if (!(fabs((double)got - want) < margin)) fail_msg("%g instead of %g", (double)got, want);
}

// As without water.
static void expect_dry(const Probe *p, int point) {
  const float *sun = p->bench->picture.block.sun_direction;
  for (int k = 0; k < 3; ++k) {
    expect_near(p->values[0][4 * point + k], 1, 1e-6);
    expect_near(p->values[1][4 * point + k], (double)sun[k], 1e-6);
    expect_near(p->values[2][4 * point + k], 1, 1e-6);
  }
  expect_near(p->values[0][4 * point + 3], 1, 1e-6);
}

// What level water sends down to a depth.
static void expect_wet(const Probe *p, int point, double depth, double margin) {
  const FieldBench *b = p->bench;
  const double path = depth / -(double)b->caustics.way[1];
  for (int k = 0; k < 3; ++k) {
    const double lost = (double)b->settings.absorption[k] + (double)b->settings.scattering[k];
    const double light = (double)b->caustics.level_light * exp(-lost * path);
    expect_near(p->values[0][4 * point + k], light, margin * light);
    expect_near(p->values[1][4 * point + k], -(double)b->caustics.way[k], 1e-4);
    expect_near(p->values[2][4 * point + k], exp(-0.7 * (double)b->settings.absorption[k] * path), 1e-4);
  }
  expect_near(p->values[1][4 * point + 3], path, 1e-4);
}

// ---- Level water -----------------------------------------------------------------------------------------------------

// Traced or not, it is lit the same everywhere, right up to the walls; outside and above it is as without water.
static void test_level_water(void **state) {
  Probe *p = *state;
  const double dry = 1e9, heights[] = {0, 0.5, LEVEL + 0.01};
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &dry);
  for (int i = 0; i < 6; ++i) {
    reset(p->bench);
    p->bench->settings.heightfield.traced_caustics = i < 3;
    light_points(p, &f, heights[i % 3]);
    int wet = 0;
    for (int k = 0; k < ACROSS * ACROSS; ++k) {
      const double x = place(k % ACROSS), z = place(k / ACROSS);
      if (i % 3 < 2 && inside(x, z, 1e-3)) {
        expect_wet(p, k, LEVEL - heights[i % 3], 2e-3);
        ++wet;
      } else if (i % 3 == 2 || outside(x, z)) {
        expect_dry(p, k);
      }
    }
    assert_int_equal(wet > 2000, i % 3 < 2);
  }
  test_field_destroy(&f);
}

static double round_height(double x, double z, const void *context) {
  return hypot(x - 0.5 * SIDE, z - 0.5 * SIDE) < *(const double *)context ? LEVEL : NAN;
}

// A round container is lit from behind its wall as well, though there is no water there.
static void test_round_container(void **state) {
  Probe *p = *state;
  const double radius = 0.5 * SIDE;
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, round_height, &radius);
  reset(p->bench);
  p->bench->frame.container.shape = SIM_CONTAINER_GLASS;
  light_points(p, &f, 0);
  for (int k = 0; k < ACROSS * ACROSS; ++k) {
    const double far = hypot(place(k % ACROSS) - 0.5 * SIDE, place(k / ACROSS) - 0.5 * SIDE);
    if (far < 0.5 * SIDE - 1e-3) expect_wet(p, k, LEVEL, 2e-3);
    if (far > 0.5 * SIDE + 0.01) expect_dry(p, k);
  }
  test_field_destroy(&f);
}

// Water on one half of the field: the floor under it is lit through it as far as the refracted sunlight comes from its surface.
static void test_half_dry(void **state) {
  Probe *p = *state;
  const double edge = 1;
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &edge);
  reset(p->bench);
  light_points(p, &f, 0);
  const float *way = p->bench->caustics.way;
  const double shadow = edge - LEVEL * (double)way[0] / (double)way[1]; // where its edge's light comes to the floor
  for (int k = 0; k < ACROSS * ACROSS; ++k) {
    const double x = place(k % ACROSS), z = place(k / ACROSS);
    if (!inside(x, z, 0.01)) continue;
    if (x < shadow - 0.06) expect_wet(p, k, LEVEL, 5e-3);
    if (x > shadow + 0.08) expect_dry(p, k);
    for (int c = 0; c < 3; ++c) assert_true(p->values[0][4 * k + c] > 0 && p->values[0][4 * k + c] < 1.01f);
  }
  test_field_destroy(&f);
}

// ---- Shadows ---------------------------------------------------------------------------------------------------------

static void test_shadow_of_ball(void **state) {
  Probe *p = *state;
  FieldBench *b = p->bench;
  const double dry = 1e9, radius = 0.15, centre[3] = {1, 0.4, 1};
  const SimObstacle ball = {
      .shape = SIM_SPHERE, .size = {2 * (float)radius}, .position = {1, 0.4f, 1}, .rotation = {0, 0, 0, 1}};
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &dry);
  reset(b);
  b->frame.obstacle_count = 1;
  b->frame.obstacles = &ball;
  light_points(p, &f, 0);
  int dark = 0;
  for (int k = 0; k < ACROSS * ACROSS; ++k) {
    const double x = place(k % ACROSS), z = place(k / ACROSS);
    if (!inside(x, z, 0.01)) continue;
    // Distance of the ball's middle from the refracted sunlight to the point.
    const double to[3] = {centre[0] - x, centre[1], centre[2] - z};
    double along = 0, far = 0;
    for (int c = 0; c < 3; ++c) along += to[c] * (double)b->caustics.way[c];
    for (int c = 0; c < 3; ++c) far += pow(to[c] - along * (double)b->caustics.way[c], 2);
    if (sqrt(far) < radius - 0.02) {
      assert_true(p->values[0][4 * k] < 1e-3f);
      ++dark;
    }
    if (sqrt(far) > radius + 0.02) expect_wet(p, k, LEVEL, 0.02);
  }
  assert_true(dark > 30);
  test_field_destroy(&f);
}

// A ball over the water darkens what its shadow on the surface lets no light down to, with and without a map of light.
static void test_shadow_from_above(void **state) {
  Probe *p = *state;
  FieldBench *b = p->bench;
  const double dry = 1e9, radius = 0.15, height = 1.4;
  const SimObstacle ball = {
      .shape = SIM_SPHERE, .size = {2 * (float)radius}, .position = {1, (float)height, 1}, .rotation = {0, 0, 0, 1}};
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &dry);
  for (int traced = 0; traced < 2; ++traced) {
    reset(b);
    b->settings.heightfield.traced_caustics = traced;
    b->frame.obstacle_count = 1;
    b->frame.obstacles = &ball;
    light_points(p, &f, 0);
    const float *way = b->caustics.way, *sun = b->picture.block.sun_direction;
    int dark = 0, lit = 0;
    for (int k = 0; k < ACROSS * ACROSS; ++k) {
      const double x = place(k % ACROSS), z = place(k / ACROSS);
      if (!inside(x, z, 0.01)) continue;
      // Back to where the light came through the surface, and on towards the sun.
      const double back = LEVEL / (double)way[1],
                   from[3] = {x + back * (double)way[0], LEVEL, z + back * (double)way[2]};
      const double to[3] = {1 - from[0], height - from[1], 1 - from[2]};
      double along = 0, far = 0;
      for (int c = 0; c < 3; ++c) along += to[c] * (double)sun[c];
      for (int c = 0; c < 3; ++c) far += pow(to[c] - along * (double)sun[c], 2);
      if (sqrt(far) < radius - 0.04) {
        assert_true(p->values[0][4 * k] < 0.02f);
        ++dark;
      }
      if (sqrt(far) > radius + 0.04) {
        expect_wet(p, k, LEVEL, 0.02);
        ++lit;
      }
    }
    assert_true(dark > 20 && lit > 1000);
  }
  test_field_destroy(&f);
}

// ---- Simple caustics -------------------------------------------------------------------------------------------------

static void test_simple_caustics(void **state) {
  Probe *p = *state;
  const double dry = 1e9;
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &dry);
  for (int traced = 0; traced < 2; ++traced) {
    reset(p->bench);
    RenderHeightfield *settings = &p->bench->settings.heightfield;
    settings->simple_caustics = true;
    settings->traced_caustics = traced;
    settings->simple_height = 0.4f;
    settings->simple_base = 0.9f;
    light_points(p, &f, 0);
    const int middle = ACROSS / 2 * ACROSS + ACROSS / 2;
    expect_wet(p, middle, LEVEL, 2e-3);
    expect_near(p->values[0][4 * middle + 3], 0.4 * 0.5 + 0.9,
                1e-4); // calm water is half way between lowest and highest
    expect_dry(p, 0);
  }
  test_field_destroy(&f);
}

static double ramp(double x, double z, const void *context) {
  return LEVEL + *(const double *)context * (x - 1) + 0 * z;
}

// Eq. 4 of the surface above the point along the refracted sunlight.
static void test_simple_slope(void **state) {
  Probe *p = *state;
  const double slope = 0.2;
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, ramp, &slope);
  reset(p->bench);
  RenderHeightfield *settings = &p->bench->settings.heightfield;
  settings->simple_caustics = true;
  light_points(p, &f, 0);
  const float *way = p->bench->caustics.way;
  const int i = ACROSS / 3, k = ACROSS / 2;
  const double run = -(double)way[0] / (double)way[1]; // m that the light moves along x on a metre downwards
  double at = place(i);
  for (int n = 0; n < 50; ++n) at = place(i) - run * (LEVEL + slope * (at - 1));
  const double height = (at - 0) / SIDE, nx = slope / sqrt(1 + slope * slope);
  expect_near(p->values[0][4 * (k * ACROSS + i) + 3], 0.6 * height + 2 * nx + 0.6, 0.01);
  test_field_destroy(&f);
}

// ---- Degenerate scenes -----------------------------------------------------------------------------------------------

static void test_no_sun(void **state) {
  Probe *p = *state;
  const double dry = 1e9, no_water = -1;
  TestField f = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &dry);
  TestField none = test_field_create(NODES, NODES, SPACING, 0, 0, level_height, &no_water);
  reset(p->bench);
  p->bench->settings.sun_direction[1] = -0.5f;
  light_points(p, &f, 0.2);
  const int middle = ACROSS / 2 * ACROSS + ACROSS / 2;
  for (int k = 0; k < 3; ++k) expect_near(p->values[0][4 * middle + k], 0, 1e-6);
  reset(p->bench);
  light_points(p, &none, -0.2);
  for (int k = 0; k < ACROSS * ACROSS; ++k) expect_dry(p, k);
  const TestField no_field = {.heights = NULL};
  light_points(p, &no_field, -0.2);
  for (int k = 0; k < ACROSS * ACROSS; ++k) expect_dry(p, k);
  test_field_destroy(&f);
  test_field_destroy(&none);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_no_sun),          cmocka_unit_test(test_level_water),
      cmocka_unit_test(test_round_container), cmocka_unit_test(test_half_dry),
      cmocka_unit_test(test_shadow_of_ball),  cmocka_unit_test(test_shadow_from_above),
      cmocka_unit_test(test_simple_caustics), cmocka_unit_test(test_simple_slope),
  };
  return cmocka_run_group_tests(tests, open_probe, close_probe);
}
