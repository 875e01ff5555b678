// Default settings, and what makes settings and views acceptable.
#include "render/settings.h"

#include <math.h>

#define SETTINGS_COOKIE 0x4c69646fu

RenderSettings render_default_settings(void) {
  return (RenderSettings){
      .cookie = SETTINGS_COOKIE,
      .style = "points",
      .sun_direction = {-0.45f, 0.75f, 0.5f},
      .sun_colour = {3.8f, 3.5f, 3.0f},
      .sun = true,
      .shadow = true,
      .sky = RENDER_SKY_CLEAR,
      .sky_zenith = {0.15f, 0.35f, 0.75f},
      .sky_horizon = {0.80f, 0.88f, 0.95f},
      .floor = RENDER_FLOOR_TILES,
      .floor_level = NAN,
      .tile_size = 0.2f,
      .floor_colour = {{0.8f, 0.8f, 0.8f}, {0.2f, 0.2f, 0.2f}},
      .container_visible = true,
      .absorption = {3.2f, 0.68f, 0.46f},
      .scattering = {0.14f, 0.34f, 0.36f},
      .refractive_index = 1.333f,
      .tone_map = RENDER_TONE_FILMIC,
      .exposure = 1,
      .refraction = {.count = 4,
                     .scale = 1.2f,
                     .lift = 0.8f,
                     .smoothing = RENDER_SMOOTHING_REGRESSION,
                     .sigma = 5.3f,
                     .window = 9,
                     .iterations = 2,
                     .view_dependent = true,
                     .splashes_apart = true,
                     .surface_only = true},
      .raycast = {.iso = 0.25f,
                  .support = 4,
                  .normals = RENDER_NORMALS_BLEND,
                  .normal_reach = 6,
                  .blend_d = 10,
                  .blend_k = 0.998f,
                  .blend_weight = -1,
                  .filter_reach = 3,
                  .filter_angle = 0.2f},
      .cartoon = {.scale = 1.5f,
                  .smoothing = RENDER_CARTOON_BILATERAL,
                  .reach = 12,
                  .fitted = true,
                  .range = 4,
                  .half_resolution = true,
                  .splashes_apart = true,
                  .levels = 3,
                  .bright_levels = true,
                  .steady = true,
                  .bright_threshold = 0.85f,
                  .dark_threshold = 0.5f,
                  .bright_factor = 1.1f,
                  .dark_factor = 0.9f,
                  .reflection = true,
                  .refraction = true,
                  .most_reflection = render_palette(0)->most_reflection,
                  .most_transparency = render_palette(0)->most_transparency,
                  .critical_angle = 60,
                  .angle_interval = 20,
                  .bending = 0.3f,
                  .outline = 3,
                  .crease_angle = 40,
                  .palette = render_palette(0)->palette},
      .heightfield = {.smoothing = 1,
                      .drops = true,
                      .mapped = true,
                      .plane_reach = 12,
                      .pull_reach = 6,
                      .group_distance = 1,
                      .trapezium = true,
                      .trapezium_a = 3,
                      .trapezium_b = 3,
                      .traced_caustics = true,
                      .simple_height = 0.6f,
                      .simple_slope = 2,
                      .simple_base = 0.6f},
      .points = {.scale = 1.25f},
  };
}

static bool all_finite(const float *values, int count) {
  for (int i = 0; i < count; ++i) {
    if (!isfinite(values[i]) || fabsf(values[i]) > RENDER_FARTHEST) return false;
  }
  return true;
}

static bool in_range(float value, float low, float high) {
  return value >= low && value <= high; // false for NaN
}

static bool all_in_range(const float *values, int count, float low, float high) {
  for (int i = 0; i < count; ++i) {
    if (!in_range(values[i], low, high)) return false;
  }
  return true;
}

static bool is_zero(const float v[3]) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

static bool refraction_check(const RenderRefraction *r, RenderError *error) {
  if (r->count < 1 || r->count > 4) return gpu_fail(error, "the number of refractions must be in [1, 4]");
  if (!in_range(r->scale, 0.5f, 2)) return gpu_fail(error, "the scale of ellipsoids must be in [0.5, 2]");
  if (!in_range(r->lift, 0, 2)) return gpu_fail(error, "the lift of ellipsoids must be in [0, 2] radii");
  if ((unsigned)r->smoothing > RENDER_SMOOTHING_NONE) return gpu_fail(error, "unknown smoothing %d", (int)r->smoothing);
  if (!in_range(r->sigma, 1e-3f, 100)) return gpu_fail(error, "sigma must be in [0.001, 100] radii");
  if (r->window < 3 || r->window > 63) return gpu_fail(error, "the window of the smoothing must be in [3, 63]");
  if (!in_range(r->reach, 0, 50)) return gpu_fail(error, "the reach of the smoothing must be in [0, 50] radii");
  if (r->iterations < 1 || r->iterations > 50) return gpu_fail(error, "iterations must be in [1, 50]");
  return true;
}

