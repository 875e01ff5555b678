#include "tests/render/drawn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

DrawnWater *drawn_create(float particle_radius) {
  DrawnWater *water = calloc(1, sizeof *water);
  assert_non_null(water);
  water->frame = (SimFrame){.particle_radius = particle_radius,
                            .position = water->position,
                            .particle_class = water->particle_class,
                            .near_surface = water->near_surface,
                            .bounds_max = {1, 1, 1}};
  return water;
}

int32_t drawn_add(DrawnWater *water, float x, float y, float z, SimClass class) {
  const int32_t i = water->frame.count++;
  const float p[3] = {x, y, z};
  assert_true(i < DRAWN_MOST);
  memcpy(water->position + 3 * i, p, sizeof p);
  water->radius[i] = water->frame.particle_radius;
  water->particle_class[i] = (uint8_t) class;
  water->near_surface[i] = 1;
  return i;
}

// The same disorder every time: uniform in [−1, 1].
static float noise(uint32_t *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return (float)(*seed >> 8) / 8388608.0f - 1;
}

void drawn_add_block(DrawnWater *water, const float middle[3], int nx, int ny, int nz, float disorder) {
  const float spacing = 2 * water->frame.particle_radius;
  uint32_t seed = 7;
  for (int i = 0; i < nx * ny * nz; ++i) {
    const float node[3] = {(float)(i % nx) - 0.5f * (float)(nx - 1), (float)(i / nx % ny) - 0.5f * (float)(ny - 1),
                           (float)(i / nx / ny) - 0.5f * (float)(nz - 1)};
    float p[3];
    for (int k = 0; k < 3; ++k) p[k] = middle[k] + spacing * (node[k] + disorder * noise(&seed));
    drawn_add(water, p[0], p[1], p[2], SIM_AGGREGATED);
  }
}

void drawn_add_ball(DrawnWater *water, const float middle[3], float radius) {
  const float spacing = 2 * water->frame.particle_radius;
  const int half = (int)(radius / spacing) + 1;
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j)
      for (int k = -half; k <= half; ++k) {
        const float x = spacing * (float)i, y = spacing * (float)j, z = spacing * (float)k;
        if (x * x + y * y + z * z > radius * radius) continue;
        drawn_add(water, middle[0] + x, middle[1] + y, middle[2] + z, SIM_AGGREGATED);
      }
}

RenderSettings drawn_settings(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "cartoon";
  settings.floor = RENDER_FLOOR_NONE;
  return settings;
}

double *drawn_map(Harness *harness, const char *layer, int32_t scale, const SimFrame *frame, const RenderView *view,
                  const RenderSettings *settings) {
  float *values = harness_layer(harness, layer, 1, frame, view, settings);
  const int32_t width = harness->width / scale, height = harness->height / scale;
  double *map = malloc(sizeof *map * (size_t)width * (size_t)height);
  for (int32_t y = 0; y < height; ++y) {
    for (int32_t x = 0; x < width; ++x) {
      map[(size_t)y * (size_t)width + (size_t)x] =
          (double)values[(size_t)(scale * y) * (size_t)harness->width + (size_t)(scale * x)];
    }
  }
  free(values);
  return map;
}

Lens drawn_lens(const Harness *harness, const RenderView *view, int32_t scale) {
  return pinhole_make(view->eye, view->target, view->vertical_fov, harness->width / scale, harness->height / scale)
      .lens;
}
