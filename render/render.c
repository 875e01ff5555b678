// The renderer's public face: it checks what it is given and runs the passes of a picture in order.
#include "render/render.h"

#include "render/layers.h"
#include "render/settings.h"
#include "render/style.h"
#include "render/text.h"

#include <stdlib.h>
#include <string.h>

#define MAX_STYLES 16
#define MAX_SIZE 16384

struct Render {
  Gpu gpu;
  RenderPicture picture;
  RenderText text;
  void *states[MAX_STYLES]; // of the styles that have been drawn, by their row in the table
  const RenderStyle *style; // of the last picture, NULL before the first
  const GpuTexture *shown;  // texture of the shown layer in the last picture
  const RenderLayer *layer; // the shown layer in the last picture
  bool broken;              // the last resize failed
  char wanted_layer[64];    // "" for the picture
};

// ---- Creation --------------------------------------------------------------------------------------------------------

static bool resize_picture(RenderPicture *picture, int32_t width, int32_t height, RenderError *error) {
  picture->width = width;
  picture->height = height;
  const GpuTextureDesc depth = {"depth", width, height, GPU_DEPTH32F, false};
  const GpuTextureDesc colour = {"picture", width, height, GPU_RGBA32F, false};
  return gpu_texture_create(&picture->depth, &depth, error) && gpu_texture_create(&picture->colour, &colour, error) &&
         gpu_target_create(&picture->target,
                           &(GpuTargetDesc){.label = "picture", .colour = {&picture->colour}, .depth = &picture->depth},
                           error) &&
         render_background_resize(picture, error) && render_compose_resize(picture, error);
}

static bool check_size(int32_t width, int32_t height, RenderError *error) {
  if (width >= 1 && width <= MAX_SIZE && height >= 1 && height <= MAX_SIZE) return true;
  return gpu_fail(error, "a picture of %d x %d pixels is out of range, [1, %d]", width, height, MAX_SIZE);
}

Render *render_create(int32_t width, int32_t height, RenderError *error) {
  if (!check_size(width, height, error)) return NULL;
  Render *render = calloc(1, sizeof *render);
  if (render == NULL) {
    gpu_fail(error, "out of memory for the renderer");
    return NULL;
  }
  if (!gpu_create(&render->gpu, error)) {
    free(render);
    return NULL;
  }
  render->picture.gpu = &render->gpu;
  if (!render_sun_map_create(&render->picture, error) || !resize_picture(&render->picture, width, height, error) ||
      !render_text_create(&render->text, error)) {
    render_destroy(render);
    return NULL;
  }
  return render;
}

static void destroy_styles(Render *render) {
  for (int32_t i = 0; render_styles[i] != NULL; ++i) {
    if (render->states[i] == NULL) continue;
    render_styles[i]->destroy(render->states[i]);
    free(render->states[i]);
    render->states[i] = NULL;
  }
  render->shown = NULL;
  render->layer = NULL;
}

void render_destroy(Render *render) {
  if (render == NULL) return;
  RenderPicture *picture = &render->picture;
  destroy_styles(render);
  render_text_destroy(&render->text);
  render_compose_destroy(picture);
  render_background_destroy(picture);
  render_sun_map_destroy(picture);
  render_particles_destroy(&picture->particles);
  render_tiles_destroy(&picture->tiles);
  render_obstacles_destroy(&picture->obstacles);
  gpu_buffer_destroy(&picture->uniforms);
  gpu_target_destroy(&picture->target);
  gpu_texture_destroy(&picture->colour);
  gpu_texture_destroy(&picture->depth);
  gpu_destroy(&render->gpu);
  free(render);
}

bool render_resize(Render *render, int32_t width, int32_t height, RenderError *error) {
  if (!check_size(width, height, error)) return false;
  if (width == render->picture.width && height == render->picture.height && !render->broken) return true;
  destroy_styles(render); // they come back with the next picture
  render->broken = !resize_picture(&render->picture, width, height, error);
  return !render->broken;
}

// ---- Drawing ---------------------------------------------------------------------------------------------------------

