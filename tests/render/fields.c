#include "tests/render/fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int field_bench_open(void **state) {
  FieldBench *b = calloc(1, sizeof *b);
  AppError app_error = {0};
  b->context = context_create_headless(CONTEXT_AUTO, &app_error);
  if (b->context == NULL) fail_msg("%s", app_error.message);
  RenderError error = {0};
  if (!gpu_create(&b->gpu, &error)) fail_msg("%s", error.message);
  b->settings = render_default_settings();
  b->picture = (RenderPicture){.gpu = &b->gpu, .width = 16, .height = 16};
  if (!render_sun_map_create(&b->picture, &error)) fail_msg("%s", error.message);
  *state = b;
  return 0;
}

int field_bench_close(void **state) {
  FieldBench *b = *state;
  render_height_map_destroy(&b->map);
  render_caustics_destroy(&b->caustics);
  render_sun_map_destroy(&b->picture);
  render_obstacles_destroy(&b->picture.obstacles);
  gpu_buffer_destroy(&b->picture.uniforms);
  gpu_collect_errors(&b->gpu);
  assert_int_equal(b->gpu.error_count, 0);
  assert_int_equal(gpu_buffer_bytes(), 0);
  gpu_destroy(&b->gpu);
  context_destroy(b->context);
  free(b);
  return 0;
}

TestField test_field_create(int32_t columns, int32_t rows, float spacing, float x, float z, FieldHeight height,
                            const void *context) {
  TestField f = {.field = {.size = {columns, rows}, .origin = {x, z}, .spacing = spacing}};
  f.heights = malloc(sizeof(float) * (size_t)columns * (size_t)rows);
  for (int32_t k = 0; k < rows; ++k) {
    for (int32_t i = 0; i < columns; ++i) {
      const double at[2] = {(double)x + i * (double)spacing, (double)z + k * (double)spacing};
      f.heights[(size_t)k * (size_t)columns + (size_t)i] = (float)height(at[0], at[1], context);
    }
  }
  f.field.height = f.heights;
  return f;
}

void test_field_destroy(TestField *field) {
  free(field->heights);
  *field = (TestField){0};
}

float *field_bench_surface(FieldBench *b, const TestField *f, float smoothing) {
  RenderError error = {0};
  if (!render_height_map_draw(&b->map, &b->picture, &f->field, f->heights, smoothing, &error)) {
    fail_msg("%s", error.message);
  }
  if (b->map.size[0] == 0) return NULL;
  float *values = malloc(4 * sizeof *values * (size_t)b->map.size[0] * (size_t)b->map.size[1]);
  gpu_texture_read(&b->map.surface, values);
  return values;
}

// What comes before the style in a picture, then the two maps.
static bool draw_light(FieldBench *b, const TestField *f, RenderError *error) {
  const RenderView view = {{0, 3, 3}, {0, 0, 0}, 40};
  RenderPicture *picture = &b->picture;
  b->frame.height_field = f->field;
  b->frame.particle_radius = 0.5f * f->field.spacing;
  picture->frame = &b->frame;
  picture->settings = &b->settings;
  return render_obstacles_upload(picture, error) && render_frame_block_write(picture, &view, error) &&
         render_sun_map_draw(picture, error) &&
         render_height_map_draw(&b->map, picture, &f->field, f->heights, 0, error) &&
         render_caustics_draw(&b->caustics, picture, &b->map, error);
}

float *field_bench_light(FieldBench *b, const TestField *f) {
  RenderError error = {0};
  if (!draw_light(b, f, &error)) fail_msg("%s", error.message);
  const GpuTexture *light = &b->caustics.light;
  float *values = malloc(4 * sizeof *values * (size_t)light->width * (size_t)light->height);
  gpu_texture_read(light, values);
  return values;
}

void field_light_at(const FieldBench *b, const float *light, const double point[3], double rgb[3]) {
  const int32_t size = b->caustics.light.width;
  double at[2] = {(double)b->caustics.u[3], (double)b->caustics.v[3]};
  for (int k = 0; k < 3; ++k) {
    at[0] += point[k] * (double)b->caustics.u[k];
    at[1] += point[k] * (double)b->caustics.v[k];
  }
  const double x = at[0] * size - 0.5, y = at[1] * size - 0.5;
  const int32_t i = (int32_t)floor(x), k = (int32_t)floor(y);
  memset(rgb, 0, 3 * sizeof *rgb);
  for (int corner = 0; corner < 4; ++corner) {
    const int32_t column = i + (corner & 1), row = k + (corner >> 1);
    const double weight = (corner & 1 ? x - i : 1 - x + i) * (corner & 2 ? y - k : 1 - y + k);
    if (column < 0 || column >= size || row < 0 || row >= size) continue;
    for (int c = 0; c < 3; ++c)
      rgb[c] += weight * (double)light[4 * ((size_t)row * (size_t)size + (size_t)column) + (size_t)c];
  }
}
