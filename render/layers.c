// Which intermediates a style offers: the background's, which belong to every style, then its own.
#include "render/layers.h"

#include <stddef.h>
#include <string.h>

static const RenderLayer background_layers[] = {
    {"background", "linear light of sky, floor, obstacles and the container's back edges", RENDER_MAP_COLOUR,
     offsetof(RenderPicture, background.colour), 0, 3, 0},
    {"background_depth", "metres along the view axis to floor and obstacles, 0 for the sky", RENDER_MAP_DEPTH,
     offsetof(RenderPicture, background.colour), 3, 1, 0},
};
#define BACKGROUND_LAYER_COUNT ((int32_t)(sizeof background_layers / sizeof background_layers[0]))

const RenderLayer *render_layer_find(const RenderStyle *style, const char *name, bool *of_background) {
  for (int32_t i = 0; i < BACKGROUND_LAYER_COUNT + style->layer_count; ++i) {
    *of_background = i < BACKGROUND_LAYER_COUNT;
    const RenderLayer *layer = *of_background ? &background_layers[i] : &style->layers[i - BACKGROUND_LAYER_COUNT];
    if (strcmp(layer->name, name) == 0) return layer;
  }
  return NULL;
}

int32_t render_layer_count(const char *style_name) {
  const RenderStyle *style = render_style_find(style_name);
  return style != NULL ? BACKGROUND_LAYER_COUNT + style->layer_count : 0;
}

static const RenderLayer *layer_at(const char *style_name, int32_t index) {
  if (index < 0 || index >= render_layer_count(style_name)) return NULL;
  const RenderStyle *style = render_style_find(style_name);
  // The style's own layers come first: they are what people look for.
  return index < style->layer_count ? &style->layers[index] : &background_layers[index - style->layer_count];
}

const char *render_layer_name(const char *style_name, int32_t index) {
  const RenderLayer *layer = layer_at(style_name, index);
  return layer != NULL ? layer->name : NULL;
}

const char *render_layer_summary(const char *style_name, int32_t index) {
  const RenderLayer *layer = layer_at(style_name, index);
  return layer != NULL ? layer->summary : NULL;
}

void render_layer_values(const RenderLayer *layer, const GpuTexture *texture, const float *texels, int32_t width,
                         int32_t height, float *values) {
  const int32_t stride = gpu_texture_channels(texture);
  for (int32_t y = 0; y < height; ++y) {
    const int32_t row = (int32_t)((int64_t)(height - 1 - y) * texture->height / height);
    for (int32_t x = 0; x < width; ++x) {
      const int32_t column = (int32_t)((int64_t)x * texture->width / width);
      const float *texel = texels + ((size_t)row * (size_t)texture->width + (size_t)column) * (size_t)stride;
      for (int32_t c = 0; c < layer->channels; ++c) *values++ = texel[layer->channel + c];
    }
  }
}