static bool check_needs(const RenderStyle *style, const RenderSettings *settings, const SimFrame *frame,
                        RenderError *error) {
  const unsigned needs = render_style_needs(style->name, settings);
  const char *missing = NULL;
  const bool any = frame->count > 0;
  if ((needs & SIM_NEED_CLASS) && any && frame->particle_class == NULL) missing = "classes of particles";
  if ((needs & SIM_NEED_ANISOTROPY) && any && frame->ellipsoid == NULL) missing = "ellipsoids";
  if ((needs & SIM_NEED_SURFACE) && any && frame->near_surface == NULL) missing = "near-surface flags";
  if ((needs & SIM_NEED_HEIGHT_FIELD) && frame->height_field.height == NULL) missing = "the height field";
  if ((needs & SIM_NEED_SECOND_LAYER) && frame->height_field.underside == NULL) missing = "the second layer";
  return missing == NULL || gpu_fail(error, "style \"%s\" needs %s, which the frame lacks", style->name, missing);
}

// The style's state, made on first use; NULL and *error when that fails.
static void *style_state(Render *render, const RenderStyle *style, RenderError *error) {
  int32_t row = 0;
  while (render_styles[row] != style) ++row;
  if (render->states[row] == NULL) {
    void *state = calloc(1, style->state_size);
    if (state == NULL) {
      gpu_fail(error, "out of memory for style \"%s\"", style->name);
    } else if (!style->resize(state, &render->picture, error)) {
      style->destroy(state);
      free(state);
    } else {
      render->states[row] = state;
    }
  }
  return render->states[row];
}

static bool finish(Render *render, void *state, RenderError *error) {
  render->layer = NULL;
  render->shown = NULL;
  if (render->wanted_layer[0] == '\0') return render_compose_draw(&render->picture, error);
  bool of_background = false;
  const RenderLayer *layer = render_layer_find(render->style, render->wanted_layer, &of_background);
  if (layer == NULL) {
    return gpu_fail(error, "style \"%s\" has no layer \"%s\"", render->style->name, render->wanted_layer);
  }
  const void *base = of_background ? (const void *)&render->picture : state;
  render->layer = layer;
  render->shown = (const GpuTexture *)((const char *)base + layer->texture);
  return render_compose_layer(&render->picture, layer, render->shown, error);
}

static bool draw_passes(Render *render, const RenderView *view, void *state, RenderError *error) {
  RenderPicture *picture = &render->picture;
  Gpu *gpu = &render->gpu;

  gpu_pass_begin(gpu, "upload");
  const bool spray = render->style->needs & SIM_NEED_DENSITY; // which is all that densities are for
  bool ok = render_particles_upload(&picture->particles, picture->frame, spray, error) &&
            render_obstacles_upload(picture, error) && render_frame_block_write(picture, view, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "sun map");
  ok = ok && render_sun_map_draw(picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "background");
  ok = ok && render_background_draw(picture, error);
  gpu_pass_end(gpu);

  ok = ok && render->style->draw(state, picture, error);

  gpu_pass_begin(gpu, "compose");
  ok = ok && render_front_glass_draw(picture, error) && finish(render, state, error);
  gpu_pass_end(gpu);
  return ok;
}

bool render_draw(Render *render, const SimFrame *frame, const RenderView *view, const RenderSettings *settings,
                 RenderError *error) {
  if (render->broken) return gpu_fail(error, "the renderer has no picture to draw into since its resize failed");
  if (!render_settings_check(settings, error) || !render_view_check(view, error)) return false;
  const RenderStyle *style = render_style_find(settings->style);
  if (style == NULL) {
    return gpu_fail(error, "unknown style \"%.64s\"", settings->style != NULL ? settings->style : "");
  }
  if (!check_needs(style, settings, frame, error)) return false;
  void *state = style_state(render, style, error);
  if (state == NULL) return false;
  render->style = style;
  render->picture.frame = frame;
  render->picture.settings = settings;
  render->picture.drawn = style->drawn;
  gpu_passes_restart(&render->gpu);
  const bool drawn = draw_passes(render, view, state, error);
  render->picture.frame = NULL;
  render->picture.settings = NULL;
  gpu_collect_errors(&render->gpu);
  return drawn;
}

