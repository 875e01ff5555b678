// Intermediates that can be shown and read. Internal to the renderer.
#ifndef LIDO_RENDER_LAYERS_H
#define LIDO_RENDER_LAYERS_H

#include "render/style.h"

/// NULL when there is none. *of_background: its texture is in the RenderPicture, else in the style's state.
const RenderLayer *render_layer_find(const RenderStyle *style, const char *name, bool *of_background);

/// Texels of a layer's texture (bottom row first) as values of the picture's pixels (top row first).
void render_layer_values(const RenderLayer *layer, const GpuTexture *texture, const float *texels, int32_t width,
                         int32_t height, float *values);

#endif
