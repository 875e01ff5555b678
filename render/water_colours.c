#include "render/water_colours.h"

#include "render/overhang.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_PLACES 30000 // of a layer: two are what every OpenGL 4.5 has room for in a view
#define THIN 3.0f         // radii
#define RINGS 4           // as far colours go on where there are no particles

static size_t places_of(const RenderWaterColours *colours) {
  return (size_t)colours->size[0] * (size_t)colours->size[1];
}

// Every node of the field is a place, or every second one, and so on.
static void choose_places(RenderWaterColours *colours, const SimHeightField *field) {
  int32_t stride = 0;
  do {
    ++stride;
    for (int k = 0; k < 2; ++k) colours->size[k] = (field->size[k] - 1) / stride + 1;
  } while (colours->size[0] > MOST_PLACES / colours->size[1]);
  memcpy(colours->origin, field->origin, sizeof colours->origin);
  colours->spacing = field->spacing * (float)stride;
}

static bool reserve(RenderWaterColours *colours, RenderError *error) {
  const size_t places = places_of(colours);
  if (places > colours->capacity) {
    float *sums = realloc(colours->sums, 2 * 4 * places * sizeof *sums);
    if (sums == NULL) return gpu_fail(error, "out of memory for %zu colours of water", places);
    colours->sums = sums;
    colours->capacity = places;
  }
  memset(colours->sums, 0, 2 * 4 * places * sizeof *colours->sums);
  return true;
}

// A particle counts at the four places around it.
static void add_particle(RenderWaterColours *colours, const SimFrame *frame, int32_t particle) {
  const float *p = frame->position + 3 * (size_t)particle, *colour = frame->colour + 3 * (size_t)particle;
  const float u[2] = {(p[0] - colours->origin[0]) / colours->spacing, (p[2] - colours->origin[1]) / colours->spacing};
  if (!(fabsf(p[1]) < RENDER_FARTHEST)) return;
  for (int k = 0; k < 2; ++k) {
    if (!(u[k] > -1 && u[k] < (float)colours->size[k])) return;
  }
  const bool over = render_in_overhang(&frame->height_field, p, frame->particle_radius);
  for (int corner = 0; corner < 4; ++corner) {
    const int32_t i = (int32_t)floorf(u[0]) + (corner & 1), k = (int32_t)floorf(u[1]) + (corner >> 1);
    if (i < 0 || k < 0 || i >= colours->size[0] || k >= colours->size[1]) continue;
    const float weight = (1 - fabsf(u[0] - (float)i)) * (1 - fabsf(u[1] - (float)k));
    float *sum =
        colours->sums + 4 * (over ? places_of(colours) : 0) + 4 * ((size_t)k * (size_t)colours->size[0] + (size_t)i);
    for (int c = 0; c < 3; ++c) sum[c] += weight * render_clamp01(colour[c]);
    sum[3] += weight;
  }
}

// The sum over a place without particles and those around it that have some.
static void sum_around(const RenderWaterColours *colours, const float *sums, int32_t i, int32_t k, float out[4]) {
  memset(out, 0, 4 * sizeof *out);
  for (int32_t z = k > 0 ? k - 1 : 0; z <= k + 1 && z < colours->size[1]; ++z) {
    for (int32_t x = i > 0 ? i - 1 : 0; x <= i + 1 && x < colours->size[0]; ++x) {
      const float *sum = sums + 4 * ((size_t)z * (size_t)colours->size[0] + (size_t)x);
      for (int c = 0; c < 4 && sum[3] > 0; ++c) out[c] += sum[c];
    }
  }
}

// Means of what was summed; at the border to places without particles colours go on for some rings, and beyond water is clear.
static void finish(RenderWaterColours *colours, float *sums) {
  const size_t places = places_of(colours);
  for (int ring = 0; ring < RINGS; ++ring) {
    for (size_t place = 0; place < places; ++place) {
      float around[4];
      if (sums[4 * place + 3] != 0) continue;
      sum_around(colours, sums, (int32_t)(place % (size_t)colours->size[0]),
                 (int32_t)(place / (size_t)colours->size[0]), around);
      for (int c = 0; c < 4 && around[3] > 0; ++c) sums[4 * place + (size_t)c] = -around[c]; // not for this ring
    }
    for (size_t place = 0; place < places; ++place) {
      for (int c = 0; c < 4; ++c) sums[4 * place + (size_t)c] = fabsf(sums[4 * place + (size_t)c]);
    }
  }
  for (size_t place = 0; place < places; ++place) {
    float *sum = sums + 4 * place;
    for (int c = 0; c < 3; ++c) sum[c] = sum[3] > 0 ? sum[c] / sum[3] : 1;
  }
}

bool render_water_colours_find(RenderWaterColours *colours, const SimFrame *frame, const SimHeightField *field,
                               RenderError *error) {
  colours->any = frame->colour != NULL && frame->count > 0 && field->size[0] > 0 && field->size[1] > 0;
  if (!colours->any) return true;
  choose_places(colours, field);
  colours->thin = fmaxf(THIN * frame->particle_radius, 1e-6f);
  if (!reserve(colours, error)) return false;
  for (int32_t i = 0; i < frame->count; ++i) add_particle(colours, frame, i);
  const size_t places = places_of(colours);
  finish(colours, colours->sums);
  finish(colours, colours->sums + 4 * places);
  return gpu_buffer_write(&colours->values, "colours of water", colours->sums, 2 * 4 * places * sizeof(float), error) &&
         gpu_buffer_view(&colours->values, GPU_RGBA32F, 2 * places, error);
}

void render_water_colours_destroy(RenderWaterColours *colours) {
  gpu_buffer_destroy(&colours->values);
  free(colours->sums);
  *colours = (RenderWaterColours){0};
}

RenderColoursBlock render_water_colours_block(const RenderWaterColours *colours) {
  return (RenderColoursBlock){{colours->origin[0], colours->origin[1], colours->spacing, colours->thin},
                              {colours->size[0], colours->size[1]}};
}