// ---- Results ---------------------------------------------------------------------------------------------------------

void render_read_rgb8(Render *render, uint8_t *rgb) {
  const RenderPicture *picture = &render->picture;
  if (render->broken) return;
  gpu_read_rgb8(&picture->compose.final_target, rgb);
  // GL counts rows from the bottom.
  const size_t row = 3 * (size_t)picture->width;
  for (int32_t low = 0, high = picture->height - 1; low < high; ++low, --high) {
    uint8_t *a = rgb + row * (size_t)low, *b = rgb + row * (size_t)high;
    for (size_t i = 0; i < row; ++i) {
      const uint8_t swap = a[i];
      a[i] = b[i];
      b[i] = swap;
    }
  }
}

void render_present(Render *render, int32_t window_width, int32_t window_height) {
  if (render->broken) return;
  gpu_present(&render->picture.compose.final_target, window_width, window_height);
}

static bool any_style_has_layer(const char *layer) {
  bool of_background;
  for (int32_t i = 0; render_styles[i] != NULL; ++i) {
    if (render_layer_find(render_styles[i], layer, &of_background) != NULL) return true;
  }
  return false;
}

bool render_show_layer(Render *render, const char *layer) {
  bool of_background;
  if (layer == NULL) {
    render->wanted_layer[0] = '\0';
    return true;
  }
  const bool known = render->style != NULL ? render_layer_find(render->style, layer, &of_background) != NULL
                                           : any_style_has_layer(layer);
  if (!known || strlen(layer) >= sizeof render->wanted_layer) return false;
  strcpy(render->wanted_layer, layer);
  return true;
}

bool render_read_layer(Render *render, float *values, int32_t *channels) {
  if (render->layer == NULL) return false;
  *channels = render->layer->channels;
  if (values == NULL) return true;
  const GpuTexture *texture = render->shown;
  if (texture->id == 0) { // there was nothing to make it of
    const RenderPicture *picture = &render->picture;
    memset(values, 0, sizeof *values * (size_t)*channels * (size_t)picture->width * (size_t)picture->height);
    return true;
  }
  const size_t count = (size_t)texture->width * (size_t)texture->height * (size_t)gpu_texture_channels(texture);
  float *texels = malloc(count * sizeof *texels);
  if (texels == NULL) return false;
  gpu_texture_read(texture, texels);
  render_layer_values(render->layer, texture, texels, render->picture.width, render->picture.height, values);
  free(texels);
  return true;
}

void render_text(Render *render, int32_t x, int32_t y, int32_t scale, const char *text) {
  if (render->broken) return;
  render_text_draw(&render->text, &render->gpu, &render->picture.compose.final_target, x, y, scale, text);
  gpu_collect_errors(&render->gpu);
}

void render_measure_passes(Render *render, bool on) {
  render->gpu.measuring = on;
}

int32_t render_pass_times(Render *render, RenderPassTime *times, int32_t capacity) {
  const Gpu *gpu = &render->gpu;
  for (int32_t i = 0; i < gpu->pass_count && i < capacity; ++i) {
    const GpuPass *pass = &gpu->passes[i];
    times[i] =
        (RenderPassTime){pass->name, gpu_pass_milliseconds(pass), pass->cpu_milliseconds, pass->processor_milliseconds};
  }
  return gpu->pass_count;
}

int32_t render_figures(Render *render, RenderFigure *figures, int32_t capacity) {
  int32_t row = 0;
  while (render_styles[row] != NULL && render_styles[row] != render->style) ++row;
  if (render_styles[row] == NULL || render->states[row] == NULL || render->style->figures == NULL) return 0;
  return render->style->figures(render->states[row], figures, capacity);
}

size_t render_buffer_bytes(void) {
  return gpu_buffer_bytes();
}

int32_t render_gl_error_count(const Render *render) {
  return render->gpu.error_count;
}

const char *render_gl_description(const Render *render) {
  return render->gpu.description;
}