static bool raycast_check(const RenderRaycast *r, RenderError *error) {
  if (!in_range(r->iso, 0.01f, 0.99f)) return gpu_fail(error, "the iso-value must be in [0.01, 0.99]");
  if (!in_range(r->support, 2, 8)) return gpu_fail(error, "the support of the field must be in [2, 8] radii");
  if ((unsigned)r->normals > RENDER_NORMALS_PCA) return gpu_fail(error, "unknown normals %d", (int)r->normals);
  if (!in_range(r->normal_reach, 2, 12)) return gpu_fail(error, "the reach of normals must be in [2, 12] radii");
  if (!in_range(r->blend_d, 0, 1000)) return gpu_fail(error, "d of the blend must be in [0, 1000]");
  if (!in_range(r->blend_k, -1, 1)) return gpu_fail(error, "k of the blend must be in [-1, 1]");
  if (!in_range(r->blend_weight, -1, 1)) return gpu_fail(error, "the weight of the blend must be in [-1, 1]");
  if (!in_range(r->filter_reach, 0, 20)) return gpu_fail(error, "the reach of the filter must be in [0, 20] radii");
  if (!in_range(r->filter_angle, 1e-3f, 2)) return gpu_fail(error, "the angle of the filter must be in [0.001, 2]");
  return true;
}

static bool palette_check(const RenderPalette *p, RenderError *error) {
  const float *colours = p->dark; // the palette is nothing but colours
  return all_in_range(colours, sizeof *p / sizeof(float), 0, 1) ||
         gpu_fail(error, "the colours of a palette must be in [0, 1]");
}

static bool cartoon_check(const RenderCartoon *c, RenderError *error) {
  if (!in_range(c->scale, 0.5f, 4)) return gpu_fail(error, "the scale of spheres must be in [0.5, 4]");
  if ((unsigned)c->smoothing > RENDER_CARTOON_NONE) return gpu_fail(error, "unknown smoothing %d", (int)c->smoothing);
  if (c->kernel < 0 || c->kernel > 63) return gpu_fail(error, "the kernel of the smoothing must be in [0, 63] pixels");
  if (!in_range(c->reach, 0, 50)) return gpu_fail(error, "the reach of the smoothing must be in [0, 50] radii");
  if (!in_range(c->range, 1e-3f, 100))
    return gpu_fail(error, "the range of the smoothing must be in [0.001, 100] radii");
  if (c->levels < 1 || c->levels > 32) return gpu_fail(error, "the levels of the shading must be in [1, 32]");
  const float shares[] = {c->bright_threshold, c->dark_threshold,    c->dark_factor,       c->most_reflection,
                          c->least_reflection, c->most_transparency, c->least_transparency};
  if (!all_in_range(shares, sizeof shares / sizeof *shares, 0, 1)) {
    return gpu_fail(error, "thresholds, the dark factor, reflection and transparency must be in [0, 1]");
  }
  if (!in_range(c->bright_factor, 1, 10)) return gpu_fail(error, "the bright factor must be in [1, 10]");
  const float angles[] = {c->critical_angle, c->angle_interval};
  if (!all_in_range(angles, 2, 0, 90)) return gpu_fail(error, "the critical angle and its interval must be in [0, 90]");
  if (!in_range(c->clearness, 0, 1e6f)) return gpu_fail(error, "the clearness must be in [0, 1000000] m");
  if (!in_range(c->bending, -10, 10)) return gpu_fail(error, "the bending must be in [-10, 10]");
  if (!in_range(c->outline, 0, 16)) return gpu_fail(error, "outlines must be in [0, 16] pixels");
  if (!in_range(c->crease_angle, 0, 180)) return gpu_fail(error, "the angle of creases must be in [0, 180]");
  return palette_check(&c->palette, error);
}

