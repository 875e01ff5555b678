// Water at rest, drawn: its tones are few and stay where they are from frame to frame, whatever holds it, wherever the sun is
// and however close the eye comes.
#include "sim/sim.h"
#include "tests/render/drawn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 240
#define HEIGHT 180
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define LEVEL 0.2f

// Two frames, 1/30 s apart, of a pool that was let go 4 s before.
typedef struct Pool {
  SimWorld *world;
  SimFrameBuffer *buffer[2];
  SimFrame frame[2];
} Pool;

static Pool pool_create(SimContainerShape shape) {
  Pool pool = {0};
  SimWorldDef def = sim_default_world_def();
  const SimContainer container = {{0, 0, 0}, {0.8f, 0.6f, shape == SIM_CONTAINER_GLASS ? 0.8f : 0.6f}, shape};
  SimBlockDef block = {.max = {container.max[0], LEVEL, container.max[2]}};
  def.particle_radius = RADIUS;
  def.container = container;
  def.block_count = 1;
  def.blocks = &block;
  def.jitter = 0.3f;
  def.threads = 1; // the same water for any number, and tests run side by side
  SimError error = {0};
  pool.world = sim_world_create(&def, &error);
  if (pool.world == NULL || !sim_world_advance(pool.world, 4, &error)) fail_msg("%s", error.message);
  for (int k = 0; k < 2; ++k) {
    pool.buffer[k] = sim_frame_buffer_create();
    const SimFrame *frame = sim_world_frame(pool.world, SIM_NEED_CLASS | SIM_NEED_SURFACE, pool.buffer[k], &error);
    if (frame == NULL) fail_msg("%s", error.message);
    pool.frame[k] = *frame;
    if (k == 0 && !sim_world_advance(pool.world, 1.0 / 30, &error)) fail_msg("%s", error.message);
  }
  // Two different frames, or nothing could flicker.
  assert_memory_not_equal(pool.frame[0].position, pool.frame[1].position,
                          sizeof(float) * 3 * (size_t)pool.frame[0].count);
  return pool;
}

static void pool_destroy(Pool *pool) {
  for (int k = 0; k < 2; ++k) sim_frame_buffer_destroy(pool->buffer[k]);
  sim_world_destroy(pool->world);
}

typedef struct Rest {
  int water, changed; // pixels
} Rest;

static Rest look(Harness *harness, const Pool *pool, const RenderView *view, const RenderSettings *settings) {
  float *tone[2];
  Rest rest = {0};
  for (int k = 0; k < 2; ++k) tone[k] = harness_layer(harness, "tone", 1, &pool->frame[k], view, settings);
  for (int i = 0; i < PIXELS; ++i) {
    rest.water += tone[0][i] > 0;
    rest.changed += tone[0][i] != tone[1][i];
    assert_true(tone[0][i] >= 0 && tone[0][i] <= 5 && tone[0][i] == floorf(tone[0][i]));
  }
  free(tone[0]);
  free(tone[1]);
  return rest;
}

// The body's colours, when it shows nothing but its own: few, and none between them but on the edges of tones.
static void expect_few_colours(Harness *harness, const SimFrame *frame, const RenderView *view) {
  enum { MOST = 3 };
  RenderSettings settings = drawn_settings();
  settings.cartoon.reflection = settings.cartoon.refraction = false;
  settings.cartoon.outline = 0;
  float *tone = harness_layer(harness, "tone", 1, frame, view, &settings);
  uint8_t *rgb = harness_draw(harness, frame, view, &settings), colours[MOST][3];
  int count = 0, pixels = 0;
  for (int i = WIDTH + 1; i < PIXELS - WIDTH - 1; ++i) {
    bool within = tone[i] >= 1 && tone[i] <= 3;
    for (int k = 0; k < 9; ++k) within = within && tone[i + (k / 3 - 1) * WIDTH + k % 3 - 1] == tone[i];
    if (!within) continue;
    int k = 0;
    while (k < count && memcmp(colours[k], rgb + 3 * i, 3) != 0) ++k;
    if (k == MOST) fail_msg("a fourth colour, %d %d %d, at pixel %d", rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], i);
    if (k == count) memcpy(colours[count++], rgb + 3 * i, 3);
    ++pixels;
  }
  assert_true(pixels > PIXELS / 20);
  free(tone);
  free(rgb);
}

static const float suns[][3] = {
    {-0.45f, 0.75f, 0.5f}, {0.9f, 0.3f, -0.4f}, {0, 1, 0}, {0.3f, 0.6f, 0.7f}, {-1, 0.12f, 0.2f}};
enum { SUNS = 5, VIEWS = 4 };

// With the paper's levels, water that lies just where one ends flickers: the measure can tell.
static void expect_flicker(Harness *harness, const Pool *pool, const RenderView *view) {
  RenderSettings settings = render_default_settings();
  const float sun[3] = {-0.6f, 2.0f / 3, 0.44f}; // of unit length nearly: two of three levels
  settings.style = "cartoon";
  memcpy(settings.sun_direction, sun, sizeof sun);
  settings.cartoon.steady = false;
  const Rest flickering = look(harness, pool, view, &settings);
  settings.cartoon.steady = true;
  const Rest steady = look(harness, pool, view, &settings);
  print_message("level water where a level ends: %.3f %% of the pixels change, %.3f %% with steady levels\n",
                100.0 * flickering.changed / flickering.water, 100.0 * steady.changed / steady.water);
  assert_true(flickering.changed > flickering.water / 1000);
  assert_true(steady.changed < steady.water / 1000);
}

static void expect_rest(Harness *harness, SimContainerShape shape, const char *what) {
  const RenderView views[VIEWS] = {{{0.9f, 0.8f, 1.9f}, {0.4f, 0.1f, 0.3f}, 38},    // as a scene is seen
                                   {{0.4f, 1.4f, 0.9f}, {0.4f, 0.1f, 0.35f}, 38},   // from above
                                   {{0.6f, 0.42f, 0.75f}, {0.35f, 0.2f, 0.3f}, 38}, // from close up
                                   {{0.2f, 0.32f, 1.1f}, {0.4f, 0.2f, 0.2f}, 30}};  // nearly along the surface
  Pool pool = pool_create(shape);
  RenderSettings settings = render_default_settings();
  settings.style = "cartoon";
  for (int view = 0; view < VIEWS; ++view) {
    int changed = 0, water = 0;
    double worst = 0;
    for (int k = 0; k < 4; ++k) {
      memcpy(settings.sun_direction, suns[(2 * view + k) % SUNS], sizeof suns[0]);
      const Rest rest = look(harness, &pool, &views[view], &settings);
      assert_true(rest.water > PIXELS / 20);
      worst = fmax(worst, (double)rest.changed / rest.water);
      changed += rest.changed;
      water += rest.water;
    }
    assert_true(worst < 0.001);
    print_message("%s, view %d: %d of %d pixels change, %.3f %%; under the worst sun %.3f %%\n", what, view, changed,
                  water, 100.0 * changed / water, 100 * worst);
  }
  for (int view = 0; view < VIEWS; ++view) expect_few_colours(harness, &pool.frame[0], &views[view]);
  expect_flicker(harness, &pool, &views[0]);
  pool_destroy(&pool);
}

static void test_tank(void **state) {
  expect_rest(*state, SIM_CONTAINER_BOX, "tank");
}

static void test_glass(void **state) {
  expect_rest(*state, SIM_CONTAINER_GLASS, "glass");
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_tank), cmocka_unit_test(test_glass)};
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