static bool heightfield_check(const RenderHeightfield *h, RenderError *error) {
  if (!in_range(h->smoothing, 0, 8)) return gpu_fail(error, "the smoothing of heights must be in [0, 8] spacings");
  if ((unsigned)h->eyes > RENDER_EYES_ONE) return gpu_fail(error, "unknown virtual eyes %d", (int)h->eyes);
  if ((unsigned)h->access > RENDER_ACCESS_DIRECTION) return gpu_fail(error, "unknown access %d", (int)h->access);
  if (!in_range(h->plane_reach, 1, 1000)) return gpu_fail(error, "the reach of planes must be in [1, 1000] spacings");
  if (!in_range(h->pull_reach, 0, 1000)) return gpu_fail(error, "the pull to planes must be in [0, 1000] spacings");
  if (!in_range(h->group_distance, 0, 1000))
    return gpu_fail(error, "the distance of groups must be in [0, 1000] spacings");
  const float widths[] = {h->trapezium_a, h->trapezium_b};
  if (!all_in_range(widths, 2, 0.1f, 100)) return gpu_fail(error, "a and b of the trapezium must be in [0.1, 100]");
  const float simple[] = {h->simple_height, h->simple_slope, h->simple_base};
  if (!all_in_range(simple, 3, -100, 100))
    return gpu_fail(error, "a, b and c of simple caustics must be in [-100, 100]");
  if (!in_range(h->dispersion, 0, 0.5f)) return gpu_fail(error, "the dispersion must be in [0, 0.5]");
  return true;
}

bool render_settings_check(const RenderSettings *s, RenderError *error) {
  if (s->cookie != SETTINGS_COOKIE) return gpu_fail(error, "settings were not made by render_default_settings");
  if (!all_finite(s->sun_direction, 3) || is_zero(s->sun_direction)) {
    return gpu_fail(error, "the sun's direction must be finite and not zero");
  }
  if (!all_in_range(s->sun_colour, 3, 0, 1e4f)) return gpu_fail(error, "the sun's colour must be in [0, 10000]");
  if ((unsigned)s->sky > RENDER_SKY_GRADIENT) return gpu_fail(error, "unknown sky %d", (int)s->sky);
  if ((unsigned)s->floor > RENDER_FLOOR_NONE) return gpu_fail(error, "unknown floor %d", (int)s->floor);
  if ((unsigned)s->tone_map > RENDER_TONE_FILMIC) return gpu_fail(error, "unknown tone map %d", (int)s->tone_map);
  if (!all_in_range(s->sky_zenith, 3, 0, 1e4f) || !all_in_range(s->sky_horizon, 3, 0, 1e4f) ||
      !all_in_range(s->floor_colour[0], 3, 0, 1e4f) || !all_in_range(s->floor_colour[1], 3, 0, 1e4f)) {
    return gpu_fail(error, "colours of sky and floor must be in [0, 10000]");
  }
  if (!isnan(s->floor_level) && !in_range(s->floor_level, -RENDER_FARTHEST, RENDER_FARTHEST)) {
    return gpu_fail(error, "the floor's level is out of range: %g", (double)s->floor_level);
  }
  if (!in_range(s->tile_size, 1e-4f, 1e6f)) return gpu_fail(error, "the tile size must be in [0.0001, 1000000] m");
  if (!all_in_range(s->absorption, 3, 0, 1e6f)) return gpu_fail(error, "absorption must be in [0, 1000000] 1/m");
  if (!all_in_range(s->scattering, 3, 0, 1e6f)) return gpu_fail(error, "scattering must be in [0, 1000000] 1/m");
  if (!all_in_range(s->reflectance, 3, 0, 1)) return gpu_fail(error, "reflectance must be in [0, 1]");
  if (!in_range(s->refractive_index, 1, 3)) return gpu_fail(error, "the refractive index must be in [1, 3]");
  if (!in_range(s->exposure, 1e-6f, 1e6f)) return gpu_fail(error, "the exposure must be in [0.000001, 1000000]");
  if (!in_range(s->points.scale, 0.1f, 5)) return gpu_fail(error, "the scale of points must be in [0.1, 5]");
  return refraction_check(&s->refraction, error) && raycast_check(&s->raycast, error) &&
         cartoon_check(&s->cartoon, error) && heightfield_check(&s->heightfield, error);
}

bool render_view_check(const RenderView *view, RenderError *error) {
  if (!all_finite(view->eye, 3) || !all_finite(view->target, 3)) {
    return gpu_fail(error, "the camera's eye and target must be finite, within 1000 km");
  }
  const float gaze[3] = {view->target[0] - view->eye[0], view->target[1] - view->eye[1],
                         view->target[2] - view->eye[2]};
  if (is_zero(gaze)) return gpu_fail(error, "the camera's eye and target are the same point");
  if (!(view->vertical_fov > 1 && view->vertical_fov < 170)) {
    return gpu_fail(error, "the camera's field of view must be in (1, 170) degrees, got %g",
                    (double)view->vertical_fov);
  }
  return true;
}
